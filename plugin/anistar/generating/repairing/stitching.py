"""Points that are nearly one made one, and borders that nearly meet joined."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import scipy  # loads scipy.spatial when it is first used

from ...base.arrays import Floats, Ints
from .soup import Soup

#: Splitting an edge may leave parts that a point lies on: so often at most.
MOST_ROUNDS = 10


@dataclass(frozen=True)
class Stitched:
    """A soup after stitching, and what that changed."""

    soup: Soup
    merged_points: int
    dropped_triangles: int
    split_edges: int
    rounds: int


def stitched(soup: Soup, tolerance: float) -> Stitched:
    """Return triangles that share points where they nearly touched.

    Parameters
    ----------
    soup : Soup
    tolerance : float
        Points nearer than that become one, border points nearer to a border edge split it, and
        triangles less high are dropped. A length.
    """
    n_points, n_triangles = len(soup.points), len(soup.triangles)
    soup = merged(soup, tolerance)
    soup = without_flat(soup, tolerance)
    n_merged = n_points - len(soup.points)
    n_dropped = n_triangles - len(soup.triangles)
    n_split = rounds = 0
    is_split = True
    while is_split and rounds < MOST_ROUNDS:
        n_before = len(soup.triangles)
        soup = _with_split_borders(soup, tolerance)
        n_new = len(soup.triangles) - n_before
        n_split += n_new
        is_split = n_new > 0
        rounds += 1
    n_triangles = len(soup.triangles)
    soup = without_flat(soup, 0.0)
    n_dropped += n_triangles - len(soup.triangles)
    return Stitched(soup, n_merged, n_dropped, n_split, rounds)


def merged(soup: Soup, tolerance: float) -> Soup:
    """Return the soup with points within a tolerance made one, the first of them."""
    pairs = scipy.spatial.cKDTree(soup.points).query_pairs(tolerance, output_type="ndarray")
    n = len(soup.points)
    ones = np.ones(len(pairs), np.int8)
    near = scipy.sparse.coo_array((ones, (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    _, components = scipy.sparse.csgraph.connected_components(near)
    _, first, group = np.unique(components, return_index=True, return_inverse=True)
    order = np.argsort(first, kind="stable")
    place = np.empty(len(order), np.int32)
    place[order] = np.arange(len(order), dtype=np.int32)
    return soup.renumbered(soup.points[first[order]], place[group])


def without_flat(soup: Soup, tolerance: float) -> Soup:
    """Return the soup without triangles that are repeated or lower than a tolerance."""
    _, first = np.unique(np.sort(soup.triangles, axis=1), axis=0, return_index=True)
    kept = np.zeros(len(soup.triangles), bool)
    kept[first] = True
    kept &= _heights(soup.points[soup.triangles]) > tolerance
    return soup.of_parts(soup.triangles[kept], np.flatnonzero(kept))


def _heights(corners: Floats) -> Floats:
    sides = np.roll(corners, -1, axis=1) - corners
    longest = np.sqrt(np.square(sides).sum(axis=2).max(axis=1))
    doubled = np.cross(sides[:, 0], sides[:, 1])
    areas = np.sqrt(np.square(doubled).sum(axis=1))
    return np.divide(areas, longest, out=np.zeros(len(corners)), where=longest > 0)


def _with_split_borders(soup: Soup, tolerance: float) -> Soup:
    """Return the soup with an edge of each triangle split where border points lie on it."""
    corners, local = _border_sides(soup.triangles)
    starts, ends = soup.triangles[corners, local], soup.triangles[corners, (local + 1) % 3]
    border = np.unique(np.concatenate([starts, ends]))
    if len(border) == 0:
        return soup
    tree = scipy.spatial.cKDTree(soup.points[border])
    split = np.zeros(len(soup.triangles), bool)
    parts: list[tuple[int, int, int]] = []
    sources: list[int] = []
    for triangle, k, a, b in zip(corners, local, starts, ends, strict=True):
        if split[triangle]:
            continue  # its other edges come in the next round
        apex = int(soup.triangles[triangle, (k + 2) % 3])
        between = _points_between(soup.points, a, b, border, tree, tolerance)
        if between and apex not in between:
            chain = [int(a), *between, int(b)]
            parts += [(p, q, apex) for p, q in pairwise(chain)]
            sources += [int(triangle)] * (len(chain) - 1)
            split[triangle] = True
    if not parts:
        return soup
    whole = np.flatnonzero(~split)
    rows = np.concatenate([soup.triangles[whole], np.array(parts, np.int32)])
    return soup.of_parts(rows, np.concatenate([whole, np.array(sources)]))


def _border_sides(triangles: Ints) -> tuple[Ints, Ints]:
    """Return the triangle and the local number of the sides that belong to one triangle only."""
    sides = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    sides = np.sort(sides, axis=1)
    _, inverse, counts = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
    alone = np.flatnonzero(counts[inverse.ravel()] == 1)
    return (alone // 3).astype(np.int32), (alone % 3).astype(np.int32)


def _points_between(
    points: Floats, a: int, b: int, border: Ints, tree: scipy.spatial.cKDTree, tolerance: float
) -> list[int]:
    """Return the border points that lie on an edge within a tolerance, in their order."""
    along = points[b] - points[a]
    length = float(np.sqrt(np.square(along).sum()))
    if length <= 2 * tolerance:
        return []
    near = border[tree.query_ball_point(points[a] + along / 2, length / 2, return_sorted=True)]
    offset = points[near] - points[a]
    at = (offset * along).sum(axis=1) / length
    across = offset - at[:, None] * along / length
    is_on = np.sqrt(np.square(across).sum(axis=1)) <= tolerance
    is_on &= (at > tolerance) & (at < length - tolerance)
    is_on &= (near != a) & (near != b)
    found = np.flatnonzero(is_on)
    return [int(near[i]) for i in found[np.argsort(at[found], kind="stable")]]
