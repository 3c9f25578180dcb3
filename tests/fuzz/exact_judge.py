"""An independent judge of meshes and of tensors: NumPy where it is sure, fractions elsewhere.

It calls nothing of anistar, so that an error there cannot hide itself.
"""

from fractions import Fraction
from itertools import combinations

import numpy as np

EPSILON = np.finfo(float).eps


def mesh_problem(mesh, *, samples=15):
    """Return what is wrong with a mesh by itself, or the empty text."""
    points, cells, facets = (np.asarray(getattr(mesh, n)) for n in ("points", "cells", "facets"))
    if not np.isfinite(points).all():
        return "a coordinate is not finite"
    for rows in (cells, facets):
        if len(rows) and (rows.min() < 0 or rows.max() >= len(points)):
            return "an index is out of range"
    if len(np.unique(cells)) != len(points):
        return "a point has no cell"
    bad = np.flatnonzero(signs(points, cells) <= 0)
    if len(bad):
        return f"cell {bad[0]} and {len(bad) - 1} more are not positive, exactly"
    return _conformity(mesh, cells, facets) or _overlap(points, cells, samples)


def signs(points, cells):
    """Exact signs of the oriented measures of cells."""
    corners = points[cells]
    edges = corners[:, 1:] - corners[:, :1]
    value = _determinant(edges)
    reach = np.abs(edges).max(axis=(1, 2))
    rounding = EPSILON * np.abs(corners).max(axis=(1, 2))
    sure = np.abs(value) > 40 * reach ** (edges.shape[2] - 1) * (rounding + EPSILON * reach)
    found = np.sign(value)
    for cell in np.flatnonzero(~sure):
        found[cell] = _sign(_exact(points[k]) for k in cells[cell])
    return found


def _determinant(matrices):
    """Determinants (n,) of (n, 2, 2) or (n, 3, 3), written out."""
    if matrices.shape[1] == 2:
        return matrices[:, 0, 0] * matrices[:, 1, 1] - matrices[:, 0, 1] * matrices[:, 1, 0]
    a, b, c = matrices[:, 0], matrices[:, 1], matrices[:, 2]
    return sum(
        a[:, i] * (b[:, j] * c[:, k] - b[:, k] * c[:, j])
        for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
    )


def _exact(point):
    return [Fraction(float(x)) for x in point]


def _sign(corners):
    first, *others = corners
    rows = [[x - y for x, y in zip(corner, first, strict=True)] for corner in others]
    value = fraction_determinant(rows)
    return (value > 0) - (value < 0)


def fraction_determinant(rows):
    """The determinant of a small matrix of fractions."""
    if len(rows) == 1:
        return rows[0][0]
    return sum(
        (-1) ** k * rows[0][k] * fraction_determinant([row[:k] + row[k + 1 :] for row in rows[1:]])
        for k in range(len(rows))
    )


def _conformity(mesh, cells, facets):
    """Sides belong to one or two cells, on opposite sides of it, and are stored where they must."""
    sides, owner, parity = _sides(cells)
    keys, of_side, count = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
    if count.max() > 2:
        return "a side has more than two cells"
    turn = np.bincount(of_side.ravel(), weights=parity)
    if (np.abs(turn[count == 2]) > 0).any():
        return "two cells lie on the same side of their common side"
    stored = np.sort(facets, axis=1)
    if len(np.unique(stored, axis=0)) != len(stored):
        return "a facet is stored twice"
    known = set(map(tuple, stored.tolist()))
    if not known <= set(map(tuple, keys.tolist())):
        return "a stored facet is no side of a cell"
    tags = np.asarray(mesh.cell_tags)[owner]
    low, high = np.full(len(keys), 2**40), np.full(len(keys), -(2**40))
    np.minimum.at(low, of_side.ravel(), tags)
    np.maximum.at(high, of_side.ravel(), tags)
    needed = keys[(count == 1) | (low < high)]
    if not set(map(tuple, needed.tolist())) <= known:
        return "a side on the boundary or between regions is not stored"
    return ""


