"""Adaptation of problems in time: one mesh for a window of instants."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .adapt import AdaptOptions, Floats, metric_field_names
from .demand import check_targets
from .errors import MeshingError
from .fields import Field, as_fields
from .mesh import Mesh
from .metric import check_metric, from_fields
from .metric.scaling import Scale, scale_of
from .options import require
from .projection import Project
from .quality import UNIT, metric_lengths
from .remesh import remesh
from .report import attributes
from .topology import unique_edges
from .transfer import TransferOptions, transfer

Fields = dict[str, Any]
Advance = Callable[[Mesh, Fields, float, float], Mapping[str, Field | ArrayLike]]
"""``advance(mesh, fields, begin, end)`` returns the fields at `end` from those at `begin`."""

Initial = Mapping[str, Field | ArrayLike] | Callable[[Mesh], Mapping[str, Field | ArrayLike]]


# Hundreds of transfers add up: none may lose mass or make new extrema.
_BOUNDED = TransferOptions(method="bounded", outside="nearest")


@dataclass(frozen=True, slots=True, kw_only=True)
class UnsteadyOptions:
    """How a problem in time is adapted.

    Parameters
    ----------
    adapt : AdaptOptions
        Of every stage; the target is that of one mesh, which serves all instants of a window.
        The transfer is ``bounded``, and ``nearest`` outside, unless other options are given for it.
    window : int
        Steps from one adaptation to the next.
    passes : int
        How often a window is solved again on a mesh made for it.
    unit_edges : float
        The mesh is kept as long as this share of its edges is unit, see `needs_adaptation`.
    longest_edge : float
        And as long as no edge is longer, in the metric.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    adapt: AdaptOptions = field(default_factory=AdaptOptions)
    window: int = 8
    passes: int = 1
    unit_edges: float = 0.8
    longest_edge: float = 3.0

    def __post_init__(self) -> None:
        require(AdaptOptions, adapt=self.adapt)
        if self.adapt.transfer == AdaptOptions().transfer:
            object.__setattr__(self, "adapt", replace(self.adapt, transfer=_BOUNDED))
        for name in ("window", "passes"):
            if getattr(self, name) < 1:
                raise ValueError(f"{name} must be at least 1, got {getattr(self, name)}")
        if not 0 <= self.unit_edges <= 1:
            raise ValueError(f"unit_edges must be in [0, 1], got {self.unit_edges}")
        if not self.longest_edge > UNIT[1]:
            raise ValueError(f"longest_edge must be above sqrt(2), got {self.longest_edge}")


@dataclass(frozen=True, eq=False)
class Instant:
    """The solution at one time."""

    time: float
    mesh: Mesh
    fields: Fields


@dataclass(frozen=True, slots=True)
class Window:
    """What was done for one window of instants.

    Attributes
    ----------
    begin, end : float
        Times.
    points, cells : int
        Size of the mesh that served it.
    adaptations : int
        Meshes made for it; 0 when the one before was kept.
    transfer : dict or None
        Report of the transfer of the first instant to the mesh.
    """

    begin: float
    end: float
    points: int
    cells: int
    adaptations: int
    transfer: dict[str, Any] | None

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only; the keys are those of the attributes."""
        return attributes(self)


@dataclass(frozen=True, eq=False)
class Unsteady:
    """The solution at the end, and what was done for every window."""

    last: Instant
    windows: tuple[Window, ...]

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only: the end `time` and the `windows`."""
        return {"time": self.last.time, "windows": [window.as_dict() for window in self.windows]}


