"""The thrust constant of an experiment."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from html import escape
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from . import _native
from ._estimate import Estimate, estimate
from ._extras import axes_of
from ._progress import Progress, listening
from ._rows import Json, Kinds, Shown, Table, csv_columns, csv_kinds, filled, numbered
from ._words import Path, words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from typing_extensions import Unpack

    from ._flags import IdentifyFlags

__all__ = ["Identification", "identify"]

Mass = Mapping[float | str, Path | Iterable[Path]]


@dataclass(frozen=True, eq=False)
class Identification(Shown):
    """The thrust constant of an experiment. As a table: one row for each load, as in loads.csv.

    Attributes
    ----------
    thrust_constant_total_n_s2, thrust_constant_per_rotor_n_s2 : Estimate or None
        C_f of the whole vehicle and of one rotor, in N s².
    expanded_uncertainty_total_n_s2, expanded_uncertainty_per_rotor_n_s2 : float or None
        Their expanded uncertainties, k = 2, in N s².
    method : str
        The method whose constant is reported.
    loads : list of dict
        The loads with their speeds.
    warnings : list of str
        Warnings about the constant.
    quote : str
        The lines to quote: the constants with their ±, the verdict, and how the rotors were heard.
    page : pathlib.Path or None
        The page of the report, where `output` names a folder.
    json : dict
        All of it: the content of results.json.
    """

    thrust_constant_total_n_s2: Estimate | None
    thrust_constant_per_rotor_n_s2: Estimate | None
    expanded_uncertainty_total_n_s2: float | None
    expanded_uncertainty_per_rotor_n_s2: float | None
    method: str
    loads: list[Json]
    warnings: list[str]
    quote: str
    page: FilePath | None
    json: Json = field(repr=False)
    _samples: str = field(repr=False)
    _loads: str = field(repr=False)
    _figures: tuple[tuple[str, str, str], ...] = field(repr=False)

    @classmethod
    def _of(cls, identified: _native.Identified) -> Identification:
        data: Json = json.loads(identified.json())
        samples, loads = identified.tables()
        page = identified.page()
        return filled(
            cls,
            data,
            thrust_constant_total_n_s2=estimate(data["thrust_constant_total_n_s2"]),
            thrust_constant_per_rotor_n_s2=estimate(data["thrust_constant_per_rotor_n_s2"]),
            quote=identified.quote(),
            page=None if page is None else FilePath(page),
            json=data,
            _samples=samples,
            _loads=loads,
            _figures=tuple(identified.figures()),
        )

    def _kinds(self) -> Kinds:
        return csv_kinds(self._loads, words=("method", "load"), whole=("rotors_running", "trial_count"))

    def _columns(self) -> dict[str, Any]:
        return csv_columns(self._loads, self._kinds())

    @property
    def samples(self) -> _Samples:
        """The samples of all trials, as in samples.csv: a table by ``.to_pandas()`` and ``.to_arrow()``."""
        return _Samples(self._samples)

    def figure(self, name: str = "fit") -> str | None:
        """A figure as SVG: ``"fit"`` or ``"budget"``; ``None`` where it has no data."""
        return next((svg for of, _, svg in self._figures if of.endswith(name)), None)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw force against ω² by matplotlib, with the law F = C_f ω².

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw.
        """
        ax = axes_of(ax)
        square = [load["speed_rad_s"] ** 2 for load in self.loads]
        ax.plot(square, [load["force_n"] for load in self.loads], "o", label="loads")
        if self.thrust_constant_total_n_s2 is not None and square:
            ends = [0.0, max(square)]
            ax.plot(ends, [self.thrust_constant_total_n_s2.value * end for end in ends], label="F = C_f ω²")
        ax.set(xlabel="ω², rad²/s²", ylabel="force, N")
        ax.ticklabel_format(axis="x", scilimits=(3, 3))
        ax.legend()
        return ax

    def _facts(self) -> Json:
        return numbered(self.warnings)

    def _repr_html_(self) -> str:
        return "".join(f"<p>{escape(line)}</p>" for line in self.quote.splitlines()) + super()._repr_html_()


@dataclass(frozen=True)
class _Samples(Table):
    """The samples of all trials."""

    _csv: str = field(repr=False)

    def _kinds(self) -> Kinds:
        return csv_kinds(self._csv, words=("load", "recording", "method"), whole=("trial", "sample", "frame_count"))

    def _columns(self) -> dict[str, Any]:
        return csv_columns(self._csv, self._kinds())


def identify(
    experiment: Path | None = None, *, mass: Mass | None = None, progress: Progress = None, **flags: Unpack[IdentifyFlags]
) -> Identification:
    """Thrust constant from recordings of hovers with known masses, or of bench runs.

    Parameters
    ----------
    experiment : path, optional
        The experiment file.
    mass : mapping, optional
        In place of an experiment file: masses as flown (kg, or such as ``"413g"``) and their recordings.
    progress : callable or bool, optional
        Told the finished share, from 0 to 1; ``True`` shows a bar by tqdm.
    **flags
        The flags of ``hovertone identify``: `method`, `data_root`, `output` (a folder for report and tables), `force`; with `mass` also
        `vehicle`, `blades`, `gear`, `rotors`, `diameter_m`, `gravity_m_s2`, `latitude_deg`, `height_m`; `audio_track`, `channel`,
        `clock_correction_ppm`.

    Returns
    -------
    Identification
        The constant, its uncertainty, the loads.

    Examples
    --------
    >>> f"{identify('experiment.toml').thrust_constant_total_n_s2.value:.3e} N s²"
    '2.831e-05 N s²'
    """
    paths = [] if experiment is None else [experiment]
    with listening(progress) as listener:
        all_words = words("identify", paths, flags | {"mass": mass, "json": True})
        return Identification._of(_native.identified(all_words, listener))
