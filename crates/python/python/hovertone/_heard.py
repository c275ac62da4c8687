"""Results of a recording, which keep its sound for their figure."""

from __future__ import annotations

from dataclasses import dataclass, field

from . import _native
from ._rows import Json, Shown

__all__ = ["OfSound"]


@dataclass(frozen=True, eq=False, kw_only=True)
class OfSound(Shown):
    """A result of a recording."""

    json: Json = field(repr=False)
    _heard: _native.Heard | None = field(repr=False, default=None)

    def __getstate__(self) -> Json:
        # a result that goes to another process leaves the sound behind
        return self.__dict__ | {"_heard": None}

    def figure(self) -> str | None:
        """The spectrogram with bands and tracks as SVG, by another pass over the sound.

        Returns
        -------
        str or None
            ``None`` where the sound is shorter than a tenth of a second, or is not here: in another process, and where it was not heard.
        """
        return None if self._heard is None or self.json["status"] == "error" else self._heard.figure()