def needs_adaptation(
    mesh: Mesh, M: Floats, *, unit_edges: float = 0.8, longest_edge: float = 3.0
) -> bool:
    """Return whether a mesh has moved too far from a metric to be kept.

    A new mesh has more than 95 % unit edges and none longer than 2. The thresholds are lower, so
    that a mesh is kept while the solution changes little, and a new one is not made anew at once.

    Parameters
    ----------
    mesh : Mesh
    M : (n, d, d) float64
        Metric at its points.
    unit_edges : float
        Smallest share of edges with a length in [1/sqrt(2), sqrt(2)].
    longest_edge : float
        Largest length in the metric.

    Raises
    ------
    MetricError
        If a tensor is not symmetric positive definite; the point is named.
    """
    M = check_metric(M, n_points=mesh.n_points, dim=mesh.dim)
    lengths = metric_lengths(mesh, M, unique_edges(mesh.cells, mesh.n_points))
    is_unit = (lengths >= UNIT[0]) & (lengths <= UNIT[1])
    return bool(is_unit.mean() < unit_edges or lengths.max() > longest_edge)


def unsteady_loop(
    advance: Advance,
    mesh: Mesh,
    fields: Initial,
    times: Sequence[float],
    options: UnsteadyOptions | None = None,
    *,
    geometry: Mesh | None = None,
    project: Project | None = None,
    callback: Callable[[Instant], object] | None = None,
) -> Unsteady:
    """Solve a problem in time on meshes that follow the solution.

    The instants are cut into windows. Each is first solved on the mesh at hand; from all its
    instants a metric is made, which is the intersection of theirs; if the mesh does not fit that
    any more, a new one is made, the fields at the *beginning* of the window are transferred to it,
    and the window is solved again. So the mesh is fine where the solution will be, and each
    window costs one transfer.

    Parameters
    ----------
    advance : callable
        ``advance(mesh, fields, begin, end)`` returns the fields at `end`. It is called again
        for instants that are solved again, so it must depend on its arguments only.
    mesh : Mesh
        The first mesh. Its boundary is the geometry of every mesh.
    fields : mapping of str to Field or array, or callable
        The fields at the first time. ``fields(mesh)`` returns them on any mesh, so that what the
        first mesh is too coarse for is not lost.
    times : sequence of float
        Instants in ascending order, at least two.
    options : UnsteadyOptions, optional
    geometry : Mesh, optional
        Another mesh whose boundary is the geometry.
    project : callable, optional
        ``project(points, facet_tag)`` moves (k, d) boundary points onto the true boundary.
    callback : callable, optional
        ``callback(instant)`` for the first instant and then each one that is final, in order:
        the place to write files, see `SeriesWriter`.

    Returns
    -------
    Unsteady

    Raises
    ------
    ValueError
        If the times do not ascend, or a field does not fit.
    MeshingError
        If `advance` or a stage fails; the message names the window. If the mesh of the target
        has no room in memory, before anything is solved.

    References
    ----------
    .. [1] F. Alauzet, P. J. Frey, P. L. George, B. Mohammadi, 3D transient fixed point mesh
       adaptation for time-dependent problems, Journal of Computational Physics 222 (2007),
       sections 3 and 4.
    """
    options = UnsteadyOptions() if options is None else options
    require(UnsteadyOptions, options=options)
    instants = _ascending(times)
    if options.adapt.metric.has_count:
        target = options.adapt.metric.complexity_for(mesh.dim)
        check_targets(mesh, options.adapt.metric, [target], options.adapt.remesh)
    shape = _Shape(geometry if geometry is not None else mesh, project)
    now = Instant(instants[0], mesh, dict(fields(mesh) if callable(fields) else fields))
    as_fields(mesh, now.fields)
    carry = partial(_evaluated, fields) if callable(fields) else partial(_carried, options.adapt)
    windows: list[Window] = []
    for ends in _windows(instants, options.window):
        try:
            history, window = _solved(advance, now, ends, options, shape, carry)
        except Exception as error:
            where = f"window {len(windows)}, from time {now.time:g}"
            raise MeshingError(f"{where}: {error}", getattr(error, "report", None)) from error
        if callback is not None:
            for instant in history[bool(windows) :]:
                callback(instant)
        windows.append(window)
        now, carry = history[-1], partial(_carried, options.adapt)
    return Unsteady(now, tuple(windows))


Carry = Callable[[Instant, Mesh], tuple[Fields, dict[str, Any] | None]]


