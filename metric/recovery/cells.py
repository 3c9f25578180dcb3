"""Geometry of the cells, derivatives of fields in them, and the facets of the boundary."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from ..mesh import MeshLike, cell_volumes, point_volumes

Array = NDArray[np.float64]
Index = NDArray[np.int32]


@dataclass(frozen=True, kw_only=True)
class CellGeometry:
    """What integrals of P1 functions over a mesh need.

    Attributes
    ----------
    points : ndarray (n, d)
    cells : ndarray (m, d + 1)
    volumes : ndarray (m,)
        Area or volume of the cells.
    slopes : ndarray (m, d, d)
        Row i is the gradient of the barycentric coordinate of corner i + 1; that of corner 0
        is minus their sum.
    mass : ndarray (n,)
        Lumped mass of the points.
    """

    points: Array
    cells: Index
    volumes: Array
    slopes: Array
    mass: Array

    @cached_property
    def integration(self) -> sparse.csc_array:
        """Matrix (n, m) of the integrals of the hat functions over the cells."""
        m, corners = self.cells.shape
        share = np.repeat(self.volumes / corners, corners)
        offsets = np.arange(0, m * corners + 1, corners)
        return sparse.csc_array((share, self.cells.ravel(), offsets), shape=(len(self.points), m))

    @cached_property
    def incidence(self) -> sparse.csr_array:
        """Matrix (n, m) with a one where a point is a corner of a cell."""
        m, corners = self.cells.shape
        offsets = np.arange(0, m * corners + 1, corners)
        ones = np.ones(m * corners, dtype=np.int32)
        matrix = sparse.csc_array((ones, self.cells.ravel(), offsets), (len(self.points), m))
        return sparse.csr_array(matrix)

    @property
    def centroids(self) -> Array:
        """Centroids (m, d) of the cells."""
        return self.points[self.cells].mean(axis=1)

    def gradients(self, columns: Array) -> Array:
        """Gradients (m, k, d) in the cells of P1 fields (n, k)."""
        return self.sloped([columns[c] for c in self.cells.T])

    def sloped(self, corner_values: list[Array]) -> Array:
        """Gradients (m, k, d) of linear functions with the values (m, k) at each corner."""
        first, *others = corner_values
        gradients = np.zeros((*first.shape, self.points.shape[1]))
        for i, values in enumerate(others):
            gradients += (values - first)[:, :, None] * self.slopes[:, i, None, :]
        return gradients

    def slope(self, corner: int) -> Array:
        """Gradient (m, d) of the barycentric coordinate of a corner."""
        return self.slopes[:, corner - 1] if corner else -self.slopes.sum(axis=1)


def cell_geometry(mesh: MeshLike) -> CellGeometry:
    """Compute the geometry of the cells of `mesh`."""
    volumes = cell_volumes(mesh)
    origin = mesh.points[mesh.cells[:, 0]]
    edges = [mesh.points[c] - origin for c in mesh.cells.T[1:]]
    slopes = np.empty((len(mesh.cells), len(edges), len(edges)))
    if len(edges) == 2:
        (a, b) = edges
        det = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        slopes[:, 0, 0], slopes[:, 0, 1] = b[:, 1] / det, -b[:, 0] / det
        slopes[:, 1, 0], slopes[:, 1, 1] = -a[:, 1] / det, a[:, 0] / det
    else:
        a, b, c = edges
        slopes[:, 0], slopes[:, 1], slopes[:, 2] = np.cross(b, c), np.cross(c, a), np.cross(a, b)
        slopes /= np.einsum("mi,mi->m", a, slopes[:, 0])[:, None, None]
    return CellGeometry(
        points=mesh.points,
        cells=mesh.cells,
        volumes=volumes,
        slopes=slopes,
        mass=point_volumes(mesh, volumes),
    )


def boundary_facets(cells: Index, n_points: int) -> Index:
    """Facets (f, d) that belong to one cell only, their points increasing."""
    corners = np.sort(cells, axis=1)
    dim = cells.shape[1] - 1
    columns = [np.concatenate(c) for c in zip(*_faces(corners), strict=True)]
    if float(n_points) ** dim >= 2.0**63:
        order = np.lexsort(columns[::-1])
        return _lonely(np.stack(columns, axis=1)[order]).astype(np.int32)
    key = columns[0].astype(np.int64)
    for column in columns[1:]:
        key = key * n_points + column
    key.sort()
    key = _lonely(key[:, None])[:, 0]
    digits = []
    for _ in range(dim):
        digits.append(key % n_points)
        key = key // n_points
    return np.stack(digits[::-1], axis=1).astype(np.int32)


def boundary_sides(geometry: CellGeometry) -> list[tuple[NDArray[np.intp], int]]:
    """Boundary facets as the cells (f,) that lie opposite to each corner."""
    n, corners = len(geometry.points), geometry.cells.shape[1]
    facets = boundary_facets(geometry.cells, n)
    on_boundary = np.zeros(n, dtype=bool)
    on_boundary[facets] = True
    known = {tuple(facet) for facet in facets.tolist()}
    sides = []
    for corner in range(corners):
        face = np.delete(geometry.cells, corner, axis=1)
        candidates = np.flatnonzero(on_boundary[face].all(axis=1))
        faces = np.sort(face[candidates], axis=1).tolist()
        found = np.array([tuple(face) in known for face in faces], dtype=bool)
        sides.append((candidates[found], corner))
    return sides


def _faces(corners: Index) -> list[tuple[Index, ...]]:
    dim = corners.shape[1] - 1
    return [tuple(corners[:, i] for i in face) for face in combinations(range(dim + 1), dim)]


def _lonely(rows: NDArray[np.int64] | Index) -> NDArray[np.int64]:
    """Rows of a sorted table that occur once."""
    same = (rows[1:] == rows[:-1]).all(axis=1)
    once = np.ones(len(rows), dtype=bool)
    once[1:] &= ~same
    once[:-1] &= ~same
    return np.asarray(rows[once])
