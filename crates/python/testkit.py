"""What tests and examples share: a folder with recordings, and the command line to compare with."""

from __future__ import annotations

import json
import os
import subprocess
import wave
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import hovertone
import numpy as np
import pytest
from numpy.typing import NDArray

RATE_HZ = 16_000

EXPERIMENT = """\
[vehicle]
rotors = 1
blades = 2
mass_kg = 0.4

[[load]]
name = "bench"
thrust_n = 4.2
rotors_running = 1
recordings = ["hover.wav"]
"""


def rotor(rev_s: float, duration_s: float = 5.0) -> NDArray[np.float32]:
    """A rotor with two unlike blades, in some noise."""
    time_s = np.arange(int(RATE_HZ * duration_s)) / RATE_HZ
    noise = np.random.default_rng(1).uniform(-0.015, 0.015, len(time_s))
    levels = {order: (0.04 if order % 2 else 0.2) / order for order in range(1, 25)}
    lines = sum(level * np.cos(2 * np.pi * order * rev_s * time_s) for order, level in levels.items())
    return (noise + lines).astype(np.float32)


def write_wave(path: Path, samples: NDArray[np.float32]) -> None:
    """Samples as a file of 16 bits, one channel or several."""
    frames = np.round(samples * 32767).astype("<i2")
    with wave.open(str(path), "wb") as file:
        file.setnchannels(1 if frames.ndim == 1 else frames.shape[1])
        file.setsampwidth(2)
        file.setframerate(RATE_HZ)
        file.writeframes(frames.tobytes())


@pytest.fixture(autouse=True)
def _in_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, doctest_namespace: dict[str, Any]) -> None:
    """Each test and each example is in a folder of its own, with a recording and an experiment."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    doctest_namespace["hover"] = rotor(61.3)
    write_wave(tmp_path / "hover.wav", doctest_namespace["hover"])
    (tmp_path / "experiment.toml").write_text(EXPERIMENT)


@pytest.fixture(scope="session")
def demo(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the demo: 15 recordings, their experiment file and results."""
    folder = tmp_path_factory.mktemp("demo") / "demo"
    hovertone.demo(folder)
    return folder


@pytest.fixture(scope="session")
def identified(demo: Path) -> hovertone.Identification:
    """The constant of the demo."""
    return hovertone.identify(demo / "experiment.toml")


Program = Callable[..., "subprocess.CompletedProcess[str]"]


@pytest.fixture(scope="session")
def program() -> Program:
    """The command line. HOVERTONE_PROGRAM names it: without it nothing could be compared."""
    place = os.environ["HOVERTONE_PROGRAM"]

    def run(*words: str | os.PathLike[str]) -> subprocess.CompletedProcess[str]:
        return subprocess.run([place, *map(os.fspath, words)], capture_output=True, text=True, check=False)

    return run


@pytest.fixture
def told_json(program: Program) -> Iterator[Callable[..., Any]]:
    """What a command prints with --json."""
    yield lambda *words: json.loads(program(*words, "--json").stdout)
