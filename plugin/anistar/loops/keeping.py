"""Whether a mesh is kept or made anew when the metric has changed."""

from __future__ import annotations

import math
from dataclasses import dataclass

from numpy.typing import ArrayLike

from ..base.arguments import require
from ..judging.quality import UNIT, metric_lengths
from ..meshes.topology import unique_edges
from ..metric import ELEMENTS_PER_COMPLEXITY, check_metric, complexity, implied_metric
from ..metric.base.by_name import by_name
from ..metric.laws.complexity import REAL_ELEMENTS_PER_COMPLEXITY
from ..objects import AnyMesh, metric_on

# Of the metric that a real mesh implies, per complexity of the metric it was made for.
_COMPLEXITY_OF_REAL_MESHES = {
    dim: REAL_ELEMENTS_PER_COMPLEXITY[dim] / ELEMENTS_PER_COMPLEXITY[dim] for dim in (2, 3)
}


@by_name
@dataclass(frozen=True, slots=True, kw_only=True)
class KeepOptions:
    """How far a mesh may be from a metric and still be kept.

    A new mesh has few edges that are too long, none longer than 2, and the complexity of its own
    metric within 20 %. The bounds are wider, so that a mesh is kept while the solution changes
    little, and a new one is not made anew at once. Edges that are too long lose accuracy and
    decide. Those that are too short only cost, and never decide alone: where a solution is flat
    its metric is noise, which asks for other sizes each time.

    Parameters
    ----------
    under : float
        Largest share of edges that are longer than sqrt(2) in the metric.
    misplaced : float
        Largest share of edges that are shorter than 1/sqrt(2), where more than a third of `under`
        are too long: then a feature has left the points that were made for it.
    over : float
        By what share the complexity of the metric that the mesh implies may exceed that of the
        metric; in 3D that of a good mesh for the metric is 1.2 times larger to begin with, since
        perfect tetrahedra do not fill space, and the excess is counted from there.
    longest : float
        Largest length of an edge in the metric. That of a new mesh is up to 2, and as much again
        where its sizes have grown by the factor 2 that a loop lets them, and should not have.

    Raises
    ------
    ValueError
        If a bound is out of range.
    """

    under: float = 0.15
    misplaced: float = 0.18
    over: float = 0.6
    longest: float = 4.0

    def __post_init__(self) -> None:
        for name in ("under", "misplaced"):
            if not 0 <= getattr(self, name) <= 1:
                raise ValueError(f"{name} must be in [0, 1], got {getattr(self, name)}")
        if not self.over >= 0:
            raise ValueError(f"over must be at least 0, got {self.over}")
        if not self.longest > UNIT[1]:
            raise ValueError(f"longest must be above sqrt(2), got {self.longest}")


def needs_adaptation(mesh: AnyMesh, M: ArrayLike | str, keep: KeepOptions | None = None) -> bool:
    """Return whether a mesh is too far from a metric to be kept.

    Parameters
    ----------
    mesh : Mesh or other mesh object
    M : (n, d, d) array, (n,) sizes, one size, or name of a field of the object
        Metric at its points.
    keep : KeepOptions, optional
        How far that may be.

    Raises
    ------
    MetricError
        If a tensor is not symmetric positive definite; the point is named.
    """
    keep = KeepOptions() if keep is None else keep
    require(KeepOptions, keep=keep)
    mesh, M = metric_on(mesh, M)
    metric = check_metric(M, n_points=mesh.n_points, dim=mesh.dim)
    lengths = metric_lengths(mesh, metric, unique_edges(mesh.cells, mesh.n_points))
    too_long, too_short = (lengths > UNIT[1]).mean(), (lengths < UNIT[0]).mean()
    if lengths.max() > keep.longest or too_long > keep.under:
        return True
    if too_short > keep.misplaced and too_long > keep.under / 3:
        return True
    if math.isinf(keep.over):
        return False
    own = complexity(mesh, implied_metric(mesh)) / _COMPLEXITY_OF_REAL_MESHES[mesh.dim]
    return bool(own > (1.0 + keep.over) * complexity(mesh, metric))
