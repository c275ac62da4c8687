"""Archives on a cluster, by Ray Data.

A recording is heard by one task. Ray starts a task again whose worker was killed, so that no row is lost and none is there twice.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from ._archive import names, rows
from ._extras import extra
from ._words import Path

if TYPE_CHECKING:
    import ray.data
    from typing_extensions import Unpack

    from ._flags import BatchFlags

__all__ = ["speeds"]

#: Recordings of a task.
_BATCH = 4


def speeds(paths: Path | Iterable[Path], **flags: Unpack[BatchFlags]) -> ray.data.Dataset:
    """Rotor speeds of an archive: the rows that ``hovertone batch`` writes into recordings.parquet.

    Parameters
    ----------
    paths : path or iterable of paths
        Folders, patterns, recordings, or lists (.txt), that all machines of the cluster see under the same names; addresses such as
        ``s3://bucket/folder`` where the package was built with stores.
    **flags
        The flags of ``hovertone batch`` that say how a recording is heard, as for :func:`hovertone.speed`.

    Returns
    -------
    ray.data.Dataset
        One row for each recording, in any sequence; ``.sort("file")`` gives that of batch. A file that cannot be read is a row with its error.
    """
    heard: dict[str, Any] = dict(flags)
    files = names(paths, heard)
    blocks = -(-len(files) // _BATCH)
    data: ray.data.Dataset = extra("ray.data", "ray").from_items([{"file": file} for file in files], override_num_blocks=blocks)
    return data.map_batches(lambda batch: rows(batch["file"].to_pylist(), heard), batch_format="pyarrow", batch_size=_BATCH)
