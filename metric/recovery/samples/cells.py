"""Geometry of the cells, derivatives of fields in them, and the facets of the boundary."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from ...base.arrays import Floats, Ints, Longs
from ...base.mesh import MeshLike, point_volumes
from ...kernels.spectra import product

BLOCK = 32768
"""Cells treated at once, so that the arrays of a block stay in the cache."""


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

    points: Floats
    cells: Ints
    volumes: Floats
    slopes: Floats
    mass: Floats

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
    def centroids(self) -> Floats:
        """Centroids (m, d) of the cells."""
        return self.points[self.cells].mean(axis=1)

    def gradients(self, columns: Floats) -> Floats:
        """Gradients (m, k, d) in the cells of P1 fields (n, k)."""
        gradients = np.empty((len(self.cells), columns.shape[1], self.points.shape[1]))
        for start in range(0, len(self.cells), BLOCK):
            part = slice(start, start + BLOCK)
            values = columns[self.cells[part]]
            rise = values[:, 1:] - values[:, :1]
            gradients[part] = product(rise.transpose(0, 2, 1), self.slopes[part])
        return gradients

    def slope(self, corner: int) -> Floats:
        """Gradient (m, d) of the barycentric coordinate of a corner."""
        return self.slopes[:, corner - 1] if corner else -self.slopes.sum(axis=1)


def cell_geometry(mesh: MeshLike) -> CellGeometry:
    """Compute the geometry of the cells of `mesh`."""
    m, d = len(mesh.cells), mesh.points.shape[1]
    volumes, slopes = np.empty(m), np.empty((m, d, d))
    for start in range(0, m, BLOCK):
        part = slice(start, start + BLOCK)
        volumes[part], slopes[part] = _slopes(mesh.points[mesh.cells[part]])
    return CellGeometry(
        points=mesh.points,
        cells=mesh.cells,
        volumes=volumes,
        slopes=slopes,
        mass=point_volumes(mesh, volumes),
    )


def _slopes(corners: Floats) -> tuple[Floats, Floats]:
    """Volumes and gradients of the barycentric coordinates of cells (m, d + 1, d)."""
    edges = (corners[:, 1:] - corners[:, :1]).transpose(1, 2, 0).copy()
    d = len(edges)
    slopes = np.empty_like(edges)
    if d == 2:
        (ax, ay), (bx, by) = edges
        slopes[0], slopes[1] = (by, -bx), (-ay, ax)
    else:
        for i in range(d):
            (ax, ay, az), (bx, by, bz) = edges[i - 2], edges[i - 1]
            slopes[i] = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    det = (edges[0] * slopes[0]).sum(axis=0)
    slopes /= det
    return np.abs(det) / (2.0 if d == 2 else 6.0), slopes.transpose(2, 0, 1)


def boundary_facets(cells: Ints, n_points: int) -> Ints:
    """Facets (f, d) that belong to one cell only, their points increasing."""
    dim, faces = cells.shape[1] - 1, _faces(_sorted_corners(cells))
    if int(n_points) ** dim >= 2**63:
        table = np.concatenate([np.stack(face, axis=1) for face in faces])
        order = np.lexsort(table.T[::-1])
        return _lonely(table[order]).astype(np.int32)
    # one number for each facet, made in place: the tables of all facets are what costs here
    keys = np.empty((len(faces), len(cells)), dtype=np.int64)
    for key, face in zip(keys, faces, strict=True):
        key[:] = face[0]
        for column in face[1:]:
            key *= n_points
            key += column
    flat = keys.reshape(-1)
    flat.sort()
    same = flat[1:] == flat[:-1]
    once = np.ones(len(flat), dtype=bool)
    once[1:] &= ~same
    once[:-1] &= ~same
    key = flat[once]
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


def _sorted_corners(cells: Ints) -> list[Ints]:
    """Corners of the cells in increasing order, as columns: bubble sort of three or four."""
    columns = [column.copy() for column in cells.T]
    for last in range(len(columns) - 1, 0, -1):
        for i in range(last):
            low = np.minimum(columns[i], columns[i + 1])
            columns[i + 1] = np.maximum(columns[i], columns[i + 1])
            columns[i] = low
    return columns


def _faces(corners: list[Ints]) -> list[tuple[Ints, ...]]:
    dim = len(corners) - 1
    return [tuple(corners[i] for i in face) for face in combinations(range(dim + 1), dim)]


def _lonely(rows: Longs | Ints) -> Longs:
    """Rows of a sorted table that occur once."""
    same = (rows[1:] == rows[:-1]).all(axis=1)
    once = np.ones(len(rows), dtype=bool)
    once[1:] &= ~same
    once[:-1] &= ~same
    return np.asarray(rows[once])
