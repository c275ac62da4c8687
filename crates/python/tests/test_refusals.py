"""Refusals have the words of the command line."""

import pickle
from pathlib import Path
from types import SimpleNamespace

import hovertone
import hovertone.dask
import hovertone.ray
import numpy as np
import pandas
import pytest
from testkit import write_wave

#: A call, and the command line that means the same.
CASES = [
    (lambda: hovertone.speed(), ["speed"]),
    (lambda: hovertone.speed("none.wav", blades=2), ["speed", "--blades", "2", "none.wav"]),
    (lambda: hovertone.speed(".", blades=2), ["speed", "--blades", "2", "."]),
    (lambda: hovertone.speed("*.flac", blades=2), ["speed", "--blades", "2", "*.flac"]),
    (lambda: hovertone.speed("experiment.toml", blades=2), ["speed", "--blades", "2", "experiment.toml"]),
    (lambda: hovertone.speed("hover.wav", blades=0), ["speed", "--blades", "0", "hover.wav"]),
    (lambda: hovertone.speed("hover.wav", blades=2.5), ["speed", "--blades", "2.5", "hover.wav"]),
    (lambda: hovertone.speed("hover.wav", vehicle="ardron"), ["speed", "--vehicle", "ardron", "hover.wav"]),
    (lambda: hovertone.speed("hover.wav", vehicle="ardrone", blades=3), ["speed", "--vehicle", "ardrone", "--blades", "3", "hover.wav"]),
    (lambda: hovertone.speed("hover.wav", blades=2, band=(9, 5)), ["speed", "--blades", "2", "--band", "9:5", "hover.wav"]),
    (lambda: hovertone.speed("hover.wav", blades=2, from_=-1), ["speed", "--blades", "2", "--from", "-1", "hover.wav"]),
    (lambda: hovertone.speed("hover.wav", clock_ppm=-1), ["speed", "--clock-ppm", "-1", "hover.wav"]),
    (lambda: hovertone.speed("hover.wav", diameter_m="8ft"), ["speed", "--diameter-m", "8ft", "hover.wav"]),
    (lambda: hovertone.speed("hover.wav", method="guess"), ["speed", "--method", "guess", "hover.wav"]),
    (lambda: hovertone.speed("hover.wav", channel=2, blades=2), ["speed", "--channel", "2", "--blades", "2", "hover.wav"]),
    (lambda: hovertone.speed("hover.wav", bladse=2), ["speed", "--bladse=2", "hover.wav"]),
    (lambda: hovertone.speed("-", blades=2), ["speed", "--blades", "2", "./-"]),
    (lambda: hovertone.load("none.wav"), ["tones", "none.wav"]),
    (lambda: hovertone.tones("hover.wav", rotors=0), ["tones", "--rotors", "0", "hover.wav"]),
    (lambda: hovertone.identify(), ["identify"]),
    (lambda: hovertone.identify("none.toml"), ["identify", "none.toml"]),
    (lambda: hovertone.identify("hover.wav"), ["identify", "hover.wav"]),
    (lambda: hovertone.identify("experiment.toml", mass={0.4: "hover.wav"}), ["identify", "experiment.toml", "--mass", "0.4=hover.wav"]),
    (lambda: hovertone.identify(mass={0.4: "hover.wav"}), ["identify", "--mass", "0.4=hover.wav"]),
    (lambda: hovertone.fit(), ["fit"]),
    (lambda: hovertone.fit("hover.wav"), ["fit", "hover.wav"]),
    (lambda: hovertone.plan(-1), ["fit", "--plan", "--mass-kg=-1"]),
    (lambda: hovertone.weigh("hover.wav"), ["weigh", "hover.wav"]),
    (lambda: hovertone.weigh("hover.wav", constant_n_s2=5.0), ["weigh", "hover.wav", "--constant-n-s2", "5"]),
    (lambda: hovertone.export("none.json", "gazebo"), ["export", "none.json", "--to", "gazebo"]),
    (lambda: hovertone.export("none.json"), ["export", "none.json"]),
    (lambda: hovertone.export("none.json", "unreal"), ["export", "none.json", "--to", "unreal"]),
    (lambda: hovertone.simulate(), ["simulate"]),
    (lambda: hovertone.simulate("experiment.toml", output="out"), ["simulate", "experiment.toml", "-o", "out"]),
]


@pytest.mark.parametrize(("call", "words"), CASES, ids=[" ".join(words) for _, words in CASES])
def test_the_same_words(call, words, program):
    run = program(*words)
    expected = next(line for line in run.stderr.splitlines() if line.startswith("error: ")).removeprefix("error: ")
    with pytest.raises(hovertone.HovertoneError) as raised:
        call()
    assert str(raised.value).splitlines()[0] == expected
    assert (run.returncode == 2) == isinstance(raised.value, hovertone.WrongUseError), run.returncode


def test_an_error_knows_its_parts():
    with pytest.raises(hovertone.FileError) as raised:
        hovertone.identify("none.toml")
    error = raised.value
    assert error.path == "none.toml" and error.hint == "check the name and the folder of the experiment file"
    assert str(error) == f"none.toml: {error.what} (hint: {error.hint})"
    assert isinstance(hovertone.WrongUseError("x"), ValueError)
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.path, again.hint) == (str(error), error.path, error.hint)


