"""Progress of a call: any callable, or a bar by tqdm."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from ._extras import extra

Listener = Callable[[float], object]
Progress = bool | Listener | None


@contextmanager
def listening(progress: Progress) -> Iterator[Listener | None]:
    """What a call tells its finished share, from 0 to 1: a callable as it is, and for ``True`` a bar by tqdm."""
    if progress is None or progress is False:
        yield None
    elif progress is True:
        with extra("tqdm.auto", "progress").tqdm(total=1.0, bar_format="{l_bar}{bar}| {elapsed}<{remaining}") as bar:
            yield lambda share: bar.update(share - bar.n)
    else:
        yield progress
