"""Rotor speeds of recordings."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._errors import FileError
from ._extras import axes_of
from ._heard import OfSound
from ._progress import Progress, listening
from ._rows import Drawn, Json, Kinds, filled, kinds_of, numbered
from ._sound import SAMPLES_HINT, Recording, to_hear
from ._words import Path, paths_of, refused, words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from typing_extensions import Unpack

    from ._flags import SpeedFlags

__all__ = ["Reading", "Rotor", "Speed", "Track", "speed", "speeds", "track"]

Status = Literal["ok", "ambiguous", "no_rotor_tone", "error"]
#: Fields of a speed that are one number or one word.
_SCALARS = (
    "file", "status", "method", "rotors_heard", "order", "tone_hz", "speed_rev_s", "speed_rpm", "speed_rad_s", "std_uncertainty_rev_s",
    "combined_std_uncertainty_rev_s", "spread_rev_s", "mean_square_rad2_s2", "from_s", "to_s", "reason", "frame_count", "window_s",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Track(Drawn):
    """The shaft speed over time, as ``hovertone speed --track`` writes it.

    Attributes
    ----------
    time_s : numpy.ndarray
        Middle of the frame, in s.
    tone_hz : numpy.ndarray
        Frequency of the tone, in Hz.
    speed_rev_s : numpy.ndarray
        Shaft speed, in rev/s.
    std_uncertainty_rev_s : numpy.ndarray
        Its standard uncertainty, in rev/s.
    level_db : numpy.ndarray
        Level of the strongest harmonic, in dB re a full-scale sine.
    rotor : numpy.ndarray
        Number of the rotor, fastest first; 0 for all together.
    """

    time_s: NDArray[np.float64]
    tone_hz: NDArray[np.float64]
    speed_rev_s: NDArray[np.float64]
    std_uncertainty_rev_s: NDArray[np.float64]
    level_db: NDArray[np.float64]
    rotor: NDArray[np.int64]

    @classmethod
    def _of(cls, heard: _native.Heard) -> Track:
        return cls(*heard.track())

    def __len__(self) -> int:
        return len(self.time_s)

    def _columns(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in self.__dataclass_fields__}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw speed over time by matplotlib, with the standard uncertainty as a band.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw.
        """
        ax = axes_of(ax)
        for rotor in np.unique(self.rotor):
            of = self.rotor == rotor
            time_s, speed, std = self.time_s[of], self.speed_rev_s[of], self.std_uncertainty_rev_s[of]
            (line,) = ax.plot(time_s, speed, label=f"rotor {rotor}" if rotor else "all rotors", linewidth=1)
            ax.fill_between(time_s, speed - std, speed + std, alpha=0.25, color=line.get_color(), linewidth=0)
        ax.set(xlabel="time, s", ylabel="shaft speed, rev/s")
        if len(np.unique(self.rotor)) > 1:
            ax.legend()
        return ax

    def _facts(self) -> Json:
        rotors = ", ".join("all together" if rotor == 0 else str(rotor) for rotor in np.unique(self.rotor))
        rows: Json = {"points": len(self), "rotors": rotors or None}
        if len(self):
            rows |= {"from_s": float(self.time_s.min()), "to_s": float(self.time_s.max())}
            rows |= {"lowest speed_rev_s": float(self.speed_rev_s.min()), "highest speed_rev_s": float(self.speed_rev_s.max())}
        return rows


@dataclass(frozen=True)
class Rotor:
    """One of several rotors that were separated.

    Attributes
    ----------
    speed_rev_s : float
        Mean shaft speed, in rev/s.
    std_uncertainty_rev_s, combined_std_uncertainty_rev_s : float or None
        Standard uncertainty of the sound alone, and of everything, in rev/s.
    spread_rev_s : float or None
        Standard deviation over time, in rev/s.
    mean_square_rad2_s2 : float or None
        Mean of ω², in rad²/s².
    label : dict or None
        Name of the rotor, with its probability.
    merged : list
        Spans in which two rotors were too near each other to be separated.
    condition : dict or None
        Levels of the lines of its shaft, where ``condition=True`` asks for them.
    """

    speed_rev_s: float
    std_uncertainty_rev_s: float | None
    combined_std_uncertainty_rev_s: float | None
    spread_rev_s: float | None
    mean_square_rad2_s2: float | None
    label: Json | None
    merged: list[Json]
    condition: Json | None


