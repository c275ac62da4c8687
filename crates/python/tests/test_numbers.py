"""The numbers of Python are those of the command line, bit for bit."""

import json
from pathlib import Path

import hovertone
import numpy as np
import pandas
import pyarrow


class OfPandas:
    """A table that only becomes one of pandas."""

    def __init__(self, frame):
        self.to_pandas = lambda: frame


class OfSeries:
    """A table as that of Polars: columns by their names, of which one becomes a list."""

    def __init__(self, columns):
        self.by_name, self.columns = columns, list(columns)

    def __len__(self):
        return len(self.by_name[self.columns[0]])

    def __getitem__(self, name):
        return tuple(self.by_name[name])

    def get_column(self, name):
        return self[name]

    def to_pandas(self):
        raise ModuleNotFoundError("pandas is not needed")


def test_ten_recordings(demo, program):
    files = sorted(demo.glob("*/trial_*.wav"))[:10]
    assert len(files) == 10
    lines = program("speed", "--json", "--vehicle", "ardrone", *files).stdout.splitlines()
    found = hovertone.speeds(files, vehicle="ardrone")
    assert [one.json for one in found] == [json.loads(line) for line in lines]
    assert [one.file for one in found] == [str(file) for file in files]
    assert all(one.status == "ok" and one.speed_rev_s == one.json["speed_rev_s"] for one in found)


def test_track(demo, program):
    file = demo / "no_hull" / "trial_1.wav"
    program("speed", "--vehicle", "ardrone", "--track", "track.csv", file)
    written = pandas.read_csv("track.csv")
    track = hovertone.track(file, vehicle="ardrone").to_pandas()
    assert len(track) > 100
    pandas.testing.assert_frame_equal(track[written.columns], written, check_exact=True, check_dtype=False)


def test_separated_rotors(program, tmp_path):
    from testkit import rotor, write_wave

    write_wave(Path("two.wav"), 0.5 * (rotor(61.3, 8.0) + rotor(66.1, 8.0)))
    program("speed", "--blades", "2", "--rotors", "2", "--track", "two.csv", "two.wav")
    found = hovertone.speed("two.wav", blades=2, rotors=2)
    assert [round(one.speed_rev_s) for one in found.rotors] == [66, 61]
    written = pandas.read_csv("two.csv")
    assert set(written["rotor"]) == {1, 2}
    track = found.track.to_pandas()
    pandas.testing.assert_frame_equal(track[written.columns], written, check_exact=True, check_dtype=False)


def test_tones(told_json):
    assert hovertone.tones("hover.wav").json == told_json("tones", "hover.wav")


def test_identify(demo, identified, told_json, program):
    experiment = demo / "experiment.toml"
    found = identified
    assert found.json == told_json("identify", experiment) == json.loads((demo / "results.json").read_text())
    assert found.quote.splitlines() == program("identify", experiment).stdout.splitlines()[1:-1]
    loads = pandas.read_csv(demo / "loads.csv")
    pandas.testing.assert_frame_equal(found.to_pandas(), loads, check_exact=True, check_dtype=False)
    samples = pandas.read_csv(demo / "samples.csv")
    pandas.testing.assert_frame_equal(found.samples.to_pandas(), samples, check_exact=True, check_dtype=False)


def test_flags_in_place_of_an_experiment_file(demo, program):
    masses = {"413g": demo / "no_hull", 0.444: [demo / "small_hull" / "trial_1.wav", demo / "small_hull" / "trial_2.wav"]}
    found = hovertone.identify(vehicle="ardrone", mass=masses, output="out")
    assert [load["trial_count"] for load in found.loads] == [5, 2]
    assert found.page == Path("out/report.html") and found.page.is_file()
    # the folder tells the command that repeats it
    first = Path("out/experiment.toml").read_text().splitlines()[1]
    assert "hovertone identify --vehicle=ardrone --output=out" in first, first


def test_weigh(demo, identified, told_json):
    file, results = demo / "small_hull" / "trial_1.wav", demo / "results.json"
    expected = told_json("weigh", file, "--constant", results)
    for constant in (results, identified):
        weighed = hovertone.weigh(file, constant=constant)
        assert vars(weighed.mass_kg) == expected["mass_kg"] and vars(weighed.payload_kg) == expected["payload_kg"]


def test_fit_and_export(told_json, program):
    columns = {"rpm": [3000, 4000, 5000, 6000], "thrust_g": [70.0, 125.0, 194.0, 281.0]}
    pandas.DataFrame(columns).to_csv("stand.csv", index=False)
    expected = told_json("fit", "stand.csv")
    assert hovertone.fit("stand.csv").json == expected
    frame = pandas.DataFrame(columns)
    arrays = {name: np.array(column) for name, column in columns.items()}
    for table in (columns, frame, arrays, pyarrow.table(columns), pyarrow.RecordBatch.from_pydict(columns), OfPandas(frame), OfSeries(columns)):
        found = hovertone.fit(table)
        assert found.file == found.json["file"] == "the table"
        assert found.thrust_constant_total_n_s2.value == expected["thrust_constant_total_n_s2"]["value"]
        assert found.json["fit"] == expected["fit"]
    Path("fit.json").write_text(json.dumps(expected))
    lines = program("export", "fit.json", "--to", "gazebo").stdout
    assert hovertone.export("fit.json", "gazebo") == lines and "motorConstant" in lines
    assert "motorConstant" in hovertone.export(found, "gazebo")
    assert vars(hovertone.plan("413g")) == told_json("fit", "--plan", "--mass-kg", "0.413")


def test_simulate(program):
    scenario = 'seed = 7\nduration_s = 2.0\n[vehicle]\npreset = "ardrone"\n' + 2 * "[[microphone]]\nposition_m = [-2.0, 1.0, 2.0]\n"
    Path("scenario.toml").write_text(scenario)
    program("simulate", "scenario.toml", "-o", "flight")
    flight = hovertone.simulate(scenario)
    assert flight.json["hover"] == json.loads(Path("flight/truth.json").read_text())["hover"] and flight.folder is None
    assert flight.samples.shape == (96_000, 2)
    for number in (1, 2):
        written = hovertone.load("flight/sound.wav", channel=number)
        assert np.array_equal(flight.samples[:, number - 1], written.samples)
    written = pandas.read_csv("flight/truth.csv")
    pandas.testing.assert_frame_equal(flight.to_pandas(), written, check_exact=True, check_dtype=False)
    assert "Means over" in flight.text
