"""Why a star is certified or not: what it is made of, seen in the metric of its vertex."""

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
from ..objects import AnyMesh, metric_on
from .metric_mesh import MetricMesh, SurfaceMesh
from .skin import Shape, Skin


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


@dataclass(frozen=True, slots=True, kw_only=True)
class FacetOfStar:
    """One facet of the surface star of a vertex v, seen in the metric of v.

    Attributes
    ----------
    facet : int
        Its index in ``mesh.facets``.
    vertices : tuple of int
        Its points, v first.
    is_delaunay : bool
        Whether it reaches no vertex strictly inside its surface ball, so that it is in the star.
    violator : int or None
        A vertex inside, where there is one.
    centre : tuple of float
        Of its surface ball, on the surface, rounded; NaN where the line of the points that are
        as far from all vertices of the facet does not meet the surface.
    radius : float
        Of its surface ball in the metric of v, rounded.
    shift : float
        How far the ball is shifted along its axis from that with its centre in the plane of the
        facet, in 1 / length**d; 0 on planar patches. See the notes of `explain_surface_star`.
    violator_distance : float or None
        Distance of the violator from the centre in the metric of v, rounded.
    """

    facet: int
    vertices: tuple[int, ...]
    is_delaunay: bool
    violator: int | None
    centre: tuple[float, ...]
    radius: float
    shift: float
    violator_distance: float | None

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins; the keys are those of the attributes."""
        return attributes(self)


def explain_star(mesh: AnyMesh, M: ArrayLike | str, vertex: int) -> tuple[SimplexOfStar, ...]:
    """Return, for each simplex of one star, what decides whether the star is certified.

    Parameters
    ----------
    mesh : Mesh or other mesh object
    M : (n, d, d) array, (n,) sizes, one size, or name of a field of the object
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
    mesh, M = metric_on(mesh, M)
    metric = check_metric(M, n_points=mesh.n_points, dim=mesh.dim)
    vertex = _checked(vertex, mesh)
    cells = np.flatnonzero((mesh.cells == vertex).any(axis=1))
    judged = MetricMesh.of(mesh, metric)
    return tuple(_explained(judged, metric[vertex], int(cell)) for cell in cells)


def explain_surface_star(
    mesh: AnyMesh,
    M: ArrayLike | str,
    vertex: int,
    *,
    shape: Shape = "smooth",
    ridge_angle: float = 45.0,
) -> tuple[FacetOfStar, ...]:
    """Return, for each facet at one vertex, what decides whether it is in the surface star.

    Parameters
    ----------
    mesh : Mesh or other mesh object
    M : (n, d, d) array, (n,) sizes, one size, or name of a field of the object
        Metric at the points, in 1 / length**2.
    vertex : int
        The point whose surface star is explained.
    shape, ridge_angle
        As in `certify`.

    Returns
    -------
    tuple of FacetOfStar
        In the order of ``mesh.facets``; nothing for a vertex of no facet. The surface star is
        certified when all are Delaunay.

    Raises
    ------
    MetricError
        If a tensor is not symmetric positive definite; the point is named.
    ValueError
        If the mesh has no such vertex.

    Notes
    -----
    With y the offset from v, the facet with the edges u and w from v and their cross product n
    (in 2D the edge u turned to the left), its ball holds the points where
    ``y.My - G.y - shift n.y`` is negative. G is fixed by the vertices of the facet and, for the
    shift 0, by the centre in its plane.
    """
    mesh, M = metric_on(mesh, M)
    metric = check_metric(M, n_points=mesh.n_points, dim=mesh.dim)
    vertex = _checked(vertex, mesh)
    skin = Skin(shape=shape, ridge_angle=ridge_angle)
    surface = SurfaceMesh.of(mesh, MetricMesh.of(mesh, metric), skin)
    corners = np.argwhere(mesh.facets == vertex)
    return tuple(_explained_facet(surface, metric[vertex], *at) for at in corners.tolist())


def _checked(vertex: int, mesh: Mesh) -> int:
    vertex = operator.index(vertex)
    if not 0 <= vertex < mesh.n_points:
        raise ValueError(f"vertex must be in [0, {mesh.n_points - 1}], got {vertex}")
    return vertex


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


def _explained_facet(surface: SurfaceMesh, metric: Floats, facet: int, corner: int) -> FacetOfStar:
    found, shift = surface.violator(facet, corner)
    mesh = surface.mesh
    vertices = np.roll(mesh.facets[facet], -corner)
    corners = mesh.points[vertices]
    centre = circumcentre(corners, metric) + shift / 2 * _axis(corners, metric)
    return FacetOfStar(
        facet=facet,
        vertices=tuple(vertices.tolist()),
        is_delaunay=math.isfinite(shift) and found < 0,
        violator=None if found < 0 else found,
        centre=tuple(centre.tolist()),
        radius=_length(corners[0] - centre, metric),
        shift=shift,
        violator_distance=None if found < 0 else _length(mesh.points[found] - centre, metric),
    )


def _axis(facet: Floats, metric: Floats) -> Floats:
    """Return the (d,) direction of the points that are as far from all vertices of a facet."""
    legs = facet[1:] - facet[0]
    turned = np.cross(*legs) if len(legs) == 2 else np.array([-legs[0, 1], legs[0, 0]])
    return np.asarray(solved(metric[None], turned[None])[0])


def circumcentre(simplex: Floats, metric: Floats) -> Floats:
    """Return the (d,) centre of the circumscribed ellipsoid of a simplex in a metric.

    A simplex with fewer than d + 1 vertices has it in its own plane.
    """
    legs = simplex[1:] - simplex[0]
    gram = np.einsum("ki,ij,lj->kl", legs, metric, legs)
    weights = solved(gram[None], np.diagonal(gram)[None] / 2)[0]
    return np.asarray(simplex[0] + np.einsum("k,ki->i", weights, legs))


def _length(vector: Floats, metric: Floats) -> float:
    return math.sqrt(np.einsum("i,ij,j->", vector, metric, vector))