@dataclass(frozen=True)
class Reading:
    """A shaft speed that a tone can mean.

    Attributes
    ----------
    order : float
        Lines of the tone per turn of the shaft.
    tone_hz : float
        Frequency of the tone, in Hz.
    meaning : str
        Such as ``"blade_pass"``.
    blades : int or None
        Number of blades.
    gear : dict or None
        Teeth of pinion and wheel.
    speed_rev_s, speed_rpm, speed_rad_s : float
        Shaft speed.
    motor_rpm : float
        Speed of the motor, in rpm.
    tip_mach, thrust_coefficient : float or None
        Of the blades, where diameter and mass are known.
    plausibility : float
        From 0 to 1.
    why : str
        What speaks for it or against it.
    """

    order: float
    tone_hz: float
    meaning: str
    blades: int | None
    gear: Json | None
    speed_rev_s: float
    speed_rpm: float
    speed_rad_s: float
    motor_rpm: float
    tip_mach: float | None
    thrust_coefficient: float | None
    plausibility: float
    why: str


@dataclass(frozen=True, eq=False)
class Speed(OfSound):
    """The rotor speed of a recording. No rotor tone is an answer with its reason, and no exception.

    Attributes
    ----------
    file : str
        The recording as given.
    status : str
        ``"ok"``, ``"ambiguous"``, ``"no_rotor_tone"``; ``"error"`` only from :func:`speeds`.
    method : str
        How the speed was read from the sound.
    rotors_heard : str or None
        ``"separated"``, ``"group"`` or ``"one_tone"``.
    order : float or None
        Lines of the tone per turn of the shaft.
    tone_hz : float or None
        Mean frequency of the tone, in Hz.
    speed_rev_s, speed_rpm, speed_rad_s : float or None
        Mean shaft speed, in rev/s, rpm and rad/s.
    std_uncertainty_rev_s : float or None
        Standard uncertainty of the sound alone, in rev/s.
    combined_std_uncertainty_rev_s : float or None
        Standard uncertainty with clock, drift and what is not known of the rotors, in rev/s.
    uncertainty_budget : list of dict or None
        Its contributions.
    spread_rev_s : float or None
        Standard deviation of the speed over time, in rev/s.
    mean_square_rad2_s2 : float or None
        Mean of ω² over rotors and time, in rad²/s²; thrust is proportional to it.
    rotors : tuple of Rotor
        Rotors that were separated, fastest first.
    from_s, to_s : float or None
        The used part of the recording, in s.
    warnings : tuple of str
        What weakens the answer.
    reason : str or None
        Why there is no speed.
    found : Reading or None
        The reading that was used, where the tone was searched for.
    alternatives : tuple of Reading
        Readings that stay plausible.
    frame_count : int or None
        Number of frames.
    window_s : float or None
        Length of a frame, in s.
    json : dict
        All of it, as ``hovertone speed --json`` prints it.
    track : Track
        The speed over time.
    """

    file: str
    status: Status
    method: str
    rotors_heard: str | None
    order: float | None
    tone_hz: float | None
    speed_rev_s: float | None
    speed_rpm: float | None
    speed_rad_s: float | None
    std_uncertainty_rev_s: float | None
    combined_std_uncertainty_rev_s: float | None
    uncertainty_budget: list[Json] | None
    spread_rev_s: float | None
    mean_square_rad2_s2: float | None
    rotors: tuple[Rotor, ...]
    from_s: float | None
    to_s: float | None
    warnings: tuple[str, ...]
    reason: str | None
    found: Reading | None
    alternatives: tuple[Reading, ...]
    frame_count: int | None
    window_s: float | None
    track: Track = field(repr=False)

    @classmethod
    def _of(cls, heard: _native.Heard) -> Speed:
        data: Json = json.loads(heard.speed_json())
        return filled(
            cls,
            data,
            rotors=tuple(filled(Rotor, rotor) for rotor in data.get("rotors", [])),
            warnings=tuple(data["warnings"]),
            found=filled(Reading, data["found"]) if data.get("found") else None,
            alternatives=tuple(filled(Reading, reading) for reading in data.get("alternatives", [])),
            json=data,
            track=Track._of(heard),
            _heard=heard,
        )

    def _columns(self) -> dict[str, Any]:
        return {name: [getattr(self, name)] for name in _SCALARS}

    def _kinds(self) -> Kinds:
        return kinds_of(Speed, *_SCALARS)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the speed over time by matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw.
        """
        ax = self.track.plot(ax)
        ax.set_title(self.file)
        return ax

    def _facts(self) -> Json:
        shown = ("file", "status", "speed_rev_s", "combined_std_uncertainty_rev_s", "speed_rpm", "spread_rev_s", "order", "tone_hz", "reason")
        rows: Json = {name: getattr(self, name) for name in shown}
        return rows | numbered(self.warnings)


def speed(
    recording: Recording | None = None,
    *,
    rate_hz: float | None = None,
    progress: Progress = None,
    **flags: Unpack[SpeedFlags],
) -> Speed:
    """Rotor speed of a recording: mean, uncertainty and spread.

    Parameters
    ----------
    recording : path, Sound or array
        A video or audio file; a decoded recording; or samples, shape (frames,) or (frames, channels), float of full scale 1, or
        whole numbers of 16 or 32 bits. An array is copied once.
    rate_hz : float, optional
        Samples per second of an array.
    progress : callable or bool, optional
        Told the finished share, from 0 to 1; ``True`` shows a bar by tqdm.
    **flags
        The flags of ``hovertone speed``: `blades`, `gear` (8:69 or (8, 69)), `order`, `vehicle`, `band` (Hz), `harmonics`; `diameter_m`,
        `mass_kg`, `rotors`; `mean_only`, `method`, `clock_ppm`, `condition`, `radial_speed_m_s_max`, `drift_m_max`, `from_` and `to` (s, or
        1:02.5), `window_s`, `hop_share`, `gaussian_threshold_share`; `audio_track`, `channel`, `clock_correction_ppm`; `log`,
        `log_offset_s`, `log_axes`, `spin_up`, `layout`, `microphones`.

    Returns
    -------
    Speed
        The speed, or the reason why there is none.

    Raises
    ------
    WrongUseError
        A flag or a number has no meaning.
    FileError
        The file cannot be read.

    Examples
    --------
    >>> found = speed("hover.wav", blades=2)
    >>> f"{found.speed_rev_s:.1f} rev/s"
    '61.3 rev/s'
    >>> speed(hover, rate_hz=16000, blades=2).status
    'ok'
    >>> speed("hover.wav", blades=0)
    Traceback (most recent call last):
    hovertone._errors.WrongUseError: --blades 0: must be a whole number from 1 to 12 (hint: for example `hovertone speed --blades 2 hover.mp4`; see `hovertone speed --help`)
    """
    heard = to_hear(recording, rate_hz)
    with listening(progress) as listener:
        found = _native.heard(words("speed", heard.paths, flags | {"json": True}), heard.samples, heard.rate_hz, listener)
    return Speed._of(one(found, heard.paths))


def speeds(recordings: Path | Iterable[Path], *, progress: Progress = None, **flags: Unpack[SpeedFlags]) -> list[Speed]:
    """Rotor speeds of several recordings, heard on all cores.

    Parameters
    ----------
    recordings : path or iterable of paths
        Files and patterns, such as ``"archive/*.wav"``: a list, ``Path("archive").glob("**/*.wav")``, a column of a table. A set is sorted.
    progress : callable or bool, optional
        Told the finished share, from 0 to 1; ``True`` shows a bar by tqdm.
    **flags
        As for :func:`speed`.

    Returns
    -------
    list of Speed
        One for each file, in their order. A file that cannot be read has the status ``"error"`` and its reason.

    Examples
    --------
    >>> [found.status for found in speeds("*.wav", blades=2)]
    ['ok']
    """
    paths = paths_of(recordings, SAMPLES_HINT)
    with listening(progress) as listener:
        found = _native.heard(words("speed", paths, flags | {"json": True}), on_progress=listener)
    return [Speed._of(heard) for heard in found]


def track(
    recording: Recording | None = None,
    *,
    rate_hz: float | None = None,
    progress: Progress = None,
    **flags: Unpack[SpeedFlags],
) -> Track:
    """The shaft speed over time, of each rotor that can be separated.

    Parameters
    ----------
    recording, rate_hz, progress, **flags
        As for :func:`speed`.

    Returns
    -------
    Track
        Arrays of equal length; empty without a rotor tone.

    Examples
    --------
    >>> speeds_over_time = track("hover.wav", blades=2)
    >>> bool(abs(speeds_over_time.speed_rev_s - 61.3).max() < 0.1)
    True
    """
    return speed(recording, rate_hz=rate_hz, progress=progress, **flags).track


def one(found: Sequence[_native.Heard], paths: Sequence[Path]) -> _native.Heard:
    """The one recording that was heard, where it could be read."""
    if len(found) != 1:
        what = f"{paths[0]} means {len(found)} recordings, and this call hears one"
        raise refused(what, "name one of them, or call hovertone.speeds()")
    data = json.loads(found[0].speed_json())
    if data["status"] == "error":
        # the reason has the advice
        raise FileError(f"{data['file']}: {data['reason']}", data["reason"], "", data["file"])
    return found[0]
