"""The constant for simulators, and results as files."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Literal, Union

from . import _native
from ._fit import Fit
from ._identify import Identification
from ._words import Path, words

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._flags import ExportFlags

__all__ = ["Results", "as_file", "export"]

Results = Union[Path, Identification, Fit]
Simulator = Literal["gazebo", "px4", "rotors", "gym-pybullet-drones", "rotorpy", "flightmare", "airsim", "crazyflow", "crazyflie", "json"]


def export(results: Results, to: Simulator | None = None, **flags: Unpack[ExportFlags]) -> str:
    """The constant as lines for a simulator: as a new model, or in your own.

    Parameters
    ----------
    results : path, Identification or Fit
        The constant: an identification or a fit, or the file of one.
    to : str
        The simulator.
    **flags
        The flags of ``hovertone export``: `into` (change the constant in this model), `output`, `force`, `group`,
        `torque_constant_n_m_s2` (N m s²), `hover_command` (0 to 1), `diameter_m` (m), `air_density_kg_m3` (kg/m³).

    Returns
    -------
    str
        The lines; with `into`, the difference; with `output` alone, nothing.

    Examples
    --------
    >>> from hovertone import fit
    >>> found = fit({"rpm": [3000, 4000, 5000, 6000], "thrust_g": [70, 125, 194, 281]})
    >>> print(next(line for line in export(found, "gazebo").splitlines() if "<motorConstant>" in line).strip())
    <motorConstant>6.9652450e-6</motorConstant>...
    """
    with as_file(results) as path:
        paths = [] if path is None else [path]
        return _native.printed(words("export", paths, flags | {"to": to}))[0]


@contextmanager
def as_file(results: Results | None) -> Iterator[Path | None]:
    """The file of results; those in memory are written into one for the time of a call."""
    if not isinstance(results, Identification | Fit):
        yield results
        return
    with tempfile.TemporaryDirectory(prefix="hovertone-") as folder:
        path = FilePath(folder) / "results.json"
        path.write_text(json.dumps(results.json), encoding="utf-8")
        yield path