@dataclass(frozen=True)
class _Shape:
    geometry: Mesh
    project: Project | None


def _ascending(times: Sequence[float]) -> list[float]:
    instants = [float(time) for time in times]
    if len(instants) < 2:
        raise ValueError(f"times must be at least two, got {len(instants)}")
    for i, (before, after) in enumerate(itertools.pairwise(instants)):
        if not before < after:
            raise ValueError(f"times must ascend: {before:g} at {i} is followed by {after:g}")
    return instants


def _windows(instants: Sequence[float], size: int) -> Iterator[list[float]]:
    for first in range(1, len(instants), size):
        yield list(instants[first : first + size])


def _solved(
    advance: Advance,
    begin: Instant,
    ends: list[float],
    options: UnsteadyOptions,
    shape: _Shape,
    carry: Carry,
) -> tuple[list[Instant], Window]:
    """Solve one window, its beginning included, on a new mesh if the one at hand does not fit."""
    made, report = 0, None
    history = _advanced(advance, begin, ends)
    while made < options.passes:
        mesh, metric = history[0].mesh, _window_metric(history, options.adapt)
        thresholds = {"unit_edges": options.unit_edges, "longest_edge": options.longest_edge}
        if not needs_adaptation(mesh, metric, **thresholds):
            break
        new = remesh(
            mesh,
            metric,
            options.adapt.remesh,
            geometry=shape.geometry,
            project=shape.project,
        ).mesh
        fields, report = carry(begin, new)
        history = _advanced(advance, Instant(begin.time, new, fields), ends)
        made += 1
    mesh = history[0].mesh
    return history, Window(begin.time, ends[-1], mesh.n_points, mesh.n_cells, made, report)


def _carried(options: AdaptOptions, begin: Instant, mesh: Mesh) -> tuple[Fields, dict[str, Any]]:
    carried = transfer(begin.mesh, begin.fields, mesh, options.transfer)
    return carried.fields, carried.report.as_dict()


def _evaluated(
    initial: Callable[[Mesh], Mapping[str, Field | ArrayLike]], begin: Instant, mesh: Mesh
) -> tuple[Fields, None]:
    return dict(initial(mesh)), None


def _advanced(advance: Advance, start: Instant, ends: list[float]) -> list[Instant]:
    history = [start]
    for end in ends:
        now = history[-1]
        found = advance(now.mesh, dict(now.fields), now.time, end)
        as_fields(now.mesh, found)
        history.append(Instant(end, now.mesh, dict(found)))
    return history


def _window_metric(history: Sequence[Instant], options: AdaptOptions) -> Floats:
    """Return the metric that every instant asks for, at the target complexity.

    A field has one scale for the whole window: where it nearly vanishes it asks for little.
    """
    mesh = history[0].mesh
    instants = [as_fields(mesh, instant.fields) for instant in history]
    names = metric_field_names(instants[0], options.metric_fields)
    scales = _window_scales(
        {name: np.stack([fields[name].values for fields in instants]) for name in names},
        options.metric.scale,
    )
    sources, scale = {}, {}
    for step, fields in enumerate(instants):
        for name in names:
            sources[f"{name} at step {step}"] = fields[name]
            scale[f"{name} at step {step}"] = scales[name]
    metric, _ = from_fields(mesh, sources, replace(options.metric, scale=scale))
    return np.asarray(metric)


def _window_scales(values: Mapping[str, Floats], scale: Scale) -> dict[str, float]:
    """Return by what each field, (instants, n) or (instants, n, d), is divided.

    "complexity" makes fields comparable within one instant; over several it is their range.
    """
    asked = scale if isinstance(scale, Mapping) else dict.fromkeys(values, scale)
    wrong = sorted(set(asked) ^ set(values))
    if wrong:
        raise ValueError(f"scale must have a value for each metric field: see {wrong[0]!r}")
    return {
        name: scale_of(
            found.reshape(-1, *found.shape[2:]),
            "range" if asked[name] == "complexity" else asked[name],
        )
        for name, found in values.items()
    }
