"""The flags of the commands as keywords. ``None`` leaves a flag out; units stand in the names."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, TypedDict

from ._words import Path

Method = Literal["separated", "harmonic", "maximum_trace", "gaussian"]
Time = float | str


class ToneFlags(TypedDict, total=False):
    """Which tone."""

    blades: int | None
    gear: tuple[int, int] | int | str | None
    order: float | None
    vehicle: str | None
    band: tuple[float, float] | str | None
    harmonics: int | None


class KnownFlags(TypedDict, total=False):
    """Known facts about the vehicle."""

    diameter_m: float | str | None
    mass_kg: float | str | None
    rotors: int | None


class AnalysisFlags(TypedDict, total=False):
    """How it is analysed."""

    mean_only: bool
    method: Method | None
    clock_ppm: float | None
    condition: bool
    radial_speed_m_s_max: float | None
    drift_m_max: float | str | None
    from_: Time | None
    to: Time | None
    window_s: float | None
    hop_share: float | None
    gaussian_threshold_share: float | None


class HearingFlags(TypedDict, total=False):
    """How files are read."""

    audio_track: int | None
    channel: int | None
    clock_correction_ppm: float | None


class LabelFlags(TypedDict, total=False):
    """Which rotor is which."""

    log: Path | None
    log_offset_s: tuple[float, float] | str | None
    log_axes: Literal["flu", "frd"] | None
    spin_up: Sequence[str] | str | None
    layout: Literal["x", "plus"] | None
    microphones: Path | None


class BatchFlags(ToneFlags, KnownFlags, AnalysisFlags, HearingFlags, total=False):
    """The flags of ``hovertone batch`` that say how a recording is heard."""


class SpeedFlags(BatchFlags, LabelFlags, total=False):
    """The flags of ``hovertone speed``."""


class TonesFlags(KnownFlags, HearingFlags, total=False):
    """The flags of ``hovertone tones``."""

    vehicle: str | None
    blades: int | None
    from_: Time | None
    to: Time | None


class PlaceFlags(TypedDict, total=False):
    """Where it was flown."""

    gravity_m_s2: float | None
    latitude_deg: float | None
    height_m: float | str | None


class AirFlags(TypedDict, total=False):
    """Air and propeller."""

    diameter_m: float | str | None
    temperature_c: float | None
    pressure_hpa: float | None
    humidity_percent: float | None


class IdentifyFlags(PlaceFlags, HearingFlags, total=False):
    """The flags of ``hovertone identify``."""

    vehicle: str | None
    blades: int | None
    gear: tuple[int, int] | int | str | None
    rotors: int | None
    diameter_m: float | str | None
    method: Method | None
    data_root: Path | None
    output: Path | None
    force: bool


class FitFlags(PlaceFlags, AirFlags, total=False):
    """The flags of ``hovertone fit`` for tables."""

    rotors: int | None


class PlanFlags(FitFlags, total=False):
    """The flags of ``hovertone fit --plan``."""

    wanted_share: float | None
    added_mass_kg: float | str | None
    mass_std_kg: float | str | None
    speed_spread_share: float | None
    correlation_s: float | None
    rotors_separated: bool


class WeighFlags(ToneFlags, PlaceFlags, HearingFlags, total=False):
    """The flags of ``hovertone weigh``."""

    group: str | None
    constant_n_s2: float | None
    constant_std_n_s2: float | None
    rotors: int | None
    mass_kg: float | str | None
    mass_std_kg: float | str | None


class ExportFlags(TypedDict, total=False):
    """The flags of ``hovertone export``."""

    into: Path | None
    group: str | None
    output: Path | None
    force: bool
    torque_constant_n_m_s2: float | None
    hover_command: float | None
    diameter_m: float | str | None
    air_density_kg_m3: float | None
