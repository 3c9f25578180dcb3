"""What a mesh of a metric will have, before it is made: vertices, elements, memory."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from ..base.arrays import Floats, Ints
from ..base.mesh import AnyMesh, MeshLike, as_mesh, cell_volumes, point_volumes
from ..kernels.algebra import determinant
from ..kernels.graph import mesh_edges
from ..tensors.checks import check_metric_on
from .complexity import REAL_ELEMENTS_PER_COMPLEXITY, complexity
from .distortion import distortion, edge_lengths

ELEMENTS_PER_DISTORTION = {2: 0.175, 3: 0.2}
"""Share of elements that a mean distortion of 1 adds, measured: edges that look unit from one
end and not from the other are cut."""

VERTICES_PER_COMPLEXITY = 2.2
"""In 3D, where the ratio of tetrahedra to vertices is not fixed by Euler's formula: 1.8 to 3.5
were measured, the more the larger the share of the surface."""

BYTES_PER_VERTEX = {2: 400, 3: 2000}
"""Peak memory of `remesh`; 280 to 350 measured in 2D, not measured in 3D."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Estimate:
    """The expected size of a mesh.

    Attributes
    ----------
    vertices, elements : float
        Expected numbers, for graded metrics and from 1000 elements on: elements within 3 % in
        2D and 10 % in 3D.
    memory : float
        Peak memory of `remesh`, in bytes.
    """

    vertices: float
    elements: float
    memory: float

    def as_dict(self) -> dict[str, Any]:
        """Return the estimate in JSON builtins."""
        return asdict(self)


def estimate(mesh: AnyMesh, M: Floats) -> Estimate:
    """Estimate the mesh that `remesh` will make of a metric, without making it.

    A mesh of perfect unit simplices has 2.309 C triangles or 8.49 C tetrahedra, C the
    complexity. Real tetrahedra are 10.4 C, and the mean distortion over the unit mesh adds some.
    The vertices follow from Euler's formula and the metric length of the boundary in 2D, and are
    about 2.2 C in 3D.

    Parameters
    ----------
    mesh : MeshLike or other mesh object
        The mesh that carries the metric.
    M : ndarray (n, d, d)
        Metric at the points, in 1 / length**2.

    Returns
    -------
    Estimate

    Raises
    ------
    MetricError
        If `M` is no metric on the points of `mesh`.
    """
    mesh = as_mesh(mesh)
    M = check_metric_on(mesh, M)
    return estimate_with(mesh, M, distortion(mesh, M))


def estimate_with(mesh: MeshLike, M: Floats, distortions: Floats) -> Estimate:
    """Estimate the mesh of a checked metric whose distortion is known, see `estimate`."""
    n, d = mesh.points.shape
    C = complexity(mesh, M)
    elements = C * elements_per_complexity(mesh, M, distortions)
    vertices = VERTICES_PER_COMPLEXITY * C
    if d == 2:
        p, q = _boundary(mesh.cells).T
        boundary = edge_lengths(mesh.points[q] - mesh.points[p], M[p], M[q]).sum()
        euler = n - 0.5 * (len(mesh.cells) + len(p))  # Euler's number of the domain
        vertices = euler + 0.5 * (elements + float(boundary))
    return Estimate(vertices=vertices, elements=elements, memory=vertices * BYTES_PER_VERTEX[d])


def elements_per_complexity(mesh: MeshLike, M: Floats, distortions: Floats | None = None) -> float:
    """Return the expected elements of a unit mesh over the complexity of a checked metric.

    `distortions` are those of the metric, where they are known.
    """
    d = mesh.points.shape[1]
    values = distortion(mesh, M) if distortions is None else distortions
    return REAL_ELEMENTS_PER_COMPLEXITY[d] * (
        1.0 + ELEMENTS_PER_DISTORTION[d] * mean_distortion(mesh, M, values)
    )


def mean_distortion(mesh: MeshLike, M: Floats, distortions: Floats) -> float:
    """Mean of the distortion over the edges, each weighted by the unit edges that it stands for."""
    edges = mesh_edges(mesh)
    density = point_volumes(mesh, cell_volumes(mesh)) * np.sqrt(determinant(M))
    share = density / np.bincount(edges.ravel(), minlength=len(density))
    return float(np.average(distortions, weights=share[edges].sum(axis=1)))


def _boundary(triangles: Ints) -> Ints:
    """Edges (k, 2) that one triangle has alone."""
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    found, counts = np.unique(edges, axis=0, return_counts=True)
    return np.asarray(found[counts == 1], dtype=np.int32)
