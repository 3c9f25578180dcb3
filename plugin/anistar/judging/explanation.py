"""Why a star is certified or not: its simplices, seen in the metric of its vertex."""

from __future__ import annotations

import math
import operator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats
from ..base.core_errors import meshing_errors
from ..base.report import attributes
from ..meshes.mesh import Mesh
from ..metric import check_metric
from ..metric.kernels.algebra import solved
from .metric_mesh import MetricMesh


@dataclass(frozen=True, slots=True, kw_only=True)
class SimplexOfStar:
    """One simplex of the star of a vertex v, seen in the metric of v.

    Attributes
    ----------
    cell : int
        Its index in ``mesh.cells``.
    vertices : tuple of int
        Its points.
    is_delaunay : bool
        Whether it reaches no vertex strictly inside its circumscribed ellipsoid.
    violator : int or None
        A vertex inside, where there is one.
    centre : tuple of float
        Circumcentre in the metric of v, rounded.
    radius : float
        Circumradius in the metric of v, rounded.
    violator_distance : float or None
        Distance of the violator from the centre in the metric of v, rounded.
    """

    cell: int
    vertices: tuple[int, ...]
    is_delaunay: bool
    violator: int | None
    centre: tuple[float, ...]
    radius: float
    violator_distance: float | None

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins; the keys are those of the attributes."""
        return attributes(self)


def explain_star(mesh: Mesh, M: ArrayLike, vertex: int) -> tuple[SimplexOfStar, ...]:
    """Return, for each simplex of one star, what decides whether the star is certified.

    Parameters
    ----------
    mesh : Mesh
    M : (n, d, d) array
        Metric at the points, in 1 / length**2.
    vertex : int
        The point whose star is explained.

    Returns
    -------
    tuple of SimplexOfStar
        In the order of ``mesh.cells``. The star is certified when all are Delaunay.

    Raises
    ------
    MetricError
        If a tensor is not symmetric positive definite; the point is named.
    ValueError
        If the mesh has no such vertex.
    """
    metric = check_metric(M, n_points=mesh.n_points, dim=mesh.dim)
    vertex = operator.index(vertex)
    if not 0 <= vertex < mesh.n_points:
        raise ValueError(f"vertex must be in [0, {mesh.n_points - 1}], got {vertex}")
    cells = np.flatnonzero((mesh.cells == vertex).any(axis=1))
    judged = MetricMesh.of(mesh, metric)
    return tuple(_explained(judged, metric[vertex], int(cell)) for cell in cells)


def _explained(mesh: MetricMesh, metric: Floats, cell: int) -> SimplexOfStar:
    with meshing_errors():
        found = mesh.core().violator(cell=cell, metric=metric)
    corners = mesh.points[mesh.cells[cell]]
    centre = circumcentre(corners, metric)
    return SimplexOfStar(
        cell=cell,
        vertices=tuple(mesh.cells[cell].tolist()),
        is_delaunay=found < 0,
        violator=None if found < 0 else int(found),
        centre=tuple(centre.tolist()),
        radius=_length(corners[0] - centre, metric),
        violator_distance=None if found < 0 else _length(mesh.points[found] - centre, metric),
    )


def circumcentre(simplex: Floats, metric: Floats) -> Floats:
    """Return the (d,) centre of the circumscribed ellipsoid of a (d + 1, d) simplex in a metric."""
    legs = simplex[1:] - simplex[0]
    gram = np.einsum("ki,ij,lj->kl", legs, metric, legs)
    weights = solved(gram[None], np.diagonal(gram)[None] / 2)[0]
    return np.asarray(simplex[0] + np.einsum("k,ki->i", weights, legs))


def _length(vector: Floats, metric: Floats) -> float:
    return math.sqrt(np.einsum("i,ij,j->", vector, metric, vector))
