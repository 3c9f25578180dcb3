"""The metric that a mesh has: the one in which its own edges are one long."""

from __future__ import annotations

import math

import numpy as np

from ..base.arrays import Floats
from ..base.mesh import AnyMesh, MeshLike, as_mesh
from ..kernels.algebra import determinant, exp_metric, log_metric
from ..kernels.spectra import product
from ..tensors.checks import check_result

UNIT_SIMPLEX = {
    2: np.array([[1.0, 0.0], [0.5, math.sqrt(0.75)]]),
    3: np.array(
        [[1.0, 0.0, 0.0], [0.5, math.sqrt(0.75), 0.0], [0.5, 1.0 / math.sqrt(12), math.sqrt(2 / 3)]]
    ),
}
"""Edges from one vertex of the regular simplex of edge length one, in rows."""


def implied_metric(mesh: AnyMesh) -> Floats:
    """Return the metric of which `mesh` is a unit mesh, as nearly as point values can say.

    In each simplex there is exactly one metric in which all edges have length one [1]_; at a
    point it is the log-Euclidean mean over the simplices around it.

    Parameters
    ----------
    mesh : MeshLike or other mesh object
        The mesh.

    Returns
    -------
    ndarray (n, d, d)
        Metric at the points, in 1 / length**2.

    Raises
    ------
    ValueError
        If a point belongs to no cell, or a cell has no volume.

    References
    ----------
    .. [1] Loseille, Alauzet, Continuous mesh framework part I, SIAM Journal on Numerical
       Analysis 49, 2011, section 2.
    """
    mesh = as_mesh(mesh)
    n, d = mesh.points.shape
    counts = np.bincount(mesh.cells.ravel(), minlength=n)
    alone = np.flatnonzero(counts == 0)
    if alone.size:
        raise ValueError(
            f"point {alone[0]} belongs to no cell, so the mesh implies no metric there"
        )
    logs = log_metric(_cell_metrics(mesh))
    sums = np.zeros((n, d, d))
    for i in range(d):
        for j in range(i + 1):
            share = np.repeat(logs[:, i, j], d + 1)
            sums[:, i, j] = sums[:, j, i] = np.bincount(mesh.cells.ravel(), share, minlength=n)
    return check_result(exp_metric(sums / counts[:, None, None]), "the implied metric")


def _cell_metrics(mesh: MeshLike) -> Floats:
    """Metrics (m, d, d) in which all edges of a cell have length one."""
    d = mesh.points.shape[1]
    edges = mesh.points[mesh.cells[:, 1:]] - mesh.points[mesh.cells[:, :1]]
    flat = np.flatnonzero(determinant(edges) == 0.0)
    if flat.size:
        raise ValueError(f"cell {flat[0]} has no volume, so it implies no metric")
    to_unit = np.einsum("mij,jk->mik", _inverses(edges), UNIT_SIMPLEX[d])
    return product(to_unit, to_unit.transpose(0, 2, 1))


def _inverses(edges: Floats) -> Floats:
    """Inverses (m, d, d) of matrices of edges, by their cofactors."""
    if edges.shape[-1] == 2:
        (a, b), (c, e) = edges.transpose(1, 2, 0)
        cofactors = np.stack([np.stack([e, -c], axis=-1), np.stack([-b, a], axis=-1)], axis=1)
    else:
        u, v, w = edges.transpose(1, 0, 2)
        cofactors = np.stack([np.cross(v, w), np.cross(w, u), np.cross(u, v)], axis=1)
    return np.asarray(cofactors.transpose(0, 2, 1) / determinant(edges)[:, None, None])
