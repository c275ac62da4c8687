"""The thrust constant: from experiments, tables and results."""

from __future__ import annotations

import csv
import io
import json
import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from html import escape
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, Literal, Union

from . import _native
from ._errors import NoRotorToneError, WrongUseError
from ._extras import axes_of
from ._progress import Progress, listening
from ._rows import Json, Table, column_wise, filled, html_table
from ._words import Path, words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from typing_extensions import Unpack

    from ._flags import ExportFlags, FitFlags, IdentifyFlags, PlanFlags, WeighFlags

__all__ = ["Estimate", "Fit", "FlightPlan", "Identification", "Weighed", "export", "fit", "fits", "identify", "plan", "weigh"]

Mass = Mapping[float | str, Path | Sequence[Path]]
#: A CSV file, or columns of numbers with the headers of one: a mapping, or a table of pandas.
Columns = Union[Path, Mapping[str, Sequence[Any]], "pandas.DataFrame"]  # type: ignore[name-defined]  # noqa: F821


@dataclass(frozen=True)
class Estimate:
    """A value with its standard uncertainty.

    Attributes
    ----------
    value : float
        The value.
    std_uncertainty : float or None
        Its standard uncertainty (k = 1); ``None`` where it is not known.
    ending : str
        How the estimate ended, such as ``"solved"``.
    """

    value: float
    std_uncertainty: float | None
    ending: str


def _estimate(data: Json | None) -> Estimate | None:
    return None if data is None else filled(Estimate, data)


