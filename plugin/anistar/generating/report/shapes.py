"""The shapes of the cells of a first mesh: dihedral angles and radius-edge ratios."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...base.arrays import Floats
from ...base.report import attributes
from ...meshes.mesh import Mesh
from ...meshes.topology import cell_determinants, vector_lengths

#: Bounds of the classes of angles, in degrees.
ANGLE_BINS = (0.0, 1.0, 5.0, 10.0, 15.0, 20.0, 30.0, 40.0, 60.0, 180.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class CellShapes:
    """The shapes of cells.

    Attributes
    ----------
    angle_min : float
        Least dihedral angle, in 2D least angle, in degrees.
    angle_histogram : dict of str to int
        Cells by their least angle, in classes of degrees.
    radius_edge_max, radius_edge_p99 : float
        Ratio of circumradius and shortest edge: the largest, and that of which 1 % are above.
    """

    angle_min: float
    angle_histogram: dict[str, int]
    radius_edge_max: float
    radius_edge_p99: float

    @classmethod
    def of(cls, mesh: Mesh) -> CellShapes:
        """Return the shapes of the cells of a mesh."""
        angles, ratios = least_angles(mesh), radius_edge_ratios(mesh)
        counts, _ = np.histogram(angles, bins=ANGLE_BINS)
        names = [f"{low:g}-{high:g}" for low, high in itertools.pairwise(ANGLE_BINS)]
        return cls(
            angle_min=float(angles.min()),
            angle_histogram={name: int(n) for name, n in zip(names, counts, strict=True)},
            radius_edge_max=float(ratios.max()),
            radius_edge_p99=float(np.quantile(ratios, 0.99)),
        )

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only; the keys are those of the attributes."""
        return attributes(self)


def least_angles(mesh: Mesh) -> Floats:
    """Return the (m,) least dihedral angle of each tetrahedron, or angle of each triangle.

    In degrees, and for people to read: rounded to 1e-6, as the last bits depend on the machine.
    """
    corners = mesh.points[mesh.cells]
    largest = np.full(mesh.n_cells, -1.0)  # cosine
    if mesh.dim == 2:
        for i in range(3):
            u, v = (corners[:, (i + k) % 3] - corners[:, i] for k in (1, 2))
            largest = np.maximum(largest, _cosines(u, v))
    else:
        for i, j in itertools.combinations(range(4), 2):
            k, other = sorted({0, 1, 2, 3} - {i, j})
            edge = corners[:, j] - corners[:, i]
            u, v = (np.cross(edge, corners[:, end] - corners[:, i]) for end in (k, other))
            largest = np.maximum(largest, _cosines(u, v))
    return np.asarray(np.round(np.degrees(np.arccos(np.clip(largest, -1.0, 1.0))), 6))


def radius_edge_ratios(mesh: Mesh) -> Floats:
    """Return the (m,) ratio of the circumradius and the shortest edge of each cell."""
    corners = mesh.points[mesh.cells]
    shortest = np.full(mesh.n_cells, np.inf)
    for i, j in itertools.combinations(range(mesh.dim + 1), 2):
        shortest = np.minimum(shortest, vector_lengths(corners[:, j] - corners[:, i]))
    legs = corners[:, 1:] - corners[:, :1]
    squares = np.einsum("nij,nij->ni", legs, legs)
    det = np.abs(cell_determinants(mesh.points, mesh.cells))
    if mesh.dim == 2:
        third = corners[:, 2] - corners[:, 1]
        product = np.sqrt(squares).prod(axis=1) * vector_lengths(third)
        return np.asarray(product / (2.0 * det) / shortest)
    u, v, w = legs.transpose(1, 0, 2)
    a, b, c = squares.T
    centre = a[:, None] * np.cross(v, w) + b[:, None] * np.cross(w, u) + c[:, None] * np.cross(u, v)
    return np.asarray(vector_lengths(centre) / (2.0 * det) / shortest)


def _cosines(u: Floats, v: Floats) -> Floats:
    return np.asarray(np.einsum("ni,ni->n", u, v) / (vector_lengths(u) * vector_lengths(v)))
