"""The first mesh in the plane: constrained Delaunay triangles, and their refinement."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from ... import _core
from ...base.arrays import Floats, Ints
from ...base.core_errors import meshing_errors
from ...meshes.mesh_arrays import unit_scale
from ...meshes.topology import cell_volumes, edge_lengths, vector_lengths
from ..geometry.plc import PLC
from ..pieces import Pieces

PlaneSizes = float | ArrayLike | Callable[[Floats], ArrayLike]
"""One length of edges, one at each point of the mesh, or ``size(points)``."""

BOUND = 1.15
"""Circumradius over shortest edge: no angle below 25.8 degrees, and still known to end."""

SMALLEST_BOUND = 1.0 / math.sqrt(3.0)
"""Of an equilateral triangle."""

#: A size that is a function is looked at on so many meshes at most.
MOST_ROUNDS = 12

#: The mesh may have so many vertices whatever is asked for, and so many times the predicted ones.
FREE_VERTICES = 1_000_000
EXCESS = 50.0

_INSIDE = {
    "regions": _core.Inside.parity,
    "winding": _core.Inside.winding,
    "nonzero": _core.Inside.nonzero,
}


@dataclass(frozen=True, kw_only=True, eq=False)
class PlanePieces(Pieces):
    """Triangles that conform to a complex in the plane.

    The tag of a cell is that of the seed; without one 0, or the winding number. Walls have the
    domain on their left where they bound it. There are no edges beside them, and points on them
    need no history.

    Attributes
    ----------
    counts : dict of str to int
        What refinement has done, see `refined_plane`.
    stop_reason : str
        "finished", or the bound that ended it: "max_vertices", "max_seconds".
    warnings : tuple of str
    """

    counts: dict[str, int] = field(default_factory=dict)
    stop_reason: str = "finished"
    warnings: tuple[str, ...] = ()

    @classmethod
    def _of(cls, made: _core.MeshArrays, scale: float, **others: Any) -> PlanePieces:
        return cls(
            points=made.points / scale,
            cells=made.cells,
            cell_tags=made.cell_tags,
            walls=made.facets,
            wall_facets=made.facet_tags,
            **others,
        )

    def _as_core(self, scale: float) -> _core.MeshArrays:
        return _core.MeshArrays(
            points=self.points * scale,
            cells=self.cells,
            cell_tags=self.cell_tags,
            facets=self.walls,
            facet_tags=self.wall_facets,
            edges=self.edges,
            edge_tags=self.edge_segments,
            corners=np.zeros(0, np.int32),
        )


@dataclass(frozen=True, kw_only=True)
class PlaneBudget:
    """What ends a refinement: a number of vertices, seconds, an exception of the callback."""

    max_vertices: int | None = None
    max_seconds: float | None = None
    callback: Callable[..., object] | None = None

    @property
    def seconds(self) -> float:
        """The seconds, infinite without a bound."""
        return math.inf if self.max_seconds is None else self.max_seconds


def constrained_plane(
    plc: PLC,
    inside: Literal["regions", "winding", "nonzero"] = "regions",
    budget: PlaneBudget | None = None,
) -> PlanePieces:
    """Return the constrained Delaunay triangulation of what a complex encloses.

    No point is added. A segment that ends inside is a slit, and points to be kept are points of
    the mesh.

    Parameters
    ----------
    plc : PLC
    inside : "regions", "winding" or "nonzero"
        What is meshed of the parts without a seed or a hole. "regions": those that an odd number
        of closed loops enclose; where more than two segments meet, so that they divide a domain,
        all that they enclose. "winding": those around which the edges, as they are given, turn
        counter-clockwise; the number of turns is their tag. "nonzero": in either sense.
    budget : PlaneBudget, optional

    Raises
    ------
    MeshingError
        If points coincide, a point lies on a segment, segments cross (named), a seed is outside
        or contradicts another, or nothing is enclosed.

    References
    ----------
    .. [1] Chew, Constrained Delaunay triangulations, 1989.
    """
    budget = budget or PlaneBudget()
    scale = unit_scale(plc.points)
    seeds = np.array([region.seed for region in plc.regions]).reshape(-1, 2)
    with meshing_errors(scale):
        made = _core.constrained_triangles(
            points=plc.points * scale,
            segments=plc.segments,
            turns=_turns(plc),
            points_kept=plc.points_kept,
            seeds=seeds * scale,
            seed_tags=np.array([region.tag for region in plc.regions], np.int32),
            holes=plc.holes * scale,
            inside=_INSIDE[inside],
            max_seconds=budget.seconds,
            callback=budget.callback,
        )
    outside = np.setdiff1d(plc.points_kept, made.cells)
    warnings = (f"{len(outside)} points to be kept are outside",) if len(outside) else ()
    return PlanePieces._of(made, scale, warnings=warnings)


def refined_plane(
    plc: PLC,
    made: PlanePieces,
    sizes: PlaneSizes | None = None,
    bound: float = BOUND,
    budget: PlaneBudget | None = None,
) -> PlanePieces:
    """Return triangles after Delaunay refinement.

    No angle is below ``arcsin(1 / (2 bound))``, but where segments meet at less than 60 degrees:
    there triangles that span the angle are left as they are, and counted.

    Parameters
    ----------
    plc : PLC
        Its regions give sizes too.
    made : PlanePieces
        What `constrained_plane` made of it.
    sizes : float, (n,) array or callable, optional
        Wanted lengths of edges; infinite ones ask for nothing.
    bound : float
        Of circumradius over shortest edge. It is known to end for 1.123 and more (26.4 degrees),
        and mostly does down to 0.95 (31.8).
    budget : PlaneBudget, optional

    Returns
    -------
    PlanePieces
        Its counts: points on segments (``split_segments``) and inside (``off_centres``), those
        ``rejected`` as they came too near to a segment, triangles worse than the bound
        ``at_small_angles``, and what was ``refused`` as there are no doubles left between.

    References
    ----------
    .. [1] Ruppert, A Delaunay refinement algorithm for quality 2-dimensional mesh generation,
       1995.
    .. [2] Miller, Pav, Walkington, When and why Ruppert's algorithm works, 2003.
    .. [3] Uengoer, Off-centers: a new type of Steiner points, 2004.
    """
    if not (math.isfinite(bound) and bound > SMALLEST_BOUND):
        raise ValueError(f"bound must be finite and above {SMALLEST_BOUND:.3g}, got {bound}")
    budget = budget or PlaneBudget()
    if not callable(sizes):
        return _refined(plc, made, _at_points(sizes, made), bound, budget)
    for _ in range(MOST_ROUNDS):
        before = len(made.points)
        made = _refined(plc, made, _evaluated(sizes, made.points), bound, budget)
        if len(made.points) == before or made.stop_reason != "finished":
            break
    return made


def plane_sizes(
    plc: PLC, made: PlanePieces, budget: PlaneBudget | None = None
) -> tuple[PlanePieces, Floats]:
    """Return triangles, and sizes at their points that follow the outline.

    Delaunay refinement without a size makes edges as long as segments are and as gaps between
    segments are wide, up to a factor that its bound gives, and longer away from there (Ruppert's
    local feature size).

    Returns
    -------
    fine : PlanePieces
    sizes : (n,) float64
        The mean length of the edges at each point; infinite at points of no triangle.
    """
    fine = refined_plane(plc, made, budget=budget)
    edges = np.sort(fine.cells[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges = np.unique(edges, axis=0)
    lengths = np.repeat(edge_lengths(fine.points, edges), 2)
    n = len(fine.points)
    total = np.bincount(edges.ravel(), weights=lengths, minlength=n)
    count = np.bincount(edges.ravel(), minlength=n)
    return fine, np.where(count > 0, total / np.maximum(count, 1), np.inf)


def _refined(
    plc: PLC, made: PlanePieces, sizes: Floats, bound: float, budget: PlaneBudget
) -> PlanePieces:
    scale = unit_scale(plc.points)
    extent = float(vector_lengths(np.ptp(plc.points, axis=0)))
    wished = {region.tag: region.size for region in plc.regions if region.size is not None}
    tags = np.array(sorted(wished), np.int32)
    in_regions = np.array([wished[int(tag)] for tag in tags])
    sizes = np.minimum(sizes, extent)
    limit = budget.max_vertices
    with meshing_errors(scale):
        arrays, counts, reason = _core.refined_triangles(
            made._as_core(scale),
            given_points=plc.points * scale,
            segments=plc.segments,
            bound=bound,
            sizes=sizes * scale,
            region_tags=tags,
            region_sizes=in_regions * scale,
            max_vertices=_most_vertices(made, sizes, wished) if limit is None else limit,
            max_seconds=budget.seconds,
            callback=budget.callback,
        )
    added = {name: counts[name] + made.counts.get(name, 0) for name in _ADDED}
    return PlanePieces._of(
        arrays, scale, counts={**counts, **added}, stop_reason=reason.name, warnings=made.warnings
    )


_ADDED = ("split_segments", "off_centres", "rejected")


def _most_vertices(made: PlanePieces, sizes: Floats, wished: dict[int, float]) -> int:
    """Return a number of vertices beyond which something has gone wrong."""
    target = sizes[made.cells].min(axis=1)
    for tag, size in wished.items():
        here = made.cell_tags == tag
        target[here] = np.minimum(target[here], size)
    predicted = (cell_volumes(made.points, made.cells) / (target * target)).sum()
    return int(min(max(FREE_VERTICES, EXCESS * (predicted + len(made.points))), 2**31 - 1))


def _at_points(sizes: float | ArrayLike | None, made: PlanePieces) -> Floats:
    values = np.asarray(math.inf if sizes is None else sizes, dtype=np.float64)
    if values.ndim == 0:
        values = np.full(len(made.points), float(values))
    elif values.shape != (len(made.points),):
        raise ValueError(f"sizes must have shape ({len(made.points)},), not {values.shape}")
    return _checked(values)


def _evaluated(sizes: Callable[[Floats], ArrayLike], points: Floats) -> Floats:
    values = np.asarray(sizes(points.copy()), dtype=np.float64)
    if values.shape != (len(points),):
        raise ValueError(f"sizes give shape {values.shape} for {len(points)} points")
    return _checked(values)


def _checked(values: Floats) -> Floats:
    bad = np.flatnonzero(~(values > 0.0))
    if bad.size:
        raise ValueError(f"the size at point {bad[0]} must be positive, got {values[bad[0]]}")
    return values


def _turns(plc: PLC) -> Ints:
    """Return how often more each segment is given from its first point than to it."""
    n = plc.n_points
    low, high = np.sort(plc.edges.astype(np.int64), axis=1).T
    segments = plc.segments.astype(np.int64)
    row = np.searchsorted(segments[:, 0] * n + segments[:, 1], low * n + high)
    turns = np.zeros(len(segments), np.int32)
    np.add.at(turns, row, np.where(plc.edges[:, 0] == low, 1, -1).astype(np.int32))
    return turns