@dataclass(frozen=True, eq=False)
class Identification(Table):
    """The thrust constant of an experiment. As a table: one row for each load, as in loads.csv.

    Attributes
    ----------
    thrust_constant_total_n_s2, thrust_constant_per_rotor_n_s2 : Estimate or None
        C_f of the whole vehicle and of one rotor, in N s².
    expanded_uncertainty_total_n_s2, expanded_uncertainty_per_rotor_n_s2 : float or None
        Their expanded uncertainties, k = 2, in N s².
    method : str
        The method whose constant is reported.
    loads : list of dict
        The loads with their speeds.
    warnings : list of str
        Warnings about the constant.
    quote : str
        The lines to quote: the constants with their ±, and the verdict.
    page : pathlib.Path or None
        The page of the report, where `output` names a folder.
    json : dict
        All of it: the content of results.json.
    """

    thrust_constant_total_n_s2: Estimate | None
    thrust_constant_per_rotor_n_s2: Estimate | None
    expanded_uncertainty_total_n_s2: float | None
    expanded_uncertainty_per_rotor_n_s2: float | None
    method: str
    loads: list[Json]
    warnings: list[str]
    quote: str
    page: FilePath | None
    json: Json = field(repr=False)
    _samples: str = field(repr=False)
    _loads: str = field(repr=False)
    _figures: tuple[tuple[str, str, str], ...] = field(repr=False)

    @classmethod
    def _of(cls, identified: _native.Identified) -> Identification:
        data: Json = json.loads(identified.json())
        samples, loads = identified.tables()
        page = identified.page()
        return filled(
            cls,
            data,
            thrust_constant_total_n_s2=_estimate(data["thrust_constant_total_n_s2"]),
            thrust_constant_per_rotor_n_s2=_estimate(data["thrust_constant_per_rotor_n_s2"]),
            quote=identified.quote(),
            page=None if page is None else FilePath(page),
            json=data,
            _samples=samples,
            _loads=loads,
            _figures=tuple(identified.figures()),
        )

    def _columns(self) -> dict[str, Any]:
        return _csv_columns(self._loads)

    @property
    def samples(self) -> _Samples:
        """The samples of all trials, as in samples.csv: a table by ``.to_pandas()`` and ``.to_arrow()``."""
        return _Samples(self._samples)

    def figure(self, name: str = "fit") -> str | None:
        """A figure as SVG: ``"fit"`` or ``"budget"``; ``None`` where it has no data."""
        return next((svg for of, _, svg in self._figures if of.endswith(name)), None)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw force against ω² by matplotlib, with the law F = C_f ω².

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw.
        """
        ax = axes_of(ax)
        square = [load["speed_rad_s"] ** 2 for load in self.loads]
        ax.plot(square, [load["force_n"] for load in self.loads], "o", label="loads")
        if self.thrust_constant_total_n_s2 is not None and square:
            ends = [0.0, max(square)]
            ax.plot(ends, [self.thrust_constant_total_n_s2.value * end for end in ends], label="F = C_f ω²")
        ax.set(xlabel="ω², rad²/s²", ylabel="force, N")
        ax.ticklabel_format(axis="x", scilimits=(3, 3))
        ax.legend()
        return ax

    def _repr_html_(self) -> str:
        quoted = "".join(f"<p>{escape(line)}</p>" for line in self.quote.splitlines())
        warnings = {f"warning {number}": line for number, line in enumerate(self.warnings, 1)}
        return quoted + html_table(warnings) + (self.figure() or "")


@dataclass(frozen=True)
class _Samples(Table):
    """The samples of all trials."""

    _csv: str = field(repr=False)

    def _columns(self) -> dict[str, Any]:
        return _csv_columns(self._csv)


def identify(
    experiment: Path | None = None, *, mass: Mass | None = None, progress: Progress = None, **flags: Unpack[IdentifyFlags]
) -> Identification:
    """Thrust constant from recordings of hovers with known masses, or of bench runs.

    Parameters
    ----------
    experiment : path, optional
        The experiment file.
    mass : mapping, optional
        In place of an experiment file: masses as flown (kg, or such as ``"413g"``) and their recordings.
    progress : callable or bool, optional
        Told the finished share, from 0 to 1; ``True`` shows a bar by tqdm.
    **flags
        The flags of ``hovertone identify``: `method`, `data_root`, `output` (a folder for report and tables), `force`; with `mass` also
        `vehicle`, `blades`, `gear`, `rotors`, `diameter_m`, `gravity_m_s2`, `latitude_deg`, `height_m`; `audio_track`, `channel`,
        `clock_correction_ppm`.

    Returns
    -------
    Identification
        The constant, its uncertainty, the loads.

    Examples
    --------
    >>> f"{identify('experiment.toml').thrust_constant_total_n_s2.value:.3e} N s²"
    '2.831e-05 N s²'
    """
    paths = [] if experiment is None else [experiment]
    with listening(progress) as listener:
        all_words = words("identify", paths, flags | {"mass": mass, "json": True})
        return Identification._of(_native.identified(all_words, listener))


@dataclass(frozen=True, eq=False)
class Fit(Table):
    """The thrust constant of a table. As a table: one row for each point.

    Attributes
    ----------
    file : str
        The table.
    group : str
        Its group; empty without groups.
    thrust_constant_total_n_s2, thrust_constant_per_rotor_n_s2 : Estimate
        C_f of all rotors and of one, in N s².
    rotor_count, row_count : int
        Numbers of rotors and of rows.
    fit : dict
        The laws beside F = C_f ω², and how each point fits.
    thrust_coefficients : dict or None
        C_T in both conventions, where diameter and air are known.
    figure_of_merit, torque_constant_per_rotor_n_m_s2 : float, dict or None
        Where the table has power and torque.
    notices : list of str
        Warnings.
    json : dict
        All of it, as ``hovertone fit --json`` prints it.
    """

    file: str
    group: str
    thrust_constant_total_n_s2: Estimate
    thrust_constant_per_rotor_n_s2: Estimate
    rotor_count: int
    row_count: int
    fit: Json = field(repr=False)
    thrust_coefficients: Json | None
    figure_of_merit: float | None
    torque_constant_per_rotor_n_m_s2: Any
    notices: list[str]
    json: Json = field(repr=False)

    @classmethod
    def _of(cls, data: Json) -> Fit:
        total, per_rotor = data["thrust_constant_total_n_s2"], data["thrust_constant_per_rotor_n_s2"]
        return filled(
            cls,
            data,
            thrust_constant_total_n_s2=filled(Estimate, total),
            thrust_constant_per_rotor_n_s2=filled(Estimate, per_rotor),
            json=data,
        )

    def _columns(self) -> dict[str, Any]:
        return column_wise(self.fit["points"])

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the deviation of each point from F = C_f ω² by matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw.
        """
        ax = axes_of(ax)
        points = self.fit["points"]
        ax.stem([point["name"] for point in points], [100 * point["deviation_share"] for point in points])
        ax.set(ylabel="deviation of the force from C_f ω², %", title=f"{self.file} {self.group}".strip())
        return ax

    def _repr_html_(self) -> str:
        constant = self.thrust_constant_per_rotor_n_s2
        rows: Json = {"file": self.file, "group": self.group or None, "rows": self.row_count}
        rows |= {"C_f of one rotor, N s²": constant.value, "standard uncertainty, N s²": constant.std_uncertainty}
        rows |= {f"warning {number}": line for number, line in enumerate(self.notices, 1)}
        return html_table(rows)


