"""The graph of the vertices of a mesh: edges, and the vertices across each facet."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy import sparse

from ..base.arrays import Ints
from ..base.mesh import AnyMesh, MeshLike, as_mesh


@dataclass(frozen=True, kw_only=True)
class VertexGraph:
    """Neighbours of each vertex, increasing, without the vertex itself.

    Attributes
    ----------
    offsets : ndarray (n + 1,) of int32
        The neighbours of v are ``neighbours[offsets[v]:offsets[v + 1]]``.
    neighbours : ndarray (k,) of int32
        Indices of points.
    """

    offsets: Ints
    neighbours: Ints

    @property
    def n_points(self) -> int:
        """Number of vertices."""
        return len(self.offsets) - 1

    @property
    def sources(self) -> Ints:
        """The vertex (k,) that each entry of `neighbours` belongs to."""
        counts = np.diff(self.offsets)
        return np.repeat(np.arange(self.n_points, dtype=np.int32), counts)

    def matrix(self) -> sparse.csr_array:
        """Return the adjacency matrix, with ones."""
        data = np.ones(len(self.neighbours), dtype=np.int32)
        return sparse.csr_array(
            (data, self.neighbours, self.offsets), shape=(self.n_points, self.n_points)
        )


def mesh_edges(mesh: AnyMesh) -> Ints:
    """Every edge of the mesh once, (e, 2), smaller index first, sorted."""
    mesh = as_mesh(mesh)
    graph = edge_graph(mesh)
    sources = graph.sources
    upper = sources < graph.neighbours
    return np.stack([sources[upper], graph.neighbours[upper]], axis=1)


def edge_graph(mesh: MeshLike) -> VertexGraph:
    """Return the graph of the mesh edges."""
    return pair_graph(len(mesh.points), mesh.cells)


def pair_graph(n_points: int, cells: Ints) -> VertexGraph:
    """Return the graph of the edges of some cells among `n_points` points."""
    return _graph(n_points, _edge_pairs(cells))


def wide_graph(mesh: MeshLike) -> VertexGraph:
    """Join the mesh edges and, across each inner facet, the pair of opposite vertices.

    On a regular grid the edges alone know the distances along a few directions only; the
    opposite vertices about double the number of directions.
    """
    pairs = [_edge_pairs(mesh.cells), _opposite_pairs(mesh.cells, len(mesh.points))]
    return _graph(len(mesh.points), np.concatenate(pairs))


def _edge_pairs(cells: Ints) -> Ints:
    return np.concatenate([cells[:, list(ij)] for ij in combinations(range(cells.shape[1]), 2)])


def _opposite_pairs(cells: Ints, n_points: int) -> Ints:
    corners = range(cells.shape[1])
    facets = np.concatenate([np.delete(cells, i, axis=1) for i in corners])
    apex = np.concatenate([cells[:, i] for i in corners])
    facets.sort(axis=1)
    if int(n_points) ** facets.shape[1] < 2**63:
        key = facets[:, 0].astype(np.int64)
        for column in facets.T[1:]:
            key = key * n_points + column
        order = np.argsort(key, kind="stable")
        same = key[order[1:]] == key[order[:-1]]
    else:
        order = np.lexsort(facets.T[::-1])
        same = (facets[order[1:]] == facets[order[:-1]]).all(axis=1)
    first = np.flatnonzero(same)
    return np.stack([apex[order[first]], apex[order[first + 1]]], axis=1)


def _graph(n_points: int, pairs: Ints) -> VertexGraph:
    rows = np.concatenate([pairs[:, 0], pairs[:, 1]])
    columns = np.concatenate([pairs[:, 1], pairs[:, 0]])
    data = np.ones(len(rows), dtype=np.int8)
    matrix = sparse.csr_array((data, (rows, columns)), shape=(n_points, n_points))
    matrix.sum_duplicates()
    return VertexGraph(
        offsets=matrix.indptr.astype(np.int32), neighbours=matrix.indices.astype(np.int32)
    )
