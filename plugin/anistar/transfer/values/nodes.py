"""Nodal bases on the cells: linear at the vertices, quadratic also at the middles of edges."""

from __future__ import annotations

import itertools

import numpy as np

from ...base.arrays import Floats
from ...meshes.mesh import Mesh


def n_nodes(dim: int, order: int) -> int:
    """Return the number of nodes of a cell for P1 (order 1) or P2 (order 2)."""
    return dim + 1 if order == 1 else (dim + 1) * (dim + 2) // 2


def node_order(dim: int, count: int) -> int:
    """Return the order of the basis with `count` nodes in a cell."""
    return 1 if count == dim + 1 else 2


def edge_corners(dim: int) -> list[tuple[int, int]]:
    """Return the ends of the edges of a cell, in the order of the nodes on them."""
    return list(itertools.combinations(range(dim + 1), 2))


def node_coordinates(dim: int, count: int) -> Floats:
    """Return the (count, d + 1) barycentric coordinates of the nodes of a cell."""
    corners = np.eye(dim + 1)
    if node_order(dim, count) == 1:
        return corners
    middles = [(corners[i] + corners[j]) / 2 for i, j in edge_corners(dim)]
    return np.concatenate([corners, middles])


def node_positions(mesh: Mesh, order: int = 1) -> Floats:
    """Return where the nodes of each cell lie, in the order that `Field` takes values.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    order : {1, 2}
        1 for the vertices; 2 for the vertices, then the middles of the edges (0, 1), (0, 2),
        (1, 2) of a triangle, or (0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3) of a tetrahedron.

    Returns
    -------
    (m, k, d) float64
        With k = d + 1 or (d + 1) (d + 2) / 2.

    Raises
    ------
    ValueError
        If the order is neither 1 nor 2.
    """
    if order not in (1, 2):
        raise ValueError(f"the order of the nodes must be 1 or 2, not {order!r}")
    coordinates = node_coordinates(mesh.dim, n_nodes(mesh.dim, order))
    return np.asarray(np.einsum("kj,mjd->mkd", coordinates, mesh.points[mesh.cells]))


def node_basis(barycentric: Floats, count: int) -> Floats:
    """Return the (q, count) values of the nodal basis at (q, d + 1) barycentric coordinates."""
    dim = barycentric.shape[1] - 1
    if node_order(dim, count) == 1:
        return barycentric
    corners = barycentric * (2 * barycentric - 1)
    middles = [4 * barycentric[:, i] * barycentric[:, j] for i, j in edge_corners(dim)]
    return np.asarray(np.concatenate([corners, np.stack(middles, axis=1)], axis=1))


def node_weights(dim: int, count: int) -> Floats:
    """Return the means of the nodal basis over a cell."""
    if node_order(dim, count) == 1:
        return np.full(count, 1 / (dim + 1))
    # The means of b_i^2 and b_i b_j are 2 and 1 over (d + 1) (d + 2).
    scale = (dim + 1) * (dim + 2)
    corner = 4 / scale - 1 / (dim + 1)
    return np.repeat([corner, 4 / scale], [dim + 1, count - dim - 1])
