"""The points of a DMPlex as arrays: one row of vertices for each cell, facet or edge.

A DMPlex numbers its cells, vertices, facets and edges as points of one graph, and stores for each
its cone, the points of one dimension less on its boundary.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...base.arrays import AnyArray, Longs
from ...meshes.topology import RowKeys
from .library import cones


@dataclass(frozen=True, eq=False)
class Strata:
    """Vertices of every point of a serial DMPlex, by dimension.

    Attributes
    ----------
    starts : (d + 1,) int64
        First point of each dimension.
    vertices : tuple of (n_k, k + 1) int64
        For each dimension k, the vertices of its points in increasing order, counted from 0.
    """

    starts: Longs
    vertices: tuple[Longs, ...]

    @property
    def dim(self) -> int:
        """Dimension of the cells."""
        return len(self.vertices) - 1

    def find(self, simplices: AnyArray) -> Longs:
        """Return the row of each simplex among those of its dimension, -1 where there is none."""
        table = self.vertices[simplices.shape[1] - 1]
        encoder = RowKeys(table, len(self.vertices[0]))
        keys, wanted = encoder.encode(table), encoder.encode(simplices)
        if len(keys) == 0:
            return np.full(len(wanted), -1)
        order = np.argsort(keys, kind="stable")
        found = order[np.searchsorted(keys[order], wanted).clip(max=len(keys) - 1)]
        return np.where(keys[found] == wanted, found, -1)

    def faces(self, simplices: Longs, dim: int) -> Longs:
        """Return the rows of all faces of one dimension that the simplices have."""
        columns = list(itertools.combinations(range(simplices.shape[1]), dim + 1))
        return np.unique(self.find(simplices[:, columns].reshape(-1, dim + 1)))


def strata(plex: Any) -> Strata:
    """Return the vertices of the cells, facets and edges of an interpolated simplicial DMPlex.

    Raises
    ------
    TypeError
        If there are points other than simplices.
    ValueError
        If the DMPlex has no facets (it is not interpolated).
    """
    dim, depth = plex.getDimension(), plex.getDepth()
    if depth != dim:
        raise ValueError(
            f"the DMPlex has depth {depth} in dimension {dim}: call its interpolate() first"
        )
    ranges = np.array([plex.getDepthStratum(k) for k in range(dim + 1)], dtype=np.int64)
    for k in range(2, dim + 1):
        _refuse_other_than_simplices(plex, k, ranges[k])
    sizes = np.arange(dim + 1) + 1
    sizes[0] = 0
    counts = ranges[:, 1] - ranges[:, 0]
    all_cones = cones(plex, int((counts * sizes).sum()))
    rows = [np.arange(counts[0], dtype=np.int64)[:, None]]
    begin = _cone_offsets(ranges, sizes)
    for k in range(1, dim + 1):
        size = sizes[k]
        cone = all_cones[begin[k] : begin[k] + counts[k] * size].reshape(-1, size)
        rows.append(_distinct(rows[k - 1][cone - ranges[k - 1, 0]].reshape(counts[k], -1), k + 1))
    return Strata(ranges[:, 0], tuple(rows))


def _refuse_other_than_simplices(plex: Any, dim: int, span: Longs) -> None:
    simplex = {2: 3, 3: 6}[dim]  # DM_POLYTOPE_TRIANGLE, DM_POLYTOPE_TETRAHEDRON
    if plex.getStratumSize("celltype", simplex) != span[1] - span[0]:
        kind = {2: "triangles", 3: "tetrahedra"}[dim]
        raise TypeError(f"the DMPlex has {dim}-dimensional points other than {kind}")


def _cone_offsets(ranges: Longs, sizes: Longs) -> Longs:
    """Return where the cones of each dimension begin; points are numbered stratum by stratum."""
    order = np.argsort(ranges[:, 0], kind="stable")
    lengths = ((ranges[:, 1] - ranges[:, 0]) * sizes)[order]
    begin = np.empty(len(order), np.int64)
    begin[order] = np.cumsum(lengths) - lengths
    return begin


def _distinct(repeated: Longs, count: int) -> Longs:
    """Return the distinct vertices of each row, each of which occurs equally often."""
    return np.sort(repeated, axis=1)[:, :: repeated.shape[1] // count]
