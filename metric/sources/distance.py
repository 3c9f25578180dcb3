"""Distances from points to segments and triangles."""

from __future__ import annotations

import numpy as np
import scipy  # loads scipy.spatial when it is first used
from numpy.typing import NDArray

from ..base.arrays import Floats
from ..base.vectors import norms

Index = NDArray[np.intp]

FIRST_NEIGHBOURS = 4
"""Facets looked at per point in the first round; the number doubles until it is enough."""


def distance_to_facets(points: Floats, facets: Floats) -> Floats:
    """Exact distance (n,) from each point to the nearest of k facets (k, d, d).

    Facets are taken by the distance of their centres from a tree; one whose centre is further
    than the best distance plus the largest radius of a facet cannot be nearer.
    """
    centres = facets.mean(axis=1)
    radius = float(norms(facets - centres[:, None]).max())
    tree = scipy.spatial.cKDTree(centres)
    best = np.full(len(points), np.inf)
    todo = np.arange(len(points))
    asked = min(FIRST_NEIGHBOURS, len(facets))
    while todo.size:
        away, found = tree.query(points[todo], k=np.arange(1, asked + 1))
        for column in found.T:
            best[todo] = np.minimum(best[todo], _distance(points[todo], facets[column]))
        todo = todo[away[:, -1] < best[todo] + radius]
        if asked == len(facets):
            break
        asked = min(2 * asked, len(facets))
    return best


def _distance(points: Floats, facets: Floats) -> Floats:
    """Distance (n,) from each point to its own facet (n, d, d)."""
    if facets.shape[1] == 2:
        return _to_segment(points, facets[:, 0], facets[:, 1])
    return _to_triangle(points, facets)


def _to_segment(x: Floats, a: Floats, b: Floats) -> Floats:
    v = b - a
    along = np.einsum("ni,ni->n", x - a, v)
    length = np.maximum(np.einsum("ni,ni->n", v, v), np.finfo(float).tiny)
    share = np.clip(along / length, 0.0, 1.0)
    return np.asarray(norms(x - a - share[:, None] * v))


def _to_triangle(x: Floats, triangle: Floats) -> Floats:
    a, b, c = triangle.transpose(1, 0, 2)
    sides = [_to_segment(x, a, b), _to_segment(x, b, c), _to_segment(x, c, a)]
    normal = np.cross(b - a, c - a)
    length = norms(normal)
    normal /= np.maximum(length, np.finfo(float).tiny)[:, None]
    inside = length > 0.0
    for start, end in ((a, b), (b, c), (c, a)):
        inside &= np.einsum("ni,ni->n", np.cross(end - start, x - start), normal) >= 0.0
    plane = np.abs(np.einsum("ni,ni->n", x - a, normal))
    return np.asarray(np.where(inside, plane, np.minimum.reduce(sides)))
