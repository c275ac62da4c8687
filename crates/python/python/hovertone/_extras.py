"""Packages that only some results need."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def extra(module: str, name: str) -> Any:
    """The module, or an error that says how to install it."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise ImportError(f"this needs {module.partition('.')[0]}: pip install 'hovertone[{name}]'") from error


def axes_of(ax: Axes | None) -> Axes:
    """Where to draw: as told, or the current axes of matplotlib."""
    current: Axes = extra("matplotlib.pyplot", "plot").gca() if ax is None else ax
    return current
