"""The complexity of a metric: how many elements it asks for."""

from __future__ import annotations

from math import factorial

import numpy as np

from ..base.arrays import Floats, Ints
from ..base.mesh import AnyMesh, as_mesh, cell_volumes
from ..kernels.algebra import log_determinant
from ..kernels.elementary import exp
from ..tensors.checks import check_metric_on

ELEMENTS_PER_COMPLEXITY = {2: 2.309, 3: 8.49}
"""Unit simplices per unit of complexity: 1 / (sqrt(3) / 4) and 1 / (sqrt(2) / 12)."""

REAL_ELEMENTS_PER_COMPLEXITY = {2: 2.309, 3: 10.4}
"""The same of real meshes of a constant metric: perfect tetrahedra do not fill space."""

SERIES_SPREAD = 1.0
"""Largest range of exponents in a cell for which the power series is used."""

SERIES_ORDER = 12
"""With exponents within 2/3 of their mean the remainder is below .67**13 / 13! = 1e-12."""


def complexity(mesh: AnyMesh, M: Floats) -> float:
    """Complexity ``int sqrt(det M) dx`` of the log-Euclidean interpolant of `M`.

    In a cell the logarithm of the interpolated metric is linear, so ``sqrt(det M)`` is the
    exponential of a linear function and the integral over the cell is exact: d! times its
    volume times the divided difference of exp at the vertex values of ``log(det M) / 2`` [1]_.

    Parameters
    ----------
    mesh : MeshLike or other mesh object
        The mesh that carries the metric.
    M : ndarray (n, d, d)
        Metric at the points, in 1 / length**2.

    Returns
    -------
    float
        A number: a mesh of perfect unit simplices has 2.309 times as many triangles in 2D
        and 8.49 times as many tetrahedra in 3D.

    Raises
    ------
    MetricError
        If `M` is no metric on the points of `mesh`.

    References
    ----------
    .. [1] Hermite-Genocchi formula; de Boor, Divided differences, Surveys in Approximation
       Theory 1, 2005.
    """
    mesh = as_mesh(mesh)
    M = check_metric_on(mesh, M)
    return integral_of_exponential(mesh.cells, cell_volumes(mesh), 0.5 * log_determinant(M))


def integral_of_exponential(cells: Ints, volumes: Floats, exponent: Floats) -> float:
    """Exact integral of exp of the P1 function with point values `exponent` (n,)."""
    values = np.sort(exponent[cells], axis=1)
    top = values.max(initial=-np.inf)
    if not np.isfinite(top):
        return 0.0
    factor = factorial(cells.shape[1] - 1)
    return float(exp(float(top)) * factor * (volumes * exp_divided_difference(values - top)).sum())


def exp_divided_difference(nodes: Floats) -> Floats:
    """Divided difference exp[x_0, ..., x_k] for rows of `nodes` (m, k + 1), increasing."""
    if nodes.shape[1] == 1:
        return exp(nodes[:, 0])
    spread = nodes[:, -1] - nodes[:, 0]
    near = spread < SERIES_SPREAD
    result = np.empty(len(nodes))
    result[near] = _series(nodes[near])
    far = nodes[~near]
    upper = exp_divided_difference(far[:, 1:])
    lower = exp_divided_difference(far[:, :-1])
    result[~near] = (upper - lower) / spread[~near]
    return result


def _series(nodes: Floats) -> Floats:
    """Sum of h_j(x - mean) / (j + k)!, h_j the complete homogeneous polynomials."""
    mean = nodes.mean(axis=1)
    columns = list((nodes - mean[:, None]).T)
    k = len(columns) - 1
    homogeneous = [np.ones(len(nodes)) for _ in columns]  # h_j of the first 1, 2, ... nodes
    total = homogeneous[-1] / factorial(k)
    for j in range(1, SERIES_ORDER + 1):
        homogeneous[0] = homogeneous[0] * columns[0]
        for i in range(1, k + 1):
            homogeneous[i] = homogeneous[i - 1] + columns[i] * homogeneous[i]
        total += homogeneous[-1] / factorial(j + k)
    return np.asarray(exp(mean) * total)