def fit(table: Columns | None = None, *, group: str | None = None, **flags: Unpack[FitFlags]) -> Fit:
    """Thrust constant from a table of speed and thrust, or of speed and mass that hovers.

    Parameters
    ----------
    table : path, mapping or pandas.DataFrame
        A CSV file, or columns with the headers of one: a speed (``"rpm"``, ``"speed_rad_s"``), and a thrust (``"thrust_n"``,
        ``"thrust_g"``) or a mass (``"mass_g"``); also standard uncertainties, power and torque.
    group : str, optional
        The group to use, where columns of words make several.
    **flags
        The flags of ``hovertone fit``: `rotors`; `gravity_m_s2`, `latitude_deg`, `height_m`; `diameter_m`, `temperature_c`,
        `pressure_hpa`, `humidity_percent`.

    Returns
    -------
    Fit
        The constant with its uncertainty, and how each row fits.

    Examples
    --------
    >>> found = fit({"rpm": [3000, 4000, 5000, 6000], "thrust_g": [70, 125, 194, 281]})
    >>> f"{found.thrust_constant_per_rotor_n_s2.value:.2e} N s²"
    '6.97e-06 N s²'
    """
    found = fits([] if table is None else table, **flags)
    chosen = [one for one in found if group is None or one.group == group]
    if len(chosen) == 1:
        return chosen[0]
    what = f"the table has {len(found)} groups: " + ", ".join(one.group for one in found)
    hint = "give group=NAME, or call hovertone.fits()"
    raise WrongUseError(f"{what} (hint: {hint})", what, hint)


def fits(tables: Columns | Sequence[Path], **flags: Unpack[FitFlags]) -> list[Fit]:
    """Thrust constants of several tables, or of all groups of one.

    Parameters
    ----------
    tables : path, sequence of paths, mapping or pandas.DataFrame
        As for :func:`fit`.
    **flags
        As for :func:`fit`.

    Returns
    -------
    list of Fit
        One for each group of each table.

    Examples
    --------
    >>> [one.group for one in fits({"motor": ["a"] * 3 + ["b"] * 3, "rpm": [3e3, 4e3, 5e3] * 2, "thrust_g": [70, 125, 194, 80, 142, 223]})]
    ['a', 'b']
    """
    with _as_files(tables) as paths:
        data = json.loads(_native.printed(words("fit", paths, flags | {"json": True}))[0])
    return [Fit._of(one) for one in data.get("groups", [data])]


@dataclass(frozen=True)
class FlightPlan:
    """A campaign that reaches a wanted uncertainty.

    Attributes
    ----------
    load_count, trials_per_load : int
        Numbers of loads, and of trials of each.
    trial_s, hover_s : float
        Seconds of hover in each trial, and in all.
    expanded_share : float
        Expected expanded uncertainty (k = 2) of the constant, as a share.
    largest : str
        The largest contribution to it.
    force_ratio_for_intercept : float or None
        Ratio of the largest to the smallest weight that would show an intercept.
    """

    load_count: int
    trials_per_load: int
    trial_s: float
    hover_s: float
    expanded_share: float
    largest: str
    force_ratio_for_intercept: float | None


def plan(mass_kg: float | str | None = None, **flags: Unpack[PlanFlags]) -> FlightPlan:
    """How many loads and trials, and how many seconds of hover, a wanted uncertainty needs.

    Parameters
    ----------
    mass_kg : float or str
        Mass of the vehicle, ready to fly, in kg or such as ``"413g"``.
    **flags
        The flags of ``hovertone fit --plan``: `wanted_share`, `added_mass_kg`, `mass_std_kg`, `speed_spread_share`, `correlation_s` (s),
        `rotors_separated`, and those of :func:`fit`.

    Returns
    -------
    FlightPlan
        The plan.

    Examples
    --------
    >>> plan(0.413).load_count
    3
    """
    data = json.loads(_native.printed(words("fit", [], flags | {"plan": True, "mass_kg": mass_kg, "json": True}))[0])
    return filled(FlightPlan, data)


