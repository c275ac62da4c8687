"""The thrust constant of a table."""

from __future__ import annotations

import csv
import json
import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, Union

from . import _native
from ._errors import WrongUseError
from ._estimate import Estimate
from ._extras import axes_of
from ._rows import Json, Shown, column_wise, filled, numbered
from ._words import Path, words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from typing_extensions import Unpack

    from ._flags import FitFlags

__all__ = ["Fit", "fit", "fits"]

#: A CSV file, or columns of numbers with the headers of one: a mapping, or a table of pandas.
Columns = Union[Path, Mapping[str, Sequence[Any]], "pandas.DataFrame"]  # type: ignore[name-defined]  # noqa: F821


@dataclass(frozen=True, eq=False)
class Fit(Shown):
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

    def _facts(self) -> Json:
        constant = self.thrust_constant_per_rotor_n_s2
        rows: Json = {"file": self.file, "group": self.group or None, "rows": self.row_count}
        rows |= {"C_f of one rotor, N s²": constant.value, "standard uncertainty, N s²": constant.std_uncertainty}
        return rows | numbered(self.notices)


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
