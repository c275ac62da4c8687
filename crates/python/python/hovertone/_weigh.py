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
from ._rows import Drawn, Json, Kinds, filled, numbered
from ._words import Path, paths_of, words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from typing_extensions import Unpack

    from ._flags import WeighFlags

__all__ = ["Weighed", "weigh"]


@dataclass(frozen=True)
class Weighed(Drawn):
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
        data, _, _ = _native.printed(words("weigh", paths, flags | {"constant": results, "json": True}), listener)
    weighed: Json = json.loads(data)
    told = tuple(_told(weighed))
    if weighed["mass_kg"]:
        return filled(
            Weighed,
            weighed,
            mass_kg=filled(Estimate, weighed["mass_kg"]),
            payload_kg=estimate(weighed["payload_kg"]),
            warnings=told,
            json=weighed,
        )
    for one in weighed["recordings"]:
        if one["status"] == "error":
            raise FileError("; ".join(told), one["reason"], "", one["file"])
    raise NoRotorToneError("; ".join(told))


def _told(weighed: Json) -> Iterator[str]:
    """What weakens the answer, each with its recording.

    Examples
    --------
    >>> told = {"file": "a.wav", "status": "no_rotor_tone", "reason": "it is silent", "warnings": ["too short"]}
    >>> list(_told({"warnings": ["one flight"], "recordings": [told]}))
    ['one flight', 'a.wav: no rotor tone: it is silent', 'a.wav: too short']
    """
    yield from weighed["warnings"]
    for one in weighed["recordings"]:
        if one["reason"]:
            label = "" if one["status"] == "error" else one["status"].replace("_", " ") + ": "
            yield f"{one['file']}: {label}{one['reason']}"
        yield from (f"{one['file']}: {warning}" for warning in one["warnings"])
