"""Results as tables and pictures of other packages."""

import pickle
import xml.etree.ElementTree as ElementTree

import hovertone
import matplotlib
import pytest

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

SCENARIO = "duration_s = 1.0\n[vehicle]\npreset = 'ardrone'\n[[microphone]]\nposition_m = [2.0, 0.0, 2.0]\n"
RESULTS = {
    "speed": lambda: hovertone.speed("hover.wav", blades=2),
    "track": lambda: hovertone.track("hover.wav", blades=2),
    "tones": lambda: hovertone.tones("hover.wav"),
    "identify": lambda: hovertone.identify("experiment.toml"),
    "fit": lambda: hovertone.fit({"rpm": [3e3, 4e3, 5e3], "thrust_g": [70, 125, 194]}),
    "weigh": lambda: hovertone.weigh("hover.wav", constant_n_s2=2.83e-5, blades=2, rotors=1, mass_kg=0.4),
    "simulate": lambda: hovertone.simulate(SCENARIO),
}


@pytest.mark.parametrize("name", RESULTS)
def test_tables_and_pictures(name):
    result = RESULTS[name]()
    frame, table = result.to_pandas(), result.to_arrow()
    assert len(frame) == len(table) > 0 and list(frame.columns) == table.column_names
    figure, ax = plt.subplots()
    assert result.plot(ax) is ax and ax.has_data()
    figure.savefig("plot.png")
    plt.close(figure)
    if name != "track":
        assert "<table>" in result._repr_html_()


@pytest.mark.parametrize("name", ["speed", "tones", "identify"])
def test_figures_are_svg(name):
    result = RESULTS[name]()
    svg = result.figure()
    assert svg is not None and ElementTree.fromstring(svg).tag.endswith("svg")
    assert svg in result._repr_html_()


@pytest.mark.parametrize("name", RESULTS)
def test_results_go_to_other_processes(name):
    result = RESULTS[name]()
    again = pickle.loads(pickle.dumps(result))
    assert again.to_pandas().equals(result.to_pandas())
    if name == "speed":
        assert again.figure() is None and again.json == result.json


def test_progress():
    told = []
    hovertone.speed("hover.wav", blades=2, progress=told.append)
    assert told == sorted(told) and told[-1] == 1.0 and len(told) > 5
    hovertone.speeds(["hover.wav"], blades=2, progress=True)

    def stop(share):
        raise RuntimeError("stop")

    with pytest.raises(RuntimeError, match="stop"):
        hovertone.speed("hover.wav", blades=2, progress=stop)


def test_threads_hear_at_the_same_time():
    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda blades: hovertone.speed("hover.wav", blades=blades), [2, 2, 3, 2]))
    assert found[0].speed_rev_s == found[1].speed_rev_s == found[3].speed_rev_s != found[2].speed_rev_s


def test_a_missing_package_is_named(monkeypatch):
    import sys

    found = hovertone.speed("hover.wav", blades=2)
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match=r"this needs pandas: pip install 'hovertone\[pandas\]'"):
        found.to_pandas()
