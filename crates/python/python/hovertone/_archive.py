"""Rows of an archive: what ``hovertone batch`` writes for a recording into recordings.parquet."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from . import _native
from ._errors import WrongUseError
from ._extras import extra
from ._words import Path, paths_of, refused, words

if TYPE_CHECKING:
    import pyarrow

#: The command needs a folder, and nothing is written there.
_NOWHERE = {"output": os.devnull}
#: The words of a build without object stores, and how the package is built with them.
_WITHOUT_STORES = "built without stores"
_WITH_STORES = (
    "install the package with them: pip install ./crates/python --config-settings build-args='--features stores'; or copy the recordings to a disk"
)


def names(paths: Path | Iterable[Path], flags: Mapping[str, object]) -> list[str]:
    """The recordings of folders, patterns, files and lists, sorted; flags without a meaning are refused."""
    all_words = words("batch", paths_of(paths), {**flags, **_NOWHERE})
    try:
        return _native.archive_names(all_words)
    except WrongUseError as error:
        if _WITHOUT_STORES in error.what:
            raise refused(error.what, _WITH_STORES) from None
        raise


def rows(files: Iterable[str], flags: Mapping[str, object]) -> pyarrow.Table:
    """A row for each recording, with the schema and the metadata of recordings.parquet."""
    arrow = extra("pyarrow", "arrow")
    streams = (_native.archive_row(words("batch", [file], {**flags, **_NOWHERE})) for file in files)
    return arrow.concat_tables([arrow.ipc.open_stream(stream).read_all() for stream in streams])
