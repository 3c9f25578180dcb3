"""How wide the facets of a polyhedron are, and how thick it is: sizes that its shape asks for."""

from __future__ import annotations

import math

import numpy as np

from ...base.arrays import Bools, Floats, Ints, Longs
from ...meshes.mesh import Mesh
from ...meshes.topology import edge_lengths, facet_measures, facet_table, vector_lengths
from ...metric.base.mesh import diameter

#: A mesh without a given size has so many points on its facets at most, or about.
MOST_ON_SURFACE = 40_000.0

#: Area of the surface for each point of equilateral triangles with unit edges.
EQUILATERAL_POINT = math.sqrt(3.0) / 2.0

#: Enough to find a size to six digits.
BISECTIONS = 40

#: The sides of a triangle, and the corner opposite each.
SIDES = ((0, 1, 2), (1, 2, 0), (2, 0, 1))


def local_widths(mesh: Mesh) -> Floats:
    """Return the (n,) width of the domain at each point, infinite where nothing is near.

    That is the least of the lengths of segments, of the distances between segments across a facet
    where they are no neighbours, and of the distances of points from facets across the inside. A
    coarse constrained Delaunay mesh shows them as its edges and heights: whatever is near each
    other is joined there.

    Parameters
    ----------
    mesh : Mesh
        Its facets and edges are those of the polyhedron, and no others.
    """
    widths = np.full(mesh.n_points, np.inf)
    segments = mesh.edges if mesh.dim == 3 else mesh.facets
    np.minimum.at(widths, segments.ravel(), np.repeat(edge_lengths(mesh.points, segments), 2))
    on_segment = np.zeros(mesh.n_points, bool)
    on_segment[segments.ravel()] = True
    triangles = mesh.facets if mesh.dim == 3 else mesh.cells
    _lower_across_triangles(widths, mesh.points, triangles, segments, on_segment)
    if mesh.dim == 3:
        _lower_across_cells(widths, mesh)
    return widths


def affordable(mesh: Mesh, widths: Floats) -> tuple[Floats, tuple[str, ...]]:
    """Return widths below which no mesh of moderate size can go, and what that is to be told.

    Nobody who gives no size waits for millions of cells in a narrow gap.

    Parameters
    ----------
    mesh : Mesh
    widths : (n,) float64
        At its points.
    """
    areas = facet_measures(mesh.points, mesh.facets)
    sizes = np.minimum(widths, diameter(mesh))[mesh.facets].min(axis=1)
    low, high = float(sizes.min()), diameter(mesh)
    if mesh.dim == 2 or _points_on(areas, sizes, low) <= MOST_ON_SURFACE:
        return widths, ()
    for _ in range(BISECTIONS):
        middle = math.sqrt(low * high)
        few = _points_on(areas, sizes, middle) <= MOST_ON_SURFACE
        low, high = (low, middle) if few else (middle, high)
    return np.maximum(widths, high), (
        f"sizes follow the widths of facets down to {high:.3g} only: narrower parts have flat "
        "cells; follow_widths=True goes on, a size is taken as it is",
    )


def _points_on(areas: Floats, sizes: Floats, floor: float) -> float:
    """Return how many points equilateral triangles of the sizes, none below a floor, have."""
    return float((areas / (EQUILATERAL_POINT * np.square(np.maximum(sizes, floor)))).sum())


def _lower_across_triangles(
    widths: Floats, points: Floats, triangles: Ints, segments: Ints, on_segment: Bools
) -> None:
    """Lower the widths at triangles between a segment and a point of another."""
    known = _keys(segments, len(points))
    is_segment = [np.isin(_keys(triangles[:, [i, j]], len(points)), known) for i, j, _ in SIDES]
    for side, (i, j, k) in enumerate(SIDES):
        others = is_segment[(side + 1) % 3] | is_segment[(side + 2) % 3]
        faced = triangles[is_segment[side] & ~others & on_segment[triangles[:, k]]]
        a, b, apex = points[faced[:, i]], points[faced[:, j]], points[faced[:, k]]
        along = b - a
        share = np.einsum("ni,ni->n", apex - a, along) / np.einsum("ni,ni->n", along, along)
        foot = a + share[:, None] * along
        is_above = (share > 0.0) & (share < 1.0)
        _lower(widths, points, faced[is_above], foot[is_above])


def _lower_across_cells(widths: Floats, mesh: Mesh) -> None:
    """Lower the widths at cells between a facet and a point beyond it, if it is above the facet."""
    table = facet_table(mesh.cells, mesh.n_points)
    row = table.find(mesh.facets)
    facet, side = np.nonzero(table.cells[row] >= 0)
    cell, opposite = table.cells[row[facet], side], table.local[row[facet], side]
    apex = mesh.points[mesh.cells[cell, opposite]]
    a, b, c = mesh.points[mesh.facets[facet]].transpose(1, 0, 2)
    normal = np.cross(b - a, c - a)
    normal /= vector_lengths(normal)[:, None]
    height = np.einsum("ni,ni->n", normal, apex - a)
    foot = apex - height[:, None] * normal
    is_above = np.ones(len(cell), bool)
    for start, end in ((a, b), (b, c), (c, a)):
        inner = np.cross(end - start, foot - start)
        is_above &= np.einsum("ni,ni->n", inner, normal) > 0.0
    _lower(widths, mesh.points, mesh.cells[cell[is_above]], foot[is_above])


def _lower(widths: Floats, points: Floats, simplices: Ints, foot: Floats) -> None:
    """Lower the widths at the corners of simplices that are narrow at the foot of their heights.

    The end of a long facet that is far from the foot is no nearer to what is beyond.
    """
    for corners in simplices.T:
        np.minimum.at(widths, corners, vector_lengths(points[corners] - foot))


def _keys(edges: Ints, n_points: int) -> Longs:
    """Return a number for each edge, whichever end is its first."""
    ordered = np.sort(edges.astype(np.int64), axis=1)
    return ordered[:, 0] * n_points + ordered[:, 1]
