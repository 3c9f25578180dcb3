"""Distortion: how much the metrics at the two ends of an edge disagree."""

from __future__ import annotations

import numpy as np

from ..base.arrays import Floats
from ..base.mesh import AnyMesh, as_mesh
from ..kernels.algebra import congruent, eigenvalues, lower_factor
from ..kernels.elementary import log
from ..kernels.graph import mesh_edges
from ..tensors.checks import check_metric_on

CANCELLED = 1e-10
"""An eigenvalue below this fraction of the largest is round-off for the most part."""


def distortion(mesh: AnyMesh, M: Floats) -> Floats:
    """Logarithm of the distortion of `M` over one unit of metric length, for each edge.

    The distortion of two metrics is the largest ratio by which they see the length of one
    vector differently [1]_, ``gamma = max(|F_M^-1 F_N|, |F_N^-1 F_M|)``. ``ln gamma`` of an edge is
    divided by its length in the metric, so that the value does not depend on the mesh that
    carries the metric: on a unit mesh it is what neighbouring stars have to agree about.

    Parameters
    ----------
    mesh : MeshLike or other mesh object
        The mesh that carries the metric.
    M : ndarray (n, d, d)
        Metric at the points, in 1 / length**2.

    Returns
    -------
    ndarray (e,)
        One value per edge of `anistar.metric.mesh_edges(mesh)`.

    Raises
    ------
    MetricError
        If `M` is no metric on the points of `mesh`.

    References
    ----------
    .. [1] Boissonnat, Wormser, Yvinec, Anisotropic Delaunay mesh generation, SIAM Journal on
       Computing 44, 2015, section 2.
    """
    mesh = as_mesh(mesh)
    M = check_metric_on(mesh, M)
    p, q = mesh_edges(mesh).T
    ratio = eigenvalues(congruent(lower_factor(M[p]), M[q]))
    least, most = ratio[:, 0], ratio[:, -1]
    lost = np.flatnonzero(least < CANCELLED * most)  # the other way round it is the largest
    least[lost] = 1.0 / eigenvalues(congruent(lower_factor(M[q[lost]]), M[p[lost]]))[:, -1]
    gamma = 0.5 * np.maximum(log(most), -log(least))
    return np.asarray(gamma / edge_lengths(mesh.points[q] - mesh.points[p], M[p], M[q]))


def edge_lengths(v: Floats, start: Floats, end: Floats) -> Floats:
    """Metric lengths (e,) of edges `v` with the metrics at their ends, for a geometric law.

    ``(a - b) / ln(a / b)``, a and b the lengths in the two metrics.
    """
    a = np.sqrt(np.einsum("ei,eij,ej->e", v, start, v))
    b = np.sqrt(np.einsum("ei,eij,ej->e", v, end, v))
    ratio = log(a / b)
    near = np.abs(ratio) < 1e-6
    return np.asarray(np.where(near, 0.5 * (a + b), (a - b) / np.where(near, 1.0, ratio)))
