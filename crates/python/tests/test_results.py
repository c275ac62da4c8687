"""Results as tables and pictures of other packages."""

import pickle
from pathlib import Path
import xml.etree.ElementTree as ElementTree

import hovertone
import matplotlib
import numpy as np
import pyarrow
import pytest
from testkit import RATE_HZ, rotor, write_wave

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
    assert "<table>" in result._repr_html_()


@pytest.mark.parametrize("name", RESULTS)
def test_figures_are_svg(name):
    result = RESULTS[name]()
    svg = result.figure()
    assert svg is not None and ElementTree.fromstring(svg).tag.endswith("svg")
    assert "<svg" in result._repr_html_()


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


def test_a_plan_is_a_table_without_a_picture():
    plan = hovertone.plan("413g")
    assert plan.to_pandas()["load_count"].tolist() == plan.to_arrow()["load_count"].to_pylist() == [plan.load_count]
    assert "<table>" in plan._repr_html_() and plan.figure() is None and not hasattr(plan, "plot")


#: Results with values, and the same without those that may be missing.
PAIRS = {
    "speed": [lambda: hovertone.speed("hover.wav", blades=2), lambda: hovertone.speed("silence.wav", blades=2)],
    "tones": [lambda: hovertone.tones("hover.wav", diameter_m=0.2, mass_kg=0.4), lambda: hovertone.tones("silence.wav")],
    "track": [lambda: hovertone.track("hover.wav", blades=2), lambda: hovertone.track("silence.wav", blades=2)],
    "weigh": [RESULTS["weigh"], lambda: hovertone.weigh("hover.wav", constant_n_s2=2.83e-5, constant_std_n_s2=1e-7, blades=2, rotors=1)],
    "fit": [RESULTS["fit"], lambda: hovertone.fit({"rpm": [3000], "thrust_n": [0.7], "thrust_std_n": [0.01]})],
    "plan": [lambda: hovertone.plan("413g"), lambda: hovertone.plan("413g", wanted_share=0.1)],
    "identify": [RESULTS["identify"], lambda: hovertone.identify(mass={"413g": "hover.wav"}, blades=2, rotors=1)],
}


@pytest.mark.parametrize("name", PAIRS)
def test_types_of_columns_depend_on_no_value(name):
    write_wave(Path("silence.wav"), np.zeros(5 * RATE_HZ, np.float32))
    results = [make() for make in PAIRS[name]]
    full, sparse = (result.to_arrow() for result in results)
    assert full.schema == sparse.schema
    assert all(not pyarrow.types.is_null(kind) for kind in full.schema.types)
    assert len(pyarrow.concat_tables([full, sparse])) == len(full) + len(sparse)
    kinds = [result.to_pandas().dtypes for result in results]
    for column, field in zip(full.column_names, full.schema, strict=True):
        if pyarrow.types.is_floating(field.type):
            assert kinds[0][column] == kinds[1][column] == np.float64, column


def test_a_load_named_by_a_number_stays_a_word():
    found = hovertone.identify(mass={"0.4": "hover.wav"}, blades=2, rotors=1)
    assert found.to_arrow().schema.field("load").type == pyarrow.string()
    assert found.samples.to_arrow().schema.field("from_s").type == pyarrow.float64()


def test_weigh_tells_its_warnings():
    write_wave(Path("silence.wav"), np.zeros(5 * RATE_HZ, np.float32))
    write_wave(Path("loud.wav"), np.clip(6 * rotor(61.3), -1, 1))
    known = {"constant_n_s2": 2.83e-5, "blades": 2, "rotors": 1}
    assert hovertone.weigh("hover.wav", **known).warnings == ()
    weighed = hovertone.weigh(["loud.wav", "silence.wav", "none.wav"], **known)
    assert weighed.recording_count == 1 and len(weighed.warnings) == 3, weighed.warnings
    loud, none, silence = sorted(weighed.warnings)
    assert loud.startswith("loud.wav: the recording is overdriven") and hovertone.speed("loud.wav", blades=2).warnings[0] in loud
    assert silence.startswith("silence.wav: no rotor tone: ") and none.startswith("none.wav: ")
    assert "overdriven" in weighed._repr_html_() and weighed.json["mass_kg"]["value"] == weighed.mass_kg.value
    assert {hash(weighed)} == {hash(pickle.loads(pickle.dumps(weighed)))}
