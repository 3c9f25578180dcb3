"""Does a mesh cover some place twice? Decided on its boundary alone.

When every cell has positive volume and lies opposite its neighbour across each shared facet, the
number of cells over a place equals the winding number of the oriented boundary around it. Some
place is then covered twice exactly when some boundary facet has a covered outer side. Between
two places where boundary facets cross or touch, that cannot change, so it is enough to look for
crossings and contacts, and then at one facet of every boundary component.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np
from scipy.sparse import coo_array

from .. import _core
from ..base.arrays import Bools, Floats, Ints, Longs
from ..metric.kernels.elementary import angle_of
from .topology import RowKeys, facet_normals, vector_lengths

# A point this close to a facet, relative to the facet's size, touches it: a hundred times the
# round-off of the tests below, far below any gap that a double can resolve usefully.
CONTACT = 1e-12
# Pairs of facets that are looked at together; bounds the memory.
CHUNK = 1 << 16


def coincident_points(points: Floats, facets: Ints) -> tuple[int, int] | None:
    """Return two different points of the facets with equal coordinates, if there are any."""
    used = np.unique(facets)
    coordinates = points[used]
    order = np.lexsort(coordinates.T)
    equal = np.all(coordinates[order[1:]] == coordinates[order[:-1]], axis=1)
    if not equal.any():
        return None
    first = int(np.argmax(equal))
    a, b = sorted((int(used[order[first]]), int(used[order[first + 1]])))
    return a, b


def touching_point(points: Floats, facets: Ints) -> tuple[int, int] | None:
    """Return a point and the row of a facet that it lies on without being its vertex."""
    for first, second in _close_pairs(points, facets):
        for column in range(facets.shape[1]):
            vertex = facets[second, column]
            # neighbours, most of all pairs, share points
            other = np.flatnonzero((facets[first] != vertex[:, None]).all(axis=1))
            hit = _lies_on(points, facets[first[other]], vertex[other])
            if hit.any():
                at = other[int(np.argmax(hit))]
                return int(vertex[at]), int(first[at])
    return None


def crossing_facets(points: Floats, facets: Ints) -> tuple[int, int] | None:
    """Return the rows of two facets that cross each other, if there are any."""
    for first, second in _close_pairs(points, facets):
        hit = _cross(points, facets[first], facets[second])
        if hit.any():
            at = int(np.argmax(hit))
            return int(first[at]), int(second[at])
    return None


def doubled_cell(cells: Ints, facets: Ints) -> int | None:
    """Return a cell with the points of another one, if there is any with all points on facets."""
    on_facets = np.isin(cells, facets).all(axis=1)
    rows = np.flatnonzero(on_facets)
    _, first = np.unique(np.sort(cells[rows], axis=1), axis=0, return_index=True)
    doubled = np.delete(rows, first)
    return int(doubled[0]) if len(doubled) else None


def covered_facet(points: Floats, facets: Ints) -> int | None:
    """Return a facet whose outer side is covered; facets must neither cross nor touch."""
    _, representative = np.unique(_components(facets, len(points)), return_index=True)
    for row in representative:
        others = np.delete(facets, row, axis=0)
        middle = points[facets[row]].mean(axis=0)
        # On the facet itself the winding number is the mean of its two sides: 1/2 when only the
        # inner side is covered.
        if abs(_winding(points[others] - middle) - 0.5) > 0.25:
            return int(row)
    return None


def _components(facets: Ints, n_points: int) -> Ints:
    """Label facets connected through vertices (2D) or edges (3D) that have two facets."""
    from scipy.sparse.csgraph import connected_components  # slow to import

    width = facets.shape[1]
    ridges = np.concatenate([np.delete(facets, i, axis=1) for i in range(width)])
    keys = RowKeys(ridges, n_points).encode(ridges)
    order = np.argsort(keys, kind="stable")
    _, starts, counts = np.unique(keys[order], return_index=True, return_counts=True)
    simple = starts[counts == 2]
    first, second = order[simple] % len(facets), order[simple + 1] % len(facets)
    graph = coo_array((np.ones(len(first)), (first, second)), shape=(len(facets),) * 2)
    labels: Ints = connected_components(graph, directed=False)[1]
    return labels


def _winding(corners: Floats) -> float:
    """Return the winding number around the origin of facets given as (k, d, d) corners."""
    if corners.shape[2] == 2:
        a, b = corners[:, 0], corners[:, 1]
        angles = angle_of(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(axis=1))
        return float(angles.sum() / (2 * np.pi))
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    la, lb, lc = (vector_lengths(x) for x in (a, b, c))
    top = np.einsum("ij,ij->i", a, np.cross(b, c))
    bottom = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (a * c).sum(1) * lb
    return float(2 * angle_of(top, bottom).sum() / (4 * np.pi))


def _close_pairs(points: Floats, facets: Ints) -> Iterator[tuple[Longs, Longs]]:
    """Yield (first, second) rows of facets that may meet, each pair in both orders."""
    close = _core.close_facets2 if points.shape[1] == 2 else _core.close_facets3
    pairs = close(np.ascontiguousarray(points), np.ascontiguousarray(facets, np.int32), CONTACT)
    for some in np.array_split(pairs, len(pairs) // CHUNK + 1):
        first, second = some.T.astype(np.int64)
        yield first, second
        yield second, first


def _lies_on(points: Floats, facets: Ints, vertices: Ints) -> Bools:
    """Tell for each row whether the vertex, no corner of the facet, lies on it."""
    corners = points[facets]
    legs = corners[:, 1:] - corners[:, :1]
    offset = points[vertices] - corners[:, 0]
    gram = np.einsum("kij,klj->kil", legs, legs)
    right = np.einsum("kij,kj->ki", legs, offset)
    if legs.shape[1] == 1:
        weights = right / gram[:, 0]
    else:
        det = gram[:, 0, 0] * gram[:, 1, 1] - np.square(gram[:, 0, 1])
        weights = (
            np.stack(
                [
                    gram[:, 1, 1] * right[:, 0] - gram[:, 0, 1] * right[:, 1],
                    gram[:, 0, 0] * right[:, 1] - gram[:, 0, 1] * right[:, 0],
                ],
                axis=1,
            )
            / np.maximum(det, np.finfo(float).tiny)[:, None]
        )
    distance = vector_lengths(offset - np.einsum("ki,kij->kj", weights, legs))
    size = np.abs(legs).max(axis=(1, 2))
    inside = (weights >= -CONTACT).all(axis=1) & (weights.sum(axis=1) <= 1 + CONTACT)
    rounding = 8 * np.finfo(float).eps * np.abs(corners).max(axis=(1, 2))
    return np.asarray(inside & (distance <= CONTACT * size + rounding))


def _cross(points: Floats, first: Ints, second: Ints) -> Bools:
    """Tell for each row whether an edge of `second` passes through the inside of `first`."""
    shared = (second[:, :, None] == first[:, None, :]).any(axis=2)
    hit = np.zeros(len(first), dtype=bool)
    for i, j in itertools.combinations(range(second.shape[1]), 2):
        rows = np.flatnonzero(~shared[:, i] & ~shared[:, j])
        facet = points[first[rows]]
        p, q = points[second[rows, i]], points[second[rows, j]]
        crossed = _separates(facet, p, q)
        if facet.shape[2] == 2:
            crossed &= _separates(np.stack([p, q], axis=1), facet[:, 0], facet[:, 1])
        else:
            sides = [
                np.einsum("ij,ij->i", q - p, np.cross(facet[:, k] - p, facet[:, k - 2] - p))
                for k in range(3)
            ]
            crossed &= (np.min(sides, axis=0) >= 0) | (np.max(sides, axis=0) <= 0)
        hit[rows] |= crossed
    return np.asarray(hit)


def _separates(facet: Floats, p: Floats, q: Floats) -> Bools:
    """Tell whether the line or plane of the facet lies strictly between `p` and `q`.

    Rounding the coordinates of a facet by eps turns its plane by eps over its height: far from a
    needle, a point of the same plane is off it by more than the contact distance.
    """
    width = facet.shape[1]
    index = np.arange(len(facet) * width, dtype=np.int32).reshape(-1, width)
    normal = facet_normals(facet.reshape(-1, facet.shape[2]), index)
    below = np.einsum("ij,ij->i", normal, p - facet[:, 0])
    above = np.einsum("ij,ij->i", normal, q - facet[:, 0])
    reach = vector_lengths(normal) * vector_lengths(q - p)
    legs = facet[:, 1:] - facet[:, :1]
    longest = vector_lengths(legs).max(axis=1)
    far = np.maximum(vector_lengths(p - facet[:, 0]), vector_lengths(q - p))
    rounding = 8 * np.finfo(float).eps * np.abs(facet).max(axis=(1, 2))
    turn = rounding * (longest if width == 3 else 1.0) * (far + longest)
    strict = np.minimum(np.abs(below), np.abs(above)) > CONTACT * reach + turn
    return np.asarray(strict & ((below < 0) != (above < 0)))
