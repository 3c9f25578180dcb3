"""Principal curvatures and directions of polygonal boundaries, curves in 2D, surfaces in 3D."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from ..base.arrays import Floats, Ints
from ..base.vectors import norms
from ..kernels.algebra import eigh
from ..kernels.elementary import angle_of, cosine
from ..kernels.spectra import product

Places = NDArray[np.intp]

SMALLEST_RATIO = 1e-10
"""Of two eigenvalues of a normal matrix; below, the fit is not determined in that direction."""


@dataclass(frozen=True, kw_only=True)
class BoundaryShape:
    """Curvatures at points of a boundary; a point on a corner or ridge has one for each side.

    Attributes
    ----------
    points : ndarray (k,)
        Indices of points.
    directions : ndarray (k, d, d - 1)
        Orthonormal principal directions, in columns.
    curvatures : ndarray (k, d - 1)
        In 1 / length, with either sign.
    """

    points: Places
    directions: Floats
    curvatures: Floats


def curve_shape(points: Floats, segments: Ints, tags: Ints, ridge_angle: float) -> BoundaryShape:
    """Curvature of polygons: that of the circle through a vertex and its two neighbours.

    Where a curve ends, branches, changes its tag or turns by more than `ridge_angle` (radians),
    each side has the direction of its segment and the curvature of the next vertex.
    """
    n = len(points)
    ends = np.concatenate([segments, segments[:, ::-1]]).astype(np.intp)
    both = np.concatenate([tags, tags])
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    ends, both = ends[order], both[order]
    start = np.searchsorted(ends[:, 0], np.arange(n))
    inner = np.flatnonzero(np.bincount(ends[:, 0], minlength=n) == 2)
    left, right = ends[start[inner], 1], ends[start[inner] + 1, 1]
    before, after = points[inner] - points[left], points[right] - points[inner]
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    turn = np.abs(angle_of(cross, np.einsum("ki,ki->k", before, after)))
    smooth = (turn <= ridge_angle) & (both[start[inner]] == both[start[inner] + 1])
    inner, cross = inner[smooth], cross[smooth]
    chord = points[right[smooth]] - points[left[smooth]]
    length = norms(chord)
    sides = norms(before[smooth]) * norms(after[smooth])
    curvature = np.zeros(n)
    curvature[inner] = 2.0 * cross / (sides * length)
    is_inner = np.zeros(n, dtype=bool)
    is_inner[inner] = True
    outer = ends[~is_inner[ends[:, 0]]]
    arm = points[outer[:, 1]] - points[outer[:, 0]]
    arm /= norms(arm)[:, None]
    return BoundaryShape(
        points=np.concatenate([inner, outer[:, 0]]),
        directions=np.concatenate([chord / length[:, None], arm])[:, :, None],
        curvatures=np.concatenate([curvature[inner], curvature[outer[:, 1]]])[:, None],
    )


def surface_shape(points: Floats, triangles: Ints, tags: Ints, ridge_angle: float) -> BoundaryShape:
    """Curvatures of a triangulated surface, by a quadric through the two rings of a vertex.

    The surface is cut into patches along ridges and changes of the tag; a vertex has one
    quadric in each patch around it. The height over the tangent plane is fitted with weighted
    least squares by ``d x + e y + (a x^2 + 2 b x y + c y^2) / 2``, and the shape operator is that
    of the fit.
    """
    patch = _patches(points, triangles, tags, ridge_angle)
    keys = triangles.astype(np.int64) * (int(patch.max(initial=0)) + 1) + patch[:, None]
    found, nodes = np.unique(keys, return_inverse=True)
    nodes = nodes.reshape(triangles.shape)
    vertex = (found // (int(patch.max(initial=0)) + 1)).astype(np.intp)
    frames = _frames(points[triangles], nodes, len(found))
    centre, other = _two_rings(nodes, len(found))
    local = np.einsum("kij,ki->kj", frames[centre], points[vertex[other]] - points[vertex[centre]])
    gradient, second = _quadrics(local, centre, len(found))
    return _principal(vertex, frames, gradient, second)


def _patches(points: Floats, triangles: Ints, tags: Ints, ridge_angle: float) -> Ints:
    """Patch (k,) of each triangle: connected across edges that are no ridges."""
    from scipy.sparse.csgraph import connected_components  # slow to import

    m = len(triangles)
    edges = np.concatenate([triangles[:, [1, 2]], triangles[:, [2, 0]], triangles[:, [0, 1]]])
    apex, owner = triangles.T.ravel(), np.tile(np.arange(m), 3)
    _, which, counts = np.unique(
        np.sort(edges, axis=1), axis=0, return_inverse=True, return_counts=True
    )
    order = np.argsort(which.ravel(), kind="stable")
    first = np.cumsum(counts) - counts
    first = first[counts == 2]
    i, j = order[first], order[first + 1]
    origin = points[edges[i, 0]]
    along = points[edges[i, 1]] - origin
    along /= norms(along)[:, None]
    arms = [points[apex[k]] - origin for k in (i, j)]
    arms = [arm - np.einsum("ki,ki->k", arm, along)[:, None] * along for arm in arms]
    turn = -np.einsum("ki,ki->k", *arms) / (norms(arms[0]) * norms(arms[1]))
    smooth = (turn >= cosine(ridge_angle)) & (tags[owner[i]] == tags[owner[j]])
    i, j = owner[i[smooth]], owner[j[smooth]]
    graph = sparse.csr_array((np.ones(len(i), dtype=np.int8), (i, j)), shape=(m, m))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int32)


def _frames(corners: Floats, nodes: Places, n_nodes: int) -> Floats:
    """Two tangents and the normal of each node (n_nodes, 3, 3), in columns.

    The normal is the main axis of the sum of ``n n^T`` over the triangles, so that they need
    no common orientation.
    """
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = norms(normal)
    outer = normal[:, :, None] * normal[:, None, :] / area[:, None, None]
    sums = np.zeros((n_nodes, 3, 3))
    for column in nodes.T:
        np.add.at(sums, column, outer)
    return eigh(sums)[1]


def _two_rings(nodes: Places, n_nodes: int) -> tuple[Places, Places]:
    """Pairs of a node and another in its two rings."""
    rows = np.concatenate([nodes[:, i] for i in (0, 1, 2) for _ in range(3)])
    columns = np.concatenate([nodes[:, j] for _ in range(3) for j in (0, 1, 2)])
    ring = sparse.csr_array(
        (np.ones(len(rows), dtype=np.int32), (rows, columns)), shape=(n_nodes, n_nodes)
    )
    pairs = (ring @ ring).tocoo()
    different = pairs.row != pairs.col
    return pairs.row[different].astype(np.intp), pairs.col[different].astype(np.intp)


def _quadrics(local: Floats, centre: Places, n_nodes: int) -> tuple[Floats, Floats]:
    """Gradients (n, 2) and second derivatives (n, 2, 2) of the fits at the nodes."""
    x, y, z = local.T
    square = x * x + y * y + z * z
    mean = np.bincount(centre, square, minlength=n_nodes) / np.maximum(
        np.bincount(centre, minlength=n_nodes), 1
    )
    h = np.sqrt(np.where(mean > 0.0, mean, 1.0))[centre]
    x, y, z = x / h, y / h, z / h
    weight = np.square(h) / square
    rows = np.stack([x, y, 0.5 * x * x, x * y, 0.5 * y * y], axis=1)
    normal = np.zeros((n_nodes, 5, 5))
    right = np.zeros((n_nodes, 5))
    for i in range(5):
        right[:, i] = np.bincount(centre, weight * rows[:, i] * z, minlength=n_nodes)
        for j in range(i + 1):
            entry = np.bincount(centre, weight * rows[:, i] * rows[:, j], minlength=n_nodes)
            normal[:, i, j] = normal[:, j, i] = entry
    # patches with fewer than five neighbours have the fit of least norm
    fit = _least_norm(normal, right)
    size = np.sqrt(np.where(mean > 0.0, mean, 1.0))
    second = np.stack([fit[:, [2, 3]], fit[:, [3, 4]]], axis=1) / size[:, None, None]
    return fit[:, :2], second


def _least_norm(A: Floats, right: Floats) -> Floats:
    """Return the solutions (n, k) of least norm of ``A x = right``, A semidefinite (n, k, k)."""
    values, vectors = eigh(A)
    kept = values > SMALLEST_RATIO * values[:, -1:]
    along = np.einsum("nij,ni->nj", vectors, right)
    along = np.divide(along, values, out=np.zeros_like(along), where=kept)
    return np.asarray(np.einsum("nij,nj->ni", vectors, along))


def _principal(vertex: Places, frames: Floats, gradient: Floats, second: Floats) -> BoundaryShape:
    """Principal curvatures and directions of the graphs over the tangent planes."""
    # the eigenvalues increase, so the normal is the last column
    tangents = frames[:, :, :2] + frames[:, :, 2:] * gradient[:, None, :]
    first = product(tangents.transpose(0, 2, 1), tangents)
    values, vectors = eigh(first)
    root = product(vectors / np.sqrt(values)[:, None, :], vectors.transpose(0, 2, 1))
    slope = np.sqrt(1.0 + np.square(gradient).sum(axis=1))[:, None, None]
    curvatures, axes = eigh(product(product(root, second), root) / slope)
    return BoundaryShape(
        points=vertex,
        directions=product(product(tangents, root), axes),
        curvatures=curvatures,
    )
