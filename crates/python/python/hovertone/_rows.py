"""Results as dataclasses that are filled from the JSON of the command line, and as tables of other packages."""

from __future__ import annotations

import csv
import dataclasses
import io
from collections.abc import Container, Iterable, Mapping
from html import escape
from typing import TYPE_CHECKING, Any, Literal, TypeVar

from ._extras import extra

if TYPE_CHECKING:
    import pandas
    import pyarrow
    from matplotlib.axes import Axes

T = TypeVar("T")
Json = dict[str, Any]
#: The type of a column: its name in Arrow.
Kind = Literal["string", "float64", "int64", "bool"]
Kinds = Mapping[str, Kind]
#: The kinds of the fields of results, by their annotations.
_KINDS: Mapping[str, Kind] = {"str": "string", "Status": "string", "float": "float64", "int": "int64", "bool": "bool"}


def filled(cls: type[T], data: Mapping[str, Any], **more: Any) -> T:
    """The dataclass with the entries of its names; what is not there is ``None``."""
    names = [field.name for field in dataclasses.fields(cls) if field.init]  # type: ignore[arg-type]
    return cls(**{name: data.get(name) for name in names} | more)


def kinds_of(cls: type, *names: str) -> dict[str, Kind]:
    """The kinds of the fields of a dataclass with these names, from their annotations."""
    annotations = {field.name: str(field.type).removesuffix(" | None") for field in dataclasses.fields(cls)}
    return {name: _KINDS[annotations[name]] for name in names}


class Table:
    """A result that is also a table."""

    def _columns(self) -> dict[str, Any]:
        raise NotImplementedError

    def _kinds(self) -> Kinds:
        """The types of the columns, so that they depend on no value; arrays of NumPy have theirs."""
        return {}

    def to_pandas(self) -> pandas.DataFrame:
        """The result as a table of pandas; units stand in the names of the columns."""
        pandas, kinds = extra("pandas", "pandas"), self._kinds()
        columns = self._columns()
        of_numbers = {name: pandas.Series(values, dtype="float64") for name, values in columns.items() if kinds.get(name) == "float64"}
        return pandas.DataFrame(columns | of_numbers)

    def to_arrow(self) -> pyarrow.Table:
        """The result as a table of Arrow; units stand in the names of the columns. Equal results have equal types, whatever is missing."""
        arrow, kinds = extra("pyarrow", "arrow"), self._kinds()
        typed = {name: arrow.array(values, kinds.get(name)) for name, values in self._columns().items()}
        return arrow.table(typed)


class Shown(Table):
    """A result that a notebook shows as two columns of facts, with its figure below."""

    def _facts(self) -> Mapping[str, object]:
        raise NotImplementedError

    def figure(self) -> str | None:
        """A figure as SVG; ``None`` where there is none."""
        return None

    def _repr_html_(self) -> str:
        return html_table(self._facts()) + (self.figure() or "")


class Drawn(Shown):
    """A result whose figure is its plot by matplotlib."""

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw by matplotlib."""
        raise NotImplementedError

    def figure(self) -> str | None:
        """The plot as SVG; ``None`` where matplotlib is not installed."""
        try:
            drawn = extra("matplotlib.figure", "plot").Figure(figsize=(6.4, 3.2), layout="constrained")
        except ImportError:
            return None
        self.plot(drawn.subplots())
        written = io.StringIO()
        drawn.savefig(written, format="svg")
        text = written.getvalue()
        return text[text.index("<svg"):]  # without the head of a file of its own


def numbered(warnings: Iterable[str]) -> Json:
    """Warnings as facts."""
    return {f"warning {number}": words for number, words in enumerate(warnings, 1)}


def column_wise(rows: list[Json], names: Iterable[str]) -> dict[str, list[Any]]:
    """Columns of rows that have these names; they are there without a row too."""
    return {name: [row[name] for row in rows] for name in names}


def html_table(rows: Mapping[str, object]) -> str:
    """Two columns for a notebook: names and values."""
    cells = "".join(f"<tr><th style='text-align:left'>{escape(name)}</th><td style='text-align:left'>{escape(_shown(value))}</td></tr>"
                    for name, value in rows.items() if value is not None)
    return f"<table>{cells}</table>"


def _shown(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def csv_columns(text: str, kinds: Kinds) -> dict[str, list[Any]]:
    """Columns of a CSV, with numbers as numbers."""
    rows = list(csv.reader(io.StringIO(text)))
    return {name: [_read(row[index], kinds[name]) for row in rows[1:]] for index, name in enumerate(rows[0])}


def csv_kinds(text: str, *, words: Container[str], whole: Container[str]) -> dict[str, Kind]:
    """The kinds of the columns of a CSV: columns of words, of whole numbers, and all others of numbers."""
    names = next(csv.reader(io.StringIO(text)))
    return {name: "string" if name in words else "int64" if name in whole else "float64" for name in names}


def _read(cell: str, kind: Kind) -> Any:
    if kind == "string":
        return cell
    if cell == "":
        return None
    return int(cell) if kind == "int64" else float(cell)