def test_a_pattern_of_several_is_no_recording():
    Path("again.wav").write_bytes(Path("hover.wav").read_bytes())
    with pytest.raises(hovertone.WrongUseError, match=r"\*\.wav means 2 recordings"):
        hovertone.speed("*.wav", blades=2)


def test_no_rotor_tone_is_an_answer_and_no_mass():
    write_wave(Path("silence.wav"), np.zeros(80_000, np.float32))
    found = hovertone.speed("silence.wav", blades=2)
    assert (found.status, found.speed_rev_s, len(found.track)) == ("no_rotor_tone", None, 0) and found.reason
    with pytest.raises(hovertone.NoRotorToneError, match="no rotor tone"):
        hovertone.weigh("silence.wav", constant_n_s2=2.8e-5, blades=2, rotors=1)
    with pytest.raises(hovertone.FileError, match="none.wav: .*no such file") as raised:
        hovertone.weigh(["silence.wav", "none.wav"], constant_n_s2=2.8e-5, blades=2, rotors=1)
    assert raised.value.path == "none.wav"
    listed = hovertone.speeds(["silence.wav", "none.wav"], blades=2)
    assert [one.status for one in listed] == ["no_rotor_tone", "error"] and listed[1].figure() is None


def test_interrupts_are_the_interpreters():
    import signal

    hovertone.identify("experiment.toml", output="out")
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: hovertone.speed(["hover.wav"]), "hovertone.speeds()"),
        (lambda: hovertone.tones(("a.wav", "b.wav")), "hovertone.speeds()"),
        (lambda: hovertone.track(np.array(["hover.wav"])), "hovertone.speeds()"),
        (lambda: hovertone.speed([hovertone.load("hover.wav")]), "hovertone.speeds()"),
        (lambda: hovertone.speed(Path(".").glob("*.wav")), "hovertone.speeds()"),
        (lambda: hovertone.speed(pandas.DataFrame({"file": ["hover.wav"]})), "hovertone.speeds()"),
        (lambda: hovertone.load(["hover.wav"]), "give the name of one file"),
        (lambda: hovertone.speeds(["hover.wav", float("nan")]), "number 2 of them is nan (float)"),
        (lambda: hovertone.speeds(None), "this is None"),
        (lambda: hovertone.speeds(np.array("hover.wav")), "of the type ndarray"),
        (lambda: hovertone.speeds(hovertone.load("hover.wav")), "hovertone.speed() hears a Sound"),
        (lambda: hovertone.speeds(pandas.DataFrame({"file": ["hover.wav"]})), 'table["file"]'),
        (lambda: hovertone.weigh(np.zeros(9), constant_n_s2=2.8e-5), "weigh hears no arrays"),
        (lambda: hovertone.fits([{"rpm": [1]}]), "number 1 of them is of the type dict"),
    ],
)
def test_what_is_no_path_gets_a_sentence(call, words):
    with pytest.raises(hovertone.WrongUseError) as raised:
        call()
    assert words in str(raised.value) and raised.value.hint


GOOD = {"rpm": [3e3, 4e3, 5e3], "thrust_g": [70.0, 125.0, 194.0]}


@pytest.mark.parametrize(
    ("table", "words"),
    [
        (pandas.DataFrame(GOOD | {"thrust_g": [70.0, float("nan"), 194.0]}), 'the table: line 3, column "thrust_g": "nan" is no number'),
        (GOOD | {"thrust_g": [70.0]}, "the table: the columns have different numbers of rows: rpm has 3, thrust_g has 1"),
        (GOOD | {"thrust_g": 70.0}, 'the table: column "thrust_g" holds one value'),
        (GOOD | {"motor": "abc"}, 'the table: column "motor" holds one value'),
        ({"rpm": [3e3, 4e3, 5e3]}, "the table: no column holds a thrust"),
        (pandas.DataFrame([[1, 2]], columns=["rpm", "rpm"]), "the table: several columns have the same name"),
        ({}, "the table: "),
        (SimpleNamespace(columns=["rpm"]), "the table is of the type SimpleNamespace"),
    ],
)
def test_a_table_in_memory_is_named_as_the_table(table, words):
    with pytest.raises(hovertone.HovertoneError) as raised:
        hovertone.fit(table)
    error = raised.value
    assert str(error).startswith(words) and ".csv" not in str(error), str(error)
    assert error.path is None and error.hint


@pytest.mark.parametrize("engine", [hovertone.ray, hovertone.dask])
def test_a_package_without_stores_says_how_to_get_them(engine, monkeypatch):
    def absent(words):
        raise hovertone.WrongUseError("x", "s3://flights: this hovertone was built without stores", "cargo build")

    monkeypatch.setattr(hovertone._native, "archive_names", absent)
    with pytest.raises(hovertone.WrongUseError, match="built without stores.*pip install ./crates/python --config-settings") as raised:
        engine.speeds("s3://flights", blades=2)
    assert "cargo" not in raised.value.hint
