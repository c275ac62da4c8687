"""Results as dataclasses that are filled from the JSON of the command line, and as tables of other packages."""

from __future__ import annotations

import csv
import dataclasses
import io
from collections.abc import Iterable, Mapping
from html import escape
from typing import TYPE_CHECKING, Any, TypeVar

from ._extras import extra

if TYPE_CHECKING:
    import pandas
    import pyarrow

T = TypeVar("T")
Json = dict[str, Any]


def filled(cls: type[T], data: Mapping[str, Any], **more: Any) -> T:
    """The dataclass with the entries of its names; what is not there is ``None``."""
    names = [field.name for field in dataclasses.fields(cls) if field.init]  # type: ignore[arg-type]
    return cls(**{name: data.get(name) for name in names} | more)


class Table:
    """A result that is also a table."""

    def _columns(self) -> dict[str, Any]:
        raise NotImplementedError

    def to_pandas(self) -> pandas.DataFrame:
        """The result as a table of pandas; units stand in the names of the columns."""
        return extra("pandas", "pandas").DataFrame(self._columns())

    def to_arrow(self) -> pyarrow.Table:
        """The result as a table of Arrow; units stand in the names of the columns."""
        return extra("pyarrow", "arrow").table(self._columns())


class Shown(Table):
    """A result that a notebook shows as two columns of facts, with its figure below."""

    def _facts(self) -> Mapping[str, object]:
        raise NotImplementedError

    def figure(self) -> str | None:
        """A figure as SVG; ``None`` where there is none."""
        return None

    def _repr_html_(self) -> str:
        return html_table(self._facts()) + (self.figure() or "")


def numbered(warnings: Iterable[str]) -> Json:
    """Warnings as facts."""
    return {f"warning {number}": words for number, words in enumerate(warnings, 1)}


def column_wise(rows: list[Json]) -> dict[str, list[Any]]:
    """Columns of rows that have the same names."""
    return {name: [row[name] for row in rows] for name in (rows[0] if rows else {})}


def html_table(rows: Mapping[str, object]) -> str:
    """Two columns for a notebook: names and values."""
    cells = "".join(f"<tr><th style='text-align:left'>{escape(name)}</th><td style='text-align:left'>{escape(_shown(value))}</td></tr>"
                    for name, value in rows.items() if value is not None)
    return f"<table>{cells}</table>"


def _shown(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def csv_columns(text: str) -> dict[str, list[Any]]:
    """Columns of a CSV, with numbers as numbers."""
    rows = list(csv.reader(io.StringIO(text)))
    return {name: _numbers([row[index] for row in rows[1:]]) for index, name in enumerate(rows[0])}


def _numbers(cells: list[str]) -> list[Any]:
    for read in (int, float):
        try:
            return [None if cell == "" else read(cell) for cell in cells]
        except ValueError:
            pass
    return list(cells)
