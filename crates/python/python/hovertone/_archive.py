"""Rows of an archive: what ``hovertone batch`` writes for a recording into recordings.parquet."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from . import _native
from ._extras import extra
from ._words import Path, words

if TYPE_CHECKING:
    import pyarrow

#: The command needs a folder, and nothing is written there.
_NOWHERE = {"output": os.devnull}


def names(paths: Path | Sequence[Path], flags: Mapping[str, object]) -> list[str]:
    """The recordings of folders, patterns, files and lists, sorted; flags without a meaning are refused."""
    several = isinstance(paths, Sequence) and not isinstance(paths, str)
    return _native.archive_names(words("batch", paths if several else [paths], {**flags, **_NOWHERE}))  # type: ignore[list-item, arg-type]


def rows(files: Iterable[str], flags: Mapping[str, object]) -> pyarrow.Table:
    """A row for each recording, with the schema and the metadata of recordings.parquet."""
    arrow = extra("pyarrow", "arrow")
    streams = (_native.archive_row(words("batch", [file], {**flags, **_NOWHERE})) for file in files)
    return arrow.concat_tables([arrow.ipc.open_stream(stream).read_all() for stream in streams])
