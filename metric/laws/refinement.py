"""How much finer than the mesh that carries a metric the metric may be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..base.arrays import Bools, Floats
from ..base.mesh import AnyMesh, MeshLike, as_mesh
from ..kernels.algebra import congruent, eigenvalues, eigh, lower_factor
from ..kernels.pieces import pieces
from ..kernels.spectra import compose, product
from ..tensors.checks import check_metric_on, check_result
from ..tensors.combination import check_step
from .implied import implied_metric

RESOLVED = 25.0
"""How many times more than at a neighbour a metric may refine at a point and still be believed.

The logarithm of a metric is interpolated along an edge, so that sizes fall geometrically over all
of it, where those that were meant fall near its fine end: the pieces of an edge are too many by
about the ratio of its ends. Where a mesh has as many points as the one to come, the ratio is
below 20 even for steep fronts that it does not see; for a wall layer of 1e-4 on a mesh of 286
points it is some hundred."""

ROUND_OFF = 64 * float(np.finfo(np.float64).eps)
"""Of eigenvalues, for each unit of the condition of what they belong to."""


@dataclass(frozen=True, kw_only=True)
class Refinement:
    """A metric (n, d, d) whose refinement was limited, where (n,), and the largest excess."""

    metric: Floats
    is_limited: Bools
    excess: float


def limited_refinement(mesh: AnyMesh, M: Floats, ratio: float | str = "auto") -> Floats:
    """Coarsen a metric where the mesh that carries it cannot resolve what it asks for.

    An analytic metric with a thin layer, given at the points of a coarse mesh, says nothing
    about how sizes grow away from the layer, and takes many times the points that it needs. In
    steps, with the metric evaluated anew at the points of each mesh, it takes no more than that.

    Parameters
    ----------
    mesh : MeshLike or other mesh object
        The mesh that carries the metric.
    M : ndarray (n, d, d)
        Metric, in 1 / length**2.
    ratio : float or "auto"
        Largest factor between a size of the mesh and the one that is asked for there, above 1.
        "auto" leaves alone what is asked for everywhere around: the edges of a point may be
        divided into at most 25 times as many pieces as those of the neighbour where they are
        fewest.

    Returns
    -------
    ndarray (n, d, d)
        In the basis that makes `M` and ``implied_metric(mesh)`` diagonal, sizes are raised to
        the bound; `M` itself where none is below it.

    Raises
    ------
    MetricError
        If `M` is no metric, or where it is limited the mesh has none.
    ValueError
        If `ratio` is out of range.
    """
    mesh = as_mesh(mesh)
    check_refinement("ratio", ratio)
    metric = check_metric_on(mesh, M)
    return check_result(refinement_limited(mesh, metric, ratio).metric, "the limited refinement")


def check_refinement(name: str, ratio: float | str) -> None:
    """Raise ValueError if a limit of the refinement is neither "auto" nor above 1."""
    if isinstance(ratio, str):
        if ratio != "auto":
            raise ValueError(f"{name} must be a number, None or 'auto', got {ratio!r}")
        return
    check_step(name, ratio)


def refinement_limited(mesh: MeshLike, M: Floats, ratio: float | str) -> Refinement:
    """Limit the refinement of a checked metric by a checked ratio."""
    n = len(mesh.points)
    nowhere = Refinement(metric=M, is_limited=np.zeros(n, dtype=bool), excess=1.0)
    if isinstance(ratio, str):
        most, fewest = pieces(mesh, M)
        allowed = RESOLVED * fewest
        rows = np.flatnonzero(most > allowed)
    else:
        allowed, rows = np.full(n, float(ratio)), np.arange(n)
    if len(rows) == 0:
        return nowhere
    own = implied_metric(mesh)[rows]
    L = lower_factor(own)
    values, vectors = eigh(congruent(L, M[rows]))
    held = np.minimum(values, np.square(allowed[rows])[:, None])
    is_held = held[:, -1] < values[:, -1]
    if not is_held.any():
        return nowhere
    found, limited = M.copy(), rows[is_held]
    values, held, vectors, L = values[is_held], held[is_held], vectors[is_held], L[is_held]
    reduced = compose(held, product(L, vectors))
    # of cells so flat that the smallest value is round-off all sizes are raised alike
    alike = M[limited] * (held[:, -1] / values[:, -1])[:, None, None]
    axes = eigenvalues(own[is_held])
    is_told = values[:, 0] > ROUND_OFF * axes[:, -1] / axes[:, 0] * values[:, -1]
    found[limited] = np.where(is_told[:, None, None], reduced, alike)
    nowhere.is_limited[limited] = True
    excess = float(np.sqrt(values[:, -1] / held[:, -1]).max())
    return Refinement(metric=found, is_limited=nowhere.is_limited, excess=excess)