def _sides(cells):
    """Sorted sides of cells, their cells, and the parity of each with respect to its cell."""
    sides, parity = [], []
    for k in range(cells.shape[1]):
        side = np.delete(cells, k, axis=1)
        order = np.argsort(side, axis=1)
        inversions = sum(
            order[:, i] > order[:, j] for i, j in combinations(range(side.shape[1]), 2)
        )
        sides.append(np.take_along_axis(side, order, axis=1))
        parity.append((-1.0) ** (k + inversions))
    owner = np.tile(np.arange(len(cells)), cells.shape[1])
    return np.concatenate(sides), owner, np.concatenate(parity)


def _overlap(points, cells, samples):
    """Exact centres of some cells lie in no other cell."""
    corners = points[cells]
    low, high = corners.min(axis=1), corners.max(axis=1)
    d = points.shape[1]
    for cell in np.unique(np.linspace(0, len(cells) - 1, samples).astype(int)):
        centre = [sum(_exact(x)) / (d + 1) for x in corners[cell].T]
        near = np.array([float(x) for x in centre])
        around = np.flatnonzero(((low <= near) & (near <= high)).all(axis=1))
        for other in around[_maybe_inside(corners[around], near)]:
            if other != cell and _is_inside(corners[other], centre):
                return f"cells {cell} and {other} overlap"
    return ""


def _maybe_inside(corners, point):
    """Whether a point may lie in each simplex, given what rounding may hide."""
    inside = np.ones(len(corners), bool)
    for k in range(corners.shape[1]):
        moved = corners.copy()
        moved[:, k] = point
        edges = moved[:, 1:] - moved[:, :1]
        reach = np.abs(edges).max(axis=(1, 2))
        rounding = EPSILON * (np.abs(point).max() + reach)
        inside &= _determinant(edges) > -40 * reach ** (edges.shape[2] - 1) * rounding
    return inside


def _is_inside(corners, centre):
    exact = [_exact(corner) for corner in corners]
    return all(_sign([*exact[:k], centre, *exact[k + 1 :]]) > 0 for k in range(len(exact)))


def eigenvalue_ratios(M):
    """Largest over smallest eigenvalue of tensors (n, d, d); infinite where not positive definite.

    LAPACK knows the smallest eigenvalue to an error relative to the largest only: near 1e15 the
    determinant is taken in fractions.
    """
    M = np.asarray(M)
    if not np.isfinite(M).all():
        return np.where(np.isfinite(M).all(axis=(1, 2)), 1.0, np.inf)
    scale = np.abs(M).max(axis=(1, 2), keepdims=True)
    values = np.linalg.eigvalsh(M / np.where(scale > 0, scale, 1))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratios = values[:, -1] / values[:, 0]
    doubtful = np.flatnonzero(~((ratios > 0) & (ratios < 1e9)))
    for point in doubtful:
        ratios[point] = _exact_ratio(M[point])
    return ratios


def _exact_ratio(tensor):
    rows = [_exact(row) for row in tensor]
    minors = [fraction_determinant([row[:k] for row in rows[:k]]) for k in range(1, len(rows) + 1)]
    if min(minors) <= 0:  # Sylvester's criterion
        return np.inf
    d = len(rows)
    cofactors = [
        [
            (-1) ** (i + j)
            * fraction_determinant(
                [[rows[a][b] for b in range(d) if b != j] for a in range(d) if a != i]
            )
            for j in range(d)
        ]
        for i in range(d)
    ]
    inverse = np.array([[float(x / minors[-1] * minors[0]) for x in row] for row in cofactors])
    forward = np.array([[float(x / minors[0]) for x in row] for row in rows])
    return float(np.linalg.eigvalsh(inverse)[-1] * np.linalg.eigvalsh(forward)[-1])
