"""Arrays beside files."""

from pathlib import Path

import hovertone
import hovertone._archive
import numpy as np
import pandas
import pyarrow
import pytest
from testkit import RATE_HZ, rotor, write_wave


def numbers(found):
    return {name: value for name, value in found.json.items() if name not in ("file", "recording")}


def test_a_loaded_file_is_heard_as_the_file():
    sound = hovertone.load("hover.wav")
    assert (sound.samples.dtype, sound.rate_hz, sound.start_s, sound.name) == (np.float32, RATE_HZ, 0.0, "hover.wav")
    assert sound.facts["codec"] == "16-bit PCM" and len(sound) == 5 * RATE_HZ
    by_file = hovertone.speed("hover.wav", blades=2)
    for found in (hovertone.speed(sound, blades=2), hovertone.speed(sound.samples, rate_hz=RATE_HZ, blades=2)):
        assert numbers(found) == numbers(by_file)
        assert np.array_equal(found.track.speed_rev_s, by_file.track.speed_rev_s)
    assert "families" in hovertone.tones(sound).json


@pytest.mark.parametrize("kind", ["float32", "float64", "int16", "int32"])
def test_every_type_has_its_full_scale(kind):
    scale = {"int16": 32768, "int32": 32768 * 65536}.get(kind, 1)
    samples = (np.round(hovertone.load("hover.wav").samples * 32768).astype(np.int64) * (scale / 32768)).astype(kind)
    assert numbers(hovertone.speed(samples, rate_hz=RATE_HZ, blades=2)) == numbers(hovertone.speed("hover.wav", blades=2))


def test_channels_and_strides():
    quiet = np.stack([np.zeros(5 * RATE_HZ, np.float32), rotor(61.3)], axis=1)
    write_wave(Path("two.wav"), quiet)
    heard = hovertone.speed(hovertone.load("two.wav", channel=2), blades=2)
    assert numbers(heard) == numbers(hovertone.speed("two.wav", channel=2, blades=2)) | {"settings": heard.json["settings"]}
    assert hovertone.speed(quiet, rate_hz=RATE_HZ, channel=2, blades=2).speed_rev_s == hovertone.speed(
        np.asfortranarray(quiet)[:, 1], rate_hz=RATE_HZ, blades=2
    ).speed_rev_s
    assert hovertone.speed(quiet, rate_hz=RATE_HZ, channel=1, blades=2).status == "no_rotor_tone"
    frame = pandas.DataFrame(quiet, columns=["left", "right"])
    assert hovertone.speed(frame, rate_hz=RATE_HZ, channel=2, blades=2).status == "ok"


@pytest.mark.parametrize(
    ("samples", "rate_hz", "error", "words"),
    [
        (np.zeros(9), None, hovertone.WrongUseError, "give rate_hz, the samples per second"),
        (np.zeros(9), 0, hovertone.FileError, "array: rate_hz = 0, but it must be 1 or more"),
        (np.zeros(9), float("nan"), hovertone.FileError, "rate_hz = NaN"),
        (np.zeros(0), 8000, hovertone.FileError, "the array has no audio samples"),
        (np.zeros((2, 9000)), 8000, hovertone.WrongUseError, "frames come first: give samples.T"),
        (np.zeros((2, 2, 2)), 8000, hovertone.WrongUseError, "this array has 3"),
        (np.zeros(9, complex), 8000, TypeError, "float32, float64, int16 or int32"),
        ("hover.wav", 8000, hovertone.WrongUseError, "leave rate_hz out"),
    ],
)
def test_what_is_no_sound_is_refused(samples, rate_hz, error, words):
    with pytest.raises(error, match=words):
        hovertone.speed(samples, rate_hz=rate_hz, blades=2)


def test_an_array_has_no_labels_by_microphones():
    with pytest.raises(hovertone.HovertoneError):
        hovertone.speed(rotor(61.3), rate_hz=RATE_HZ, blades=2, rotors=4, microphones="stands.toml")


def test_a_sound_is_an_array_by_the_rules_of_numpy():
    sound = hovertone.load("hover.wav")
    assert np.asarray(sound) is sound.samples or np.shares_memory(np.asarray(sound), sound.samples)
    assert not np.shares_memory(np.array(sound), sound.samples)
    assert np.asarray(sound, dtype=np.float64).dtype == np.float64
    assert not np.shares_memory(np.array(sound, copy=True), sound.samples)
    if np.lib.NumpyVersion(np.__version__) >= "2.0.0":
        assert np.shares_memory(np.array(sound, copy=False), sound.samples)
        with pytest.raises(ValueError, match="copy"):
            np.array(sound, dtype=np.float64, copy=False)
    # NumPy 1 gives the type alone, or nothing
    assert sound.__array__(np.float64).dtype == np.float64 and len(sound.__array__()) == len(sound)


PATHS = {
    "generator": lambda: (path for path in ["hover.wav", "b.wav"]),
    "glob": lambda: Path(".").glob("*.wav"),
    "set": lambda: {"hover.wav", Path("b.wav")},
    "array": lambda: np.array(["hover.wav", "b.wav"]),
    "array of objects": lambda: np.array([Path("hover.wav"), "b.wav"], dtype=object),
    "pandas": lambda: pandas.DataFrame({"file": ["hover.wav", "b.wav"]})["file"],
    "arrow": lambda: pyarrow.table({"file": ["hover.wav", "b.wav"]})["file"],
    "keys": lambda: {"hover.wav": 1, "b.wav": 2}.keys(),
}


@pytest.mark.parametrize("kind", PATHS)
def test_any_iterable_of_paths_is_heard(kind):
    write_wave(Path("b.wav"), rotor(61.35, 2.0))
    expected = ["b.wav", "hover.wav"]
    assert sorted(one.file for one in hovertone.speeds(PATHS[kind](), blades=2)) == expected
    assert sorted(hovertone._archive.names(PATHS[kind](), {"blades": 2})) == expected
    if kind == "generator":
        assert hovertone.weigh(PATHS[kind](), constant_n_s2=2.83e-5, blades=2, rotors=1).recording_count == 2
    if kind in ("set", "keys"):
        assert [one.file for one in hovertone.speeds(PATHS[kind](), blades=2)] == expected
