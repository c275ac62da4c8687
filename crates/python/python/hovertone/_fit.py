"""The thrust constant of a table."""

from __future__ import annotations

import csv
import json
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, Union

from . import _native
from ._errors import HovertoneError
from ._estimate import Estimate
from ._extras import axes_of
from ._rows import Drawn, Json, Kinds, column_wise, filled, numbered
from ._words import Path, is_table, paths_of, refused, words

if TYPE_CHECKING:
    import pandas
    import pyarrow
    from matplotlib.axes import Axes
    from typing_extensions import Unpack

    from ._flags import FitFlags

__all__ = ["Fit", "fit", "fits"]

#: A CSV file, or columns of numbers with the headers of one: a mapping, or a table of pandas, Polars or Arrow.
Columns = Union[Path, Mapping[str, Sequence[Any]], "pandas.DataFrame", "pyarrow.Table"]
#: How messages name a table that is no file.
_TABLE = "the table"
_TABLES_HINT = "give names of CSV files, or one table: columns with their headers"
_POINT_KINDS: Kinds = {
    "name": "string", "deviation_share": "float64", "thrust_constant_of_others_n_s2": "float64", "p_value": "float64", "fits": "bool",
    "is_gross": "bool", "force_that_fits_n": "float64", "force_that_fits_std_n": "float64",
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Fit(Drawn):
    """The thrust constant of a table. As a table: one row for each point.

    Attributes
    ----------
    file : str
        The table; ``"the table"`` for one that is no file.
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

    def _kinds(self) -> Kinds:
        return _POINT_KINDS

    def _columns(self) -> dict[str, Any]:
        return column_wise(self.fit["points"], _POINT_KINDS)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the deviation of each point from F = C_f ω² by matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw.
        """
        ax = axes_of(ax)
        points = [point for point in self.fit["points"] if point["deviation_share"] is not None]
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
    table : path, mapping, or table of pandas, Polars or Arrow
        A CSV file, or columns with the headers of one: a speed (``"rpm"``, ``"speed_rad_s"``), and a thrust (``"thrust_n"``,
        ``"thrust_g"``) or a mass (``"mass_g"``); also standard uncertainties, power and torque. A cell with ``None`` is an empty cell, and NaN is refused.
        Messages count lines as in a CSV file: line 1 has the headers.
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
    raise refused(what, "give group=NAME, or call hovertone.fits()")


def fits(tables: Columns | Iterable[Path], **flags: Unpack[FitFlags]) -> list[Fit]:
    """Thrust constants of several tables, or of all groups of one.

    Parameters
    ----------
    tables : path, iterable of paths, mapping, or table of pandas, Polars or Arrow
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
    flags_of_fit = flags | {"json": True}
    if is_table(tables) or (hasattr(tables, "to_pandas") and not isinstance(tables, Iterable)):
        data = _of_columns(_columns_of(tables), flags_of_fit)
    else:
        data = json.loads(_native.printed(words("fit", paths_of(tables, _TABLES_HINT), flags_of_fit))[0])
    return [Fit._of(one) for one in data.get("groups", [data])]


def _columns_of(table: Any) -> dict[str, list[Any]]:
    """The columns of a table in memory, all of one length."""
    if not isinstance(table, Mapping):
        table = _mapping_of(table)
    columns: dict[str, list[Any]] = {}
    for name, cells in table.items():
        if isinstance(cells, str | bytes) or not isinstance(cells, Iterable) or getattr(cells, "shape", None) == ():
            raise refused(f"{_TABLE}: column \"{name}\" holds one value, and a column is a list", "give a value for each row")
        columns[str(name)] = list(cells)
    lengths = {len(cells) for cells in columns.values()}
    if len(lengths) > 1:
        rows = ", ".join(f"{name} has {len(cells)}" for name, cells in columns.items())
        raise refused(f"{_TABLE}: the columns have different numbers of rows: {rows}", "give a value for each row, and None where there is none")
    return columns


def _mapping_of(table: Any) -> Mapping[str, Any]:
    """The columns of a table of Arrow, pandas or Polars, and of others that become one of these."""
    if hasattr(table, "to_pydict"):
        columns: Mapping[str, Any] = table.to_pydict()
        return columns
    if hasattr(table, "to_pandas") and not hasattr(table, "get_column"):
        table = table.to_pandas()
    if hasattr(table, "columns") and hasattr(table, "__len__"):
        names = list(table.columns)
        if len(set(names)) == len(names):
            return {name: table[name] for name in names}
        raise refused(f"{_TABLE}: several columns have the same name: {', '.join(map(str, names))}", "give each column a name of its own")
    raise refused(f"{_TABLE} is of the type {type(table).__name__}, whose columns cannot be read",
                  "give a mapping of lists, or a table of pandas, Polars or Arrow")


def _of_columns(columns: Mapping[str, list[Any]], flags: Mapping[str, object]) -> Json:
    """The fit of columns. They are a file for the time of the call; what is told about it names the table."""
    with tempfile.TemporaryDirectory(prefix="hovertone-") as folder:
        path = FilePath(folder) / "table.csv"
        with path.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(columns)
            writer.writerows(zip(*columns.values(), strict=True))
        try:
            data: Json = json.loads(_native.printed(words("fit", [path], flags))[0])
        except HovertoneError as error:
            said = [part.replace(str(path), _TABLE) for part in (error.words, error.what, error.hint)]
            raise type(error)(*said) from None
    for one in data.get("groups", [data]):
        one["file"] = _TABLE
    return data
