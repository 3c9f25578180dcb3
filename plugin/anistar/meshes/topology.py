"""Pure functions from cells to facets, edges, neighbours and measures.

A facet is a simplex of one dimension less than the cells: an edge in 2D, a triangle in 3D. Local
facet ``i`` of a cell lies opposite its vertex ``i``, and is ordered so that its normal points out
of a positively oriented cell (2D: the cell lies on the left of ``a -> b``).
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np

from ..base.arrays import Floats, Ints, Longs

LOCAL_FACETS = {
    2: np.array([[1, 2], [2, 0], [0, 1]]),
    3: np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]),
}


class RowKeys:
    """Encode rows of point indices as one integer each, whatever the order in the row.

    Three indices fit in 63 bits up to 2**21 points; beyond that the first two are replaced by
    their rank among the pairs that occur, so keys are only comparable within one instance.

    Parameters
    ----------
    rows : (k, w) int array
        The rows whose keys must be distinct; `w` is 1, 2 or 3.
    n_points : int
        Number of points, the bound of the indices.
    """

    def __init__(self, rows: Ints, n_points: int) -> None:
        self._n = max(n_points, 1)
        self._pairs: Longs | None = None
        if rows.shape[1] == 3 and self._n * self._n * self._n >= 2**63:
            self._pairs = _distinct(_horner(np.sort(rows, axis=1)[:, :2], self._n))

    def encode(self, rows: Ints) -> Longs:
        """Return the keys of `rows`; -1 where the row cannot be one of the known rows."""
        ordered = np.sort(rows, axis=1)
        if self._pairs is None:
            return _horner(ordered, self._n)
        pair = _horner(ordered[:, :2], self._n)
        rank = np.searchsorted(self._pairs, pair).clip(max=len(self._pairs) - 1)
        return np.where(self._pairs[rank] == pair, rank * self._n + ordered[:, 2], -1)


def _horner(ordered: Ints, base: int) -> Longs:
    key = ordered[:, 0].astype(np.int64)
    for column in range(1, ordered.shape[1]):
        key *= base
        key += ordered[:, column]
    return key


@dataclass(frozen=True, eq=False)
class FacetTable:
    """Every facet of a set of cells, once, with the cells on its two sides.

    Attributes
    ----------
    facets : (f, d) int32
        Facets, oriented out of their first cell.
    cells : (f, 2) int32
        First and second cell; -1 where there is no second cell.
    local : (f, 2) int32
        Local index of the facet in those cells; -1 where there is no second cell.
    counts : (f,) int64
        How many cells have the facet; more than two means that cells overlap.
    """

    facets: Ints
    cells: Ints
    local: Ints
    counts: Longs
    _keys: Longs
    _encoder: RowKeys

    def find(self, facets: Ints) -> Longs:
        """Return the row of each given facet in the table, -1 where it is not a facet."""
        keys = self._encoder.encode(facets)
        if len(self._keys) == 0:
            return np.full(len(facets), -1, dtype=np.int64)
        row = np.searchsorted(self._keys, keys).clip(max=len(self._keys) - 1)
        return np.where(self._keys[row] == keys, row, -1)


def facets_of_cells(cells: Ints) -> Ints:
    """Return the facets of each cell, outward, cell by cell.

    Parameters
    ----------
    cells : (m, d + 1) int32
        Positively oriented simplices.

    Returns
    -------
    (m * (d + 1), d) int32
        Row ``(d + 1) * c + i`` is the facet of cell `c` opposite its vertex `i`.
    """
    dim = cells.shape[1] - 1
    return np.take(cells, LOCAL_FACETS[dim], axis=1).reshape(-1, dim)


def facet_table(cells: Ints, n_points: int) -> FacetTable:
    """Return every facet of the cells once, sorted by key.

    Parameters
    ----------
    cells : (m, d + 1) int32
        Positively oriented simplices.
    n_points : int
        Number of points.
    """
    # the rows are several times as large as the cells: they are not kept while keys are sorted
    width = np.int32(cells.shape[1])
    rows = facets_of_cells(cells)
    encoder = RowKeys(rows, n_points)
    keys = encoder.encode(rows)
    del rows
    order = np.argsort(keys, kind="stable").astype(np.int32)
    keys = keys[order]
    starts = np.flatnonzero(np.r_[True, keys[1:] != keys[:-1]][: len(keys)])
    counts = np.diff(np.r_[starts, len(keys)])
    keys = keys[starts]
    sides = np.full((len(starts), 2), -1, dtype=np.int32)
    sides[:, 0] = order[starts]
    shared = counts > 1
    sides[shared, 1] = order[starts[shared] + 1]
    outside = sides < 0
    return FacetTable(
        facets=facets_of_cells(cells)[sides[:, 0]],
        cells=np.where(outside, np.int32(-1), sides // width),
        local=np.where(outside, np.int32(-1), sides % width),
        counts=counts,
        _keys=keys,
        _encoder=encoder,
    )


def boundary_facets(cells: Ints, n_points: int) -> Ints:
    """Return the (k, d) facets that have one cell only, oriented outward."""
    table = facet_table(cells, n_points)
    return np.asarray(table.facets[table.counts == 1])


def neighbours(cells: Ints, n_points: int) -> Ints:
    """Return the cell across each facet.

    Returns
    -------
    (m, d + 1) int32
        Column `i` is the cell across the facet opposite vertex `i`, -1 at the boundary.
    """
    table = facet_table(cells, n_points)
    across = np.full(cells.shape, -1, dtype=np.int32)
    shared = table.counts == 2
    first, second = table.cells[shared].T
    first_local, second_local = table.local[shared].T
    across[first, first_local] = second
    across[second, second_local] = first
    return across


def _distinct(keys: Longs) -> Longs:
    """Return keys in ascending order, each once: by sorting, where NumPy hashes millions slowly."""
    ordered = np.sort(keys)
    is_first = np.ones(len(ordered), dtype=bool)
    is_first[1:] = ordered[1:] != ordered[:-1]
    return ordered[is_first]


def unique_edges(simplices: Ints, n_points: int) -> Ints:
    """Return the (e, 2) edges of the simplices, each once, smaller index first, sorted."""
    pairs = np.concatenate(
        [simplices[:, [i, j]] for i, j in itertools.combinations(range(simplices.shape[1]), 2)]
    )
    keys = _distinct(_horner(np.sort(pairs, axis=1), max(n_points, 1)))
    return np.stack(np.divmod(keys, max(n_points, 1)), axis=1).astype(np.int32)


def cell_determinants(points: Floats, cells: Ints) -> Floats:
    """Return the (m,) determinants of the edge vectors: `d!` times the signed volumes."""
    origin = points[cells[:, 0]]
    legs = [points[cells[:, i]] for i in range(1, cells.shape[1])]
    for leg in legs:
        leg -= origin
    if len(legs) == 2:
        (ax, ay), (bx, by) = legs[0].T, legs[1].T
        return np.asarray(ax * by - ay * bx)
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (leg.T for leg in legs)
    return np.asarray(
        ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    )


def cell_volumes(points: Floats, cells: Ints) -> Floats:
    """Return the (m,) signed areas (2D) or volumes (3D) of the cells."""
    return cell_determinants(points, cells) / math.factorial(points.shape[1])


def facet_normals(points: Floats, facets: Ints) -> Floats:
    """Return the (k, d) normals whose length is the facet's length (2D) or area (3D)."""
    first = points[facets[:, 1]] - points[facets[:, 0]]
    if facets.shape[1] == 2:
        return np.stack([first[:, 1], -first[:, 0]], axis=1)
    return np.asarray(0.5 * np.cross(first, points[facets[:, 2]] - points[facets[:, 0]]))


def vector_lengths(vectors: Floats) -> Floats:
    """Return the (...) lengths of (..., d) vectors."""
    return np.asarray(np.sqrt((vectors * vectors).sum(axis=-1)))


def facet_measures(points: Floats, facets: Ints) -> Floats:
    """Return the (k,) lengths (2D) or areas (3D) of the facets."""
    return vector_lengths(facet_normals(points, facets))


def edge_lengths(points: Floats, edges: Ints) -> Floats:
    """Return the (e,) lengths of the edges."""
    return vector_lengths(points[edges[:, 1]] - points[edges[:, 0]])


def measure_by_tag(measures: Floats, tags: Ints) -> dict[int, float]:
    """Return the sum of the (k,) measures for every tag that occurs."""
    values, inverse = np.unique(tags, return_inverse=True)
    sums = np.bincount(inverse.ravel(), weights=measures, minlength=len(values))
    return {int(tag): float(total) for tag, total in zip(values, sums, strict=True)}
