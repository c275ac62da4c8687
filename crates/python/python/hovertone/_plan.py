"""A campaign for a wanted uncertainty."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from . import _native
from ._rows import Json, Kinds, Shown, filled, kinds_of
from ._words import words

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._flags import PlanFlags

__all__ = ["FlightPlan", "plan"]


@dataclass(frozen=True)
class FlightPlan(Shown):
    """A campaign that reaches a wanted uncertainty. As a table: one row.

    Attributes
    ----------
    load_count, trials_per_load : int
        Numbers of loads, and of trials of each.
    trial_s, hover_s : float
        Seconds of hover in each trial, and in all.
    expanded_share : float
        Expected expanded uncertainty (k = 2) of the constant, as a share.
    largest : str
        The largest contribution to it.
    force_ratio_for_intercept : float or None
        Ratio of the largest to the smallest weight that would show an intercept.
    """

    load_count: int
    trials_per_load: int
    trial_s: float
    hover_s: float
    expanded_share: float
    largest: str
    force_ratio_for_intercept: float | None

    def _kinds(self) -> Kinds:
        return kinds_of(FlightPlan, *vars(self))

    def _columns(self) -> dict[str, Any]:
        return {name: [value] for name, value in vars(self).items()}

    def _facts(self) -> Json:
        return vars(self)


def plan(mass_kg: float | str | None = None, **flags: Unpack[PlanFlags]) -> FlightPlan:
    """How many loads and trials, and how many seconds of hover, a wanted uncertainty needs.

    Parameters
    ----------
    mass_kg : float or str
        Mass of the vehicle, ready to fly, in kg or such as ``"413g"``.
    **flags
        The flags of ``hovertone fit --plan``: `wanted_share`, `added_mass_kg`, `mass_std_kg`, `speed_spread_share`, `correlation_s` (s),
        `rotors_separated`, and those of :func:`fit`.

    Returns
    -------
    FlightPlan
        The plan.

    Examples
    --------
    >>> plan(0.413).load_count
    3
    """
    data = json.loads(_native.printed(words("fit", [], flags | {"plan": True, "mass_kg": mass_kg, "json": True}))[0])
    return filled(FlightPlan, data)
