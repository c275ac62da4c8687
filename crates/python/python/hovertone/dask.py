"""Archives on a cluster, by Dask."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from ._archive import names, rows
from ._extras import extra
from ._words import Path

if TYPE_CHECKING:
    import dask.dataframe
    import pandas
    from typing_extensions import Unpack

    from ._flags import BatchFlags

__all__ = ["speeds"]


def speeds(paths: Path | Iterable[Path], **flags: Unpack[BatchFlags]) -> dask.dataframe.DataFrame:
    """Rotor speeds of an archive: the rows that ``hovertone batch`` writes into recordings.parquet.

    Parameters
    ----------
    paths, **flags
        As for :func:`hovertone.ray.speeds`.

    Returns
    -------
    dask.dataframe.DataFrame
        One partition for each recording, in the sequence of batch.
    """
    heard: dict[str, Any] = dict(flags)
    files = names(paths, heard)
    # the row of a file that holds no sound has the types of all rows
    meta = _row(os.devnull, heard).iloc[:0]
    found: dask.dataframe.DataFrame = extra("dask.dataframe", "dask").from_map(_row, files, flags=heard, meta=meta)
    return found


def _row(file: str, flags: dict[str, Any]) -> pandas.DataFrame:
    return rows([file], flags).to_pandas()
