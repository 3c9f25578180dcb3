"""Metrics for the error in one output of a computation, from fields of its adjoint."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats
from ..base.mesh import AnyMesh, as_mesh
from ..kernels.algebra import absolute, eigenvalues
from ..laws.normalisation import normalised
from ..recovery import recover_hessian
from ..tensors.checks import check_tensors


def weighted_hessian(hessians: ArrayLike, weights: ArrayLike) -> Floats:
    """Sum of absolute Hessians, each with the weight that the adjoint gives it.

    This is the tensor that takes the place of ``|H|`` in [1]_.

    Parameters
    ----------
    hessians : array_like (n, d, d) or (n, k, d, d)
        Hessians H_k of one or several fields at the points.
    weights : array_like (n,) or (n, k)
        What an error of each field at each point does to the output: the adjoint state, its
        derivatives or Hessian, as the equation has it. Absolute values are taken.

    Returns
    -------
    ndarray (n, d, d)
        ``sum_k |weights_k| |H_k|``, to be given to `normalised` with p = 1, because the error in
        the output is an integral.

    Raises
    ------
    MetricError
        If a Hessian is not finite or not symmetric.
    ValueError
        If the weights are not finite or do not fit.

    References
    ----------
    .. [1] Loseille, Dervieux, Alauzet, Fully anisotropic goal-oriented mesh adaptation for 3D
       steady Euler equations, Journal of Computational Physics 229, 2010, section 3.
    """
    stacked = np.asarray(hessians, dtype=np.float64)
    if stacked.ndim == 3:
        stacked = stacked[:, None]
    if stacked.ndim != 4:
        raise ValueError(
            f"Hessians must have shape (n, d, d) or (n, k, d, d), got {np.shape(hessians)}"
        )
    n, k, d = stacked.shape[:3]
    shares = _checked(weights, "weights")
    if shares.shape not in ((n,), (n, k)) or (shares.ndim == 1 and k != 1):
        raise ValueError(
            f"weights have shape {shares.shape}, but there are {k} Hessians at {n} points"
        )
    shares = np.abs(shares.reshape(n, k))
    total = np.zeros((n, d, d))
    for j in range(k):
        H = check_tensors(stacked[:, j], n_points=n, name=f"Hessian number {j + 1}")
        total += shares[:, j, None, None] * absolute(H)
    return total


def flux_hessian(mesh: AnyMesh, fluxes: ArrayLike, adjoint_gradient: ArrayLike) -> Floats:
    """Weighted Hessian of a conservation law: ``sum_ki |d_i z_k| |H(F_ki)|``.

    The derivation is in [1]_.

    Parameters
    ----------
    mesh : MeshLike or other mesh object
        The mesh that carries the fields.
    fluxes : array_like (n, d) or (n, k, d)
        Flux F_k of each of k equations at the points.
    adjoint_gradient : array_like, of the same shape
        Gradient of the adjoint state z_k of each equation.

    Returns
    -------
    ndarray (n, d, d)
        Tensors for `normalised` with p = 1.

    Raises
    ------
    MetricError
        If a Hessian is not finite.
    ValueError
        If an array is not finite, or the shapes do not fit.

    References
    ----------
    .. [1] Loseille, Dervieux, Alauzet, Journal of Computational Physics 229, 2010, section 3.3.
    """
    mesh = as_mesh(mesh)
    n, d = mesh.points.shape
    F, slope = _checked(fluxes, "fluxes"), _checked(adjoint_gradient, "adjoint gradient")
    if F.shape != slope.shape or F.shape[0] != n or F.shape[-1] != d or F.ndim not in (2, 3):
        raise ValueError(
            f"fluxes and adjoint gradient must both have shape ({n}, {d}) or ({n}, k, {d}), "
            f"got {F.shape} and {slope.shape}"
        )
    return weighted_hessian(recover_hessian(mesh, F.reshape(n, -1)), slope.reshape(n, -1))


def diffusion_hessian(mesh: AnyMesh, u: ArrayLike, adjoint: ArrayLike) -> Floats:
    """Weighted Hessian of a diffusion problem: ``sum_k r(H(z_k)) |H(u_k)|``.

    The error of Galerkin's method in the output is the product of the gradients of two errors,
    of the solution and of the adjoint state. Integrated by parts, the interpolation error of u
    is weighted by second derivatives of z; r is the largest of their absolute values [1]_.

    Parameters
    ----------
    mesh : MeshLike or other mesh object
        The mesh that carries the fields.
    u : array_like (n,) or (n, k)
        Solution at the points.
    adjoint : array_like, of the same shape
        Adjoint state at the points.

    Returns
    -------
    ndarray (n, d, d)
        Tensors for `normalised` with p = 1.

    Raises
    ------
    ValueError
        If an array is not finite, or the shapes do not fit.

    References
    ----------
    .. [1] Belme, Alauzet, Dervieux, An a priori anisotropic goal-oriented error estimate for
       viscous compressible flow and application to mesh adaptation, Journal of Computational
       Physics 376, 2019, section 4.
    """
    mesh = as_mesh(mesh)
    n = len(mesh.points)
    state, z = _checked(u, "solution"), _checked(adjoint, "adjoint")
    if state.shape != z.shape or state.shape[0] != n or state.ndim > 2:
        raise ValueError(
            f"solution and adjoint must both have shape ({n},) or ({n}, k), "
            f"got {state.shape} and {z.shape}"
        )
    k = state.reshape(n, -1).shape[1]
    both = recover_hessian(mesh, np.concatenate([state.reshape(n, k), z.reshape(n, k)], axis=1))
    weights = [np.abs(eigenvalues(both[:, k + j])).max(axis=1) for j in range(k)]
    return weighted_hessian(both[:, :k], np.stack(weights, axis=1))


def weighted_hessian_metric(
    mesh: AnyMesh,
    hessians: ArrayLike,
    weights: ArrayLike,
    *,
    target_complexity: float,
    p: float = 1.0,
    h_max: float | Floats | None = None,
) -> Floats:
    """Metric of the `weighted_hessian`, normalised; see there and `normalised`."""
    mesh = as_mesh(mesh)
    H = weighted_hessian(hessians, weights)
    return normalised(mesh, H, target_complexity=target_complexity, p=p, h_max=h_max)


def goal_metric(
    mesh: AnyMesh,
    u: ArrayLike,
    adjoint: ArrayLike,
    *,
    target_complexity: float,
    p: float = 1.0,
    h_max: float | Floats | None = None,
) -> Floats:
    """Metric of the `diffusion_hessian`, normalised; see there and `normalised`."""
    mesh = as_mesh(mesh)
    H = diffusion_hessian(mesh, u, adjoint)
    return normalised(mesh, H, target_complexity=target_complexity, p=p, h_max=h_max)


def _checked(values: ArrayLike, name: str) -> Floats:
    array = np.asarray(values, dtype=np.float64)
    bad = np.flatnonzero(~np.isfinite(array.reshape(len(array), -1)).all(axis=1))
    if bad.size:
        raise ValueError(f"{name} at point {bad[0]} is not finite: {array[bad[0]]}")
    return array