@dataclass(frozen=True)
class Weighed(Table):
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
    """

    mass_kg: Estimate
    payload_kg: Estimate | None
    speed_rad_s: float
    recording_count: int

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

    def _repr_html_(self) -> str:
        return html_table({name: values[0] for name, values in self._columns().items()})


Results = Union[Path, Identification, Fit]


def weigh(
    recordings: Path | Sequence[Path] = (), *, constant: Results | None = None, progress: Progress = None, **flags: Unpack[WeighFlags]
) -> Weighed:
    """Mass of an unknown payload, from the sound of a hover and a known thrust constant.

    Parameters
    ----------
    recordings : path or sequence of paths
        Hovers with the same payload.
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
    NoRotorToneError
        No recording has a rotor tone.

    Examples
    --------
    >>> weighed = weigh("hover.wav", constant_n_s2=2.831e-5, blades=2, rotors=1, mass_kg=0.4)
    >>> f"{weighed.mass_kg.value:.3f} kg"
    '0.428 kg'
    """
    paths = [recordings] if isinstance(recordings, str | os.PathLike) else list(recordings)
    with _as_file(constant) as results, listening(progress) as listener:
        data, messages, _ = _native.printed(words("weigh", paths, flags | {"constant": results, "json": True}), listener)
    if not data:
        raise NoRotorToneError(messages.strip())
    weighed = json.loads(data)
    return filled(Weighed, weighed, mass_kg=filled(Estimate, weighed["mass_kg"]), payload_kg=_estimate(weighed["payload_kg"]))


Simulator = Literal["gazebo", "px4", "rotors", "gym-pybullet-drones", "rotorpy", "flightmare", "airsim", "crazyflow", "crazyflie", "json"]


def export(results: Results, to: Simulator | None = None, **flags: Unpack[ExportFlags]) -> str:
    """The constant as lines for a simulator: as a new model, or in your own.

    Parameters
    ----------
    results : path, Identification or Fit
        The constant: an identification or a fit, or the file of one.
    to : str
        The simulator.
    **flags
        The flags of ``hovertone export``: `into` (change the constant in this model), `output`, `force`, `group`,
        `torque_constant_n_m_s2` (N m s²), `hover_command` (0 to 1), `diameter_m` (m), `air_density_kg_m3` (kg/m³).

    Returns
    -------
    str
        The lines; with `into`, the difference; with `output` alone, nothing.

    Examples
    --------
    >>> found = fit({"rpm": [3000, 4000, 5000, 6000], "thrust_g": [70, 125, 194, 281]})
    >>> print(next(line for line in export(found, "gazebo").splitlines() if "<motorConstant>" in line).strip())
    <motorConstant>6.9687271e-6</motorConstant>...
    """
    with _as_file(results) as path:
        paths = [] if path is None else [path]
        return _native.printed(words("export", paths, flags | {"to": to}))[0]


@contextmanager
def _as_file(results: Results | None) -> Iterator[Path | None]:
    """The file of results; those in memory are written into one for the time of a call."""
    if not isinstance(results, Identification | Fit):
        yield results
        return
    with tempfile.TemporaryDirectory(prefix="hovertone-") as folder:
        path = FilePath(folder) / "results.json"
        path.write_text(json.dumps(results.json), encoding="utf-8")
        yield path


@contextmanager
def _as_files(tables: Columns | Sequence[Path]) -> Iterator[list[Path]]:
    """The files of tables; columns in memory are written into one for the time of a call."""
    if isinstance(tables, str | os.PathLike):
        yield [tables]
        return
    if isinstance(tables, Sequence):
        yield list(tables)
        return
    columns = {str(name): list(tables[name]) for name in tables}
    with tempfile.TemporaryDirectory(prefix="hovertone-") as folder:
        path = FilePath(folder) / "table.csv"
        with path.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(columns)
            writer.writerows(zip(*columns.values(), strict=True))
        yield [path]


def _csv_columns(text: str) -> dict[str, list[Any]]:
    rows = list(csv.reader(io.StringIO(text)))
    return {name: _numbers([row[index] for row in rows[1:]]) for index, name in enumerate(rows[0])}


def _numbers(cells: list[str]) -> list[Any]:
    for read in (int, float):
        try:
            return [None if cell == "" else read(cell) for cell in cells]
        except ValueError:
            pass
    return list(cells)
