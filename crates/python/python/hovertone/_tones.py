"""Tone families of recordings, and the shaft speeds that they can mean."""

from __future__ import annotations

import json
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

from . import _native
from ._extras import axes_of
from ._heard import OfSound
from ._progress import Progress, listening
from ._rows import Json, Kinds, column_wise, filled, kinds_of
from ._sound import Recording, to_hear
from ._speed import Reading, Status, one
from ._words import words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from typing_extensions import Unpack

    from ._flags import TonesFlags

__all__ = ["ToneFamily", "Tones", "tones"]


@dataclass(frozen=True)
class ToneFamily:
    """A series of lines with one fundamental.

    Attributes
    ----------
    is_rotor : bool
        Whether it was taken for the rotor's.
    fundamental_hz, spread_hz : float
        Mean and standard deviation of the fundamental, in Hz.
    harmonics : list of dict
        `number`, `hz` and `level_db` over the floor.
    level_db : float
        Highest level over the floor, in dB.
    time_share : float
        Share of the time in which it is heard.
    from_s, to_s : float
        When it is heard, in s.
    is_settled : bool
        Whether it is the rotor's and one reading has 99 % of the plausibility.
    remark : str or None
        What else it may be.
    readings : tuple of Reading
        What it can mean, most plausible first.
    """

    is_rotor: bool
    fundamental_hz: float
    spread_hz: float
    harmonics: list[Json]
    level_db: float
    time_share: float
    from_s: float
    to_s: float
    is_settled: bool
    remark: str | None
    readings: tuple[Reading, ...]

    @classmethod
    def _of(cls, data: Json) -> ToneFamily:
        return filled(cls, data, readings=tuple(filled(Reading, reading) for reading in data["readings"]))


@dataclass(frozen=True, eq=False)
class Tones(OfSound):
    """The tone families of a recording. As a table: one row for each reading of each family.

    Attributes
    ----------
    file : str
        The recording as given.
    status : str
        As that of :class:`Speed`.
    tone_hz, speed_rev_s : float or None
        The tone of the rotor in Hz, and its shaft speed in rev/s, where a reading is settled.
    families : tuple of ToneFamily
        Strongest first.
    warnings : tuple of str
        What weakens the answer.
    json : dict
        All of it, as ``hovertone tones --json`` prints it.
    """

    file: str
    status: Status
    tone_hz: float | None
    speed_rev_s: float | None
    families: tuple[ToneFamily, ...]
    warnings: tuple[str, ...]

    @classmethod
    def _of(cls, heard: _native.Heard) -> Tones:
        data: Json = json.loads(heard.tones_json())
        families = tuple(ToneFamily._of(family) for family in data["families"])
        return filled(cls, data, families=families, warnings=tuple(data["warnings"]), json=data, _heard=heard)

    def _kinds(self) -> Kinds:
        of_readings = [field.name for field in fields(Reading) if field.name != "gear"]
        return {"family": "int64", **kinds_of(ToneFamily, "is_rotor", "fundamental_hz"), **kinds_of(Reading, *of_readings)}

    def _columns(self) -> dict[str, Any]:
        rows = []
        for number, family in enumerate(self.families, 1):
            for reading in family.readings:
                of_family = {"family": number, "is_rotor": family.is_rotor, "fundamental_hz": family.fundamental_hz}
                rows.append(of_family | vars(reading))
        return column_wise(rows, self._kinds())

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the levels of the harmonics of all families by matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw.
        """
        ax = axes_of(ax)
        for number, family in enumerate(self.families, 1):
            of = [(line["hz"], line["level_db"]) for line in family.harmonics]
            label = f"family {number}, {family.fundamental_hz:.1f} Hz" + (", the rotor's" if family.is_rotor else "")
            ax.plot(*zip(*of, strict=True), "o", label=label)
            ax.vlines(*zip(*((hz, 0, level) for hz, level in of), strict=True), linewidth=0.5, color="gray")
        ax.set(xlabel="frequency, Hz", ylabel="level over the floor, dB", title=self.file)
        if self.families:
            ax.legend()
        return ax

    def _facts(self) -> Json:
        rows: Json = {"file": self.file, "status": self.status, "tone_hz": self.tone_hz, "speed_rev_s": self.speed_rev_s}
        for number, family in enumerate(self.families, 1):
            rows[f"family {number}"] = f"{family.fundamental_hz:.1f} Hz, {family.level_db:.0f} dB over the floor"
        return rows


def tones(
    recording: Recording | None = None,
    *,
    rate_hz: float | None = None,
    progress: Progress = None,
    **flags: Unpack[TonesFlags],
) -> Tones:
    """Tone families in a recording, and the shaft speed that each possible order would mean.

    Parameters
    ----------
    recording, rate_hz, progress
        As for :func:`speed`.
    **flags
        The flags of ``hovertone tones``: `vehicle`, `blades`, `diameter_m`, `mass_kg`, `rotors`, `from_`, `to`, `audio_track`, `channel`,
        `clock_correction_ppm`.

    Returns
    -------
    Tones
        The families, strongest first.

    Examples
    --------
    >>> family = tones("hover.wav").families[0]
    >>> f"{family.fundamental_hz:.1f} Hz"
    '61.3 Hz'
    """
    heard = to_hear(recording, rate_hz)
    with listening(progress) as listener:
        found = _native.heard(words("tones", heard.paths, flags | {"json": True}), heard.samples, heard.rate_hz, listener)
    return Tones._of(one(found, heard.paths))
