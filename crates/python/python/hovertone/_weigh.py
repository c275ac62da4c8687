"""A mass from its sound."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from . import _native
from ._errors import FileError, NoRotorToneError
from ._estimate import Estimate, estimate
from ._export import Results, as_file
from ._extras import axes_of
from ._progress import Progress, listening
from ._rows import Json, Kinds, Shown, filled, numbered
from ._words import Path, paths_of, words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from typing_extensions import Unpack

    from ._flags import WeighFlags

__all__ = ["Weighed", "weigh"]


@dataclass(frozen=True)
class Weighed(Shown):
    """A mass from its sound.

    Attributes
    ----------
    mass_kg : Estimate
        Mass as flown, in kg.
    payload_kg : Estimate or None
        Mass of the payload, in kg, where the mass of the vehicle is known.
    speed_rad_s : float
        Shaft speed, in rad/s.
    recording_count : int
        Number of recordings with a rotor tone.
    has_flight_scatter : bool
        Whether the uncertainty contains how much the speed differs from flight to flight.
    warnings : tuple of str
        What weakens the answer, each with its recording; recordings without a speed and files that cannot be read, with the reason.
    json : dict
        All of it, as ``hovertone weigh --json`` prints it.
    """

    mass_kg: Estimate
    payload_kg: Estimate | None
    speed_rad_s: float
    recording_count: int
    has_flight_scatter: bool
    warnings: tuple[str, ...]
    json: Json = field(repr=False, compare=False)

    def _kinds(self) -> Kinds:
        masses: Kinds = {name: "float64" for name in ("mass_kg", "payload_kg", "mass_std_kg", "payload_std_kg", "speed_rad_s")}
        return {**masses, "recording_count": "int64"}

    def _columns(self) -> dict[str, Any]:
        masses = {"mass_kg": self.mass_kg, "payload_kg": self.payload_kg}
        values = {name: [mass and mass.value] for name, mass in masses.items()}
        stds = {name.replace("_kg", "_std_kg"): [mass and mass.std_uncertainty] for name, mass in masses.items()}
        return values | stds | {"speed_rad_s": [self.speed_rad_s], "recording_count": [self.recording_count]}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the masses with their expanded uncertainties (k = 2) by matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw.
        """
        ax = axes_of(ax)
        masses = {"as flown": self.mass_kg, "payload": self.payload_kg}
        for name, mass in masses.items():
            if mass is not None:
                ax.errorbar([name], [mass.value], yerr=[2 * (mass.std_uncertainty or 0.0)], fmt="o", capsize=4)
        ax.set(ylabel="mass, kg")
        return ax

    def _facts(self) -> Json:
        return {name: values[0] for name, values in self._columns().items()} | numbered(self.warnings)


def weigh(
    recordings: Path | Iterable[Path] = (), *, constant: Results | None = None, progress: Progress = None, **flags: Unpack[WeighFlags]
) -> Weighed:
    """Mass of an unknown payload, from the sound of a hover and a known thrust constant.

    Parameters
    ----------
    recordings : path or iterable of paths
        Files of hovers with the same payload; no arrays.
    constant : path, Identification or Fit, optional
        The constant, with mass, gravity and tone: an identification, or its results.json.
    progress : callable or bool, optional
        Told the finished share, from 0 to 1; ``True`` shows a bar by tqdm.
    **flags
        The flags of ``hovertone weigh``: `constant_n_s2` (N s², of the whole vehicle), `constant_std_n_s2`, `group`, `rotors`, `mass_kg`,
        `mass_std_kg`; `gravity_m_s2`, `latitude_deg`, `height_m`; `blades`, `gear`, `order`, `vehicle`, `band`, `harmonics`;
        `audio_track`, `channel`, `clock_correction_ppm`.

    Returns
    -------
    Weighed
        The mass as flown, and that of the payload.

    Raises
    ------
    FileError
        No recording has a rotor tone, and a file cannot be read.
    NoRotorToneError
        No recording has a rotor tone.

    Examples
    --------
    >>> weighed = weigh("hover.wav", constant_n_s2=2.831e-5, blades=2, rotors=1, mass_kg=0.4)
    >>> f"{weighed.mass_kg.value:.3f} kg"
    '0.428 kg'
    """
    paths = paths_of(recordings, "give names of files, without empty cells; weigh hears no arrays")
    with as_file(constant) as results, listening(progress) as listener:
        data, messages, _ = _native.printed(words("weigh", paths, flags | {"constant": results, "json": True}), listener)
    told = list(_messages(messages))
    if data:
        weighed: Json = json.loads(data)
        return filled(
            Weighed,
            weighed,
            mass_kg=filled(Estimate, weighed["mass_kg"]),
            payload_kg=estimate(weighed["payload_kg"]),
            warnings=tuple(text for _, text in told),
            json=weighed,
        )
    all_texts = "; ".join(text for _, text in told)
    for label, text in told:
        if label == "error":
            file, _, reason = text.partition(": ")
            raise FileError(all_texts, reason, "", file)
    raise NoRotorToneError(all_texts)


def _messages(text: str) -> Iterator[tuple[str, str]]:
    """The messages that the command prints beside its answer, each with its label and with the recording that it is about.

    Examples
    --------
    >>> list(_messages("1 warning\\na.wav\\n  no rotor tone: it is silent\\n  warning: too loud (hint: x)\\nerror: b.wav: there is no such file\\n"))
    [('no rotor tone', 'a.wav: no rotor tone: it is silent'), ('warning', 'a.wav: too loud (hint: x)'), ('error', 'b.wav: there is no such file')]
    """
    heading = ""
    for line in text.splitlines():
        label, colon, words_of = line.strip().partition(": ")
        if line.startswith("  ") and not colon or line.startswith("  cut ") or label == "cut":
            # times that are cut weaken nothing
            continue
        if not colon or label not in _LABELS:
            # a number of warnings, or the recording of the next lines
            heading = line
            continue
        said = words_of if label in ("warning", "error") else f"{label}: {words_of}"
        yield label, f"{heading}: {said}" if line.startswith("  ") else said


#: What stands before a message.
_LABELS = ("warning", "error", "no rotor tone", "ambiguous")
