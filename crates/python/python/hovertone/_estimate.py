"""A value with its standard uncertainty."""

from __future__ import annotations

from dataclasses import dataclass

from ._rows import Json, filled

__all__ = ["Estimate", "estimate"]


@dataclass(frozen=True)
class Estimate:
    """A value with its standard uncertainty.

    Attributes
    ----------
    value : float
        The value.
    std_uncertainty : float or None
        Its standard uncertainty (k = 1); ``None`` where it is not known.
    ending : str
        How the estimate ended, such as ``"solved"``.
    """

    value: float
    std_uncertainty: float | None
    ending: str


def estimate(data: Json | None) -> Estimate | None:
    """The estimate of its JSON, where there is one."""
    return None if data is None else filled(Estimate, data)
