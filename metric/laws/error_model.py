"""The interpolation error that a unit mesh of a metric makes."""

from __future__ import annotations

from functools import lru_cache
from itertools import combinations

import numpy as np

from ..base.arrays import Floats
from ..base.mesh import AnyMesh, as_mesh, cell_volumes, point_volumes
from ..kernels.algebra import congruent, lower_factor
from ..kernels.elementary import power
from ..tensors.checks import check_metric, check_tensors

MEAN_SQUARE = {2: (7.0 / 1920.0, 2.0 / 1920.0), 3: (8.0 / 3360.0, 2.0 / 3360.0)}
"""Weights of (tr S)^2 and tr S^2 in the mean square error of a perfect unit simplex."""

MESHER_FACTOR = {2: 1.07, 3: 1.0}
"""Measured L2 error over that of perfect unit simplices: 1.04 to 1.14 on fine meshes in 2D.
In 3D it is not measured."""

QUADRATURE_CELLS = 30
"""Divisions of an edge of the simplex in the quadrature of Lp norms; 3 digits."""


def predicted_error(mesh: AnyMesh, M: Floats, H: Floats, *, p: float = 2.0) -> float:
    """Predict the Lp norm of the P1 interpolation error on a unit mesh of `M`.

    On a perfect unit simplex of M, averaged over its orientation, a quadratic with Hessian H
    has the mean square error ``(7 t^2 + 2 q) / 1920`` in 2D and ``(8 t^2 + 2 q) / 3360`` in 3D,
    with ``S = M^(-1/2) H M^(-1/2)``, t = tr S and q = tr S^2: the model ``c tr(M^(-1/2) |H|
    M^(-1/2))`` of [1]_ with its constant, and with the sign of H. Other norms are in the ratio
    that they have for a paraboloid. The result includes a factor measured on our own meshes.

    Parameters
    ----------
    mesh : MeshLike or other mesh object
        The mesh that carries the metric and the Hessian.
    M : ndarray (n, d, d)
        Metric at the points, in 1 / length**2.
    H : ndarray (n, d, d)
        Hessian of the field, with its signs.
    p : float
        The norm, from 1 to infinity.

    Returns
    -------
    float
        In the unit of the field times length**(d / p).

    Raises
    ------
    MetricError
        If `M` is no metric or `H` not symmetric.
    ValueError
        If `p` is below 1.

    References
    ----------
    .. [1] Loseille, Alauzet, Continuous mesh framework part I, SIAM Journal on Numerical
       Analysis 49, 2011, section 3.
    """
    mesh = as_mesh(mesh)
    n, d = mesh.points.shape
    if not p >= 1.0:
        raise ValueError(f"p must be at least 1, got {p}")
    M = check_metric(M, n_points=n, dim=d)
    H = check_tensors(H, n_points=n, dim=d, name="Hessian")
    local = local_error(M, H) * norm_ratio(p, d)
    largest = float(local.max(initial=0.0))
    if np.isinf(p) or largest == 0.0:
        return largest
    mass = point_volumes(mesh, cell_volumes(mesh))
    return largest * power(float((mass * power(local / largest, p)).sum()), 1.0 / p)


def local_error(M: Floats, H: Floats) -> Floats:
    """Root of the mean square error (n,) on unit simplices of checked `M`."""
    d = M.shape[-1]
    S = congruent(lower_factor(M), H)
    trace = np.trace(S, axis1=1, axis2=2)
    square = np.einsum("nij,nij->n", S, S)
    of_trace, of_square = MEAN_SQUARE[d]
    return np.asarray(MESHER_FACTOR[d] * np.sqrt(of_trace * np.square(trace) + of_square * square))


@lru_cache(maxsize=16)
def norm_ratio(p: float, d: int) -> float:
    """Lp mean over L2 mean of the error of a paraboloid on a regular simplex.

    The error is proportional to ``sum_{i<j} b_i b_j`` in barycentric coordinates b.
    """
    if np.isinf(p):
        return float(_shape(np.full((1, d + 1), 1.0 / (d + 1)))[0]) / _power_mean(2.0, d)
    return _power_mean(p, d) / _power_mean(2.0, d)


def _power_mean(p: float, d: int) -> float:
    cells = (np.arange(QUADRATURE_CELLS) + 0.5) / QUADRATURE_CELLS
    grids = np.stack(np.meshgrid(*[cells] * d, indexing="ij"), axis=-1).reshape(-1, d)
    sorted_ = np.sort(grids, axis=1)  # order statistics are uniform on the simplex
    ends = np.zeros((len(grids), 1)), np.ones((len(grids), 1))
    barycentric = np.diff(np.concatenate([ends[0], sorted_, ends[1]], axis=1), axis=1)
    shape = _shape(barycentric)
    largest = float(shape.max())  # a large power of it would vanish
    return largest * power(float(np.mean(power(shape / largest, p))), 1.0 / p)


def _shape(barycentric: Floats) -> Floats:
    pairs = combinations(range(barycentric.shape[1]), 2)
    return np.asarray(sum(barycentric[:, i] * barycentric[:, j] for i, j in pairs))
