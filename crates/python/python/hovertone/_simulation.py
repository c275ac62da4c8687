"""Simulated flights: their sound and the truth about them."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping
from contextlib import contextmanager
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._extras import axes_of
from ._progress import Progress, listening
from ._rows import Drawn, Json
from ._sound import load
from ._words import Path, words

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Simulation", "demo", "simulate"]


@dataclass(frozen=True, eq=False)
class Simulation(Drawn):
    """A simulated flight. As a table: the truth, one row for each step.

    Attributes
    ----------
    samples : numpy.ndarray
        What the microphones hear, float32, shape (frames, microphones), as sound.wav has it.
    rate_hz : float
        Samples per second.
    truth : dict of numpy.ndarray
        Commands, voltages, speeds, forces, place and attitude over time; units stand in the names.
    json : dict
        Exact means over the hovers, and all settings: the content of truth.json.
    text : str
        The summary of the command line.
    folder : pathlib.Path or None
        Where sound.wav, truth.csv and truth.json are, where `output` names a folder.
    """

    samples: NDArray[np.float32] = field(repr=False)
    rate_hz: float
    truth: Mapping[str, NDArray[np.float64]] = field(repr=False)
    json: Json = field(repr=False)
    text: str = field(repr=False)
    folder: FilePath | None

    def _columns(self) -> dict[str, Any]:
        return dict(self.truth)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the true shaft speeds by matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw.
        """
        ax = axes_of(ax)
        for rotor in range(1, 5):
            ax.plot(self.truth["time_s"], self.truth[f"speed_{rotor}_rad_s"], label=f"rotor {rotor}", linewidth=1)
        ax.set(xlabel="time, s", ylabel="shaft speed, rad/s")
        ax.legend()
        return ax

    def _facts(self) -> Json:
        hover = self.json.get("hover") or {}
        shown = {name: self.json.get(name) for name in ("mass_kg", "gravity_m_s2", "seed")}
        return shown | {name: value for name, value in hover.items() if not isinstance(value, list)}


def simulate(scenario: Path | None = None, *, output: Path | None = None, seed: int | None = None, force: bool = False,
             progress: Progress = None) -> Simulation:
    """A flight from a scenario file: its sound as microphones hear it, and the truth.

    Parameters
    ----------
    scenario : path or str
        The scenario file, or its text.
    output : path, optional
        Folder for sound.wav, truth.csv and truth.json; without it nothing stays on disk.
    seed : int, optional
        Seed of all random numbers, in place of the scenario's.
    force : bool, optional
        Whether other files in that folder may be replaced.
    progress : callable or bool, optional
        Told the finished share, from 0 to 1; ``True`` shows a bar by tqdm.

    Returns
    -------
    Simulation
        Samples and truth.

    Examples
    --------
    >>> flight = simulate("seed = 7\\nduration_s = 1.0\\n[vehicle]\\npreset = 'ardrone'\\n[[microphone]]\\nposition_m = [2, 0, 2]")
    >>> flight.samples.shape, flight.json["seed"]
    ((48000, 1), 7)
    """
    with _scenario_file(scenario) as paths, tempfile.TemporaryDirectory(prefix="hovertone-") as temporary:
        folder = FilePath(temporary) / "simulation" if output is None else FilePath(output)
        with listening(progress) as listener:
            text, _, _ = _native.printed(words("simulate", paths, {"output": folder, "seed": seed, "force": force}), listener)
        facts = json.loads((folder / "truth.json").read_text(encoding="utf-8"))
        first = load(folder / "sound.wav", channel=1)
        channels = [first, *(load(folder / "sound.wav", channel=n) for n in range(2, first.facts["channel_count"] + 1))]
        with (folder / "truth.csv").open(encoding="utf-8") as file:
            names = file.readline().strip().split(",")
            rows = np.loadtxt(file, delimiter=",", ndmin=2)
    samples = np.stack([channel.samples for channel in channels], axis=1)
    truth = dict(zip(names, rows.T, strict=True))
    return Simulation(samples, first.rate_hz, truth, facts, text, None if output is None else folder)


@contextmanager
def _scenario_file(scenario: Path | None) -> Iterator[list[Path]]:
    if not isinstance(scenario, str) or "\n" not in scenario:
        yield [] if scenario is None else [scenario]
        return
    with tempfile.TemporaryDirectory(prefix="hovertone-") as folder:
        path = FilePath(folder) / "scenario.toml"
        path.write_text(scenario, encoding="utf-8")
        yield [path]


def demo(output: Path = "demo", *, seed: int = 1, force: bool = False, progress: Progress = None) -> str:
    """The paper's experiment in simulated flight: three loads with five trials each, heard and identified.

    Parameters
    ----------
    output : path, optional
        Folder for the recordings, the experiment file, the truth and the report.
    seed : int, optional
        Seed of all random numbers.
    force : bool, optional
        Whether other files in that folder may be replaced.
    progress : callable or bool, optional
        Told the finished share of the flights, then of the hearing, from 0 to 1; ``True`` shows a bar by tqdm.

    Returns
    -------
    str
        The paper's tables beside its own numbers and the truth.
    """
    with listening(progress) as listener:
        return _native.printed(words("demo", [], {"output": output, "seed": seed, "force": force}), listener)[0]
