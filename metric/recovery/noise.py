"""Noise of values, what it does to Hessians, and how it is kept out of the metric."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from .fit import Cloud, fit_patches

Array = NDArray[np.float64]

ROUNDOFF = 64.0 * float(np.finfo(np.float64).eps)
"""A second difference of values of size |u| over a distance h is uncertain by 4 eps |u| / h**2;
the rest is for the sums of a fit."""

NOISE_SAMPLE = 20000
"""Vertices, evenly taken, from which the noise of a field is estimated."""

SMOOTHEST = 0.05
"""The share of the patches, those with the least residual, that are taken for smooth: what
they leave unexplained is noise, while elsewhere it may be features."""

NOISE_GAIN = 6.0
"""Norm of the Hessian, measured with the covariance of the patch, that noise of standard
deviation one makes in less than 1 of 100 patches of perturbed meshes, by any method but those
of the next constant."""

P2_NOISE_GAIN = 40.0
"""The same for second derivatives in the cells of P2 functions, whose nodes are half as far
apart as the points."""


def estimated_noise(points: Array, cloud: Cloud, neighbours: sparse.csr_array, level: int) -> Array:
    """Estimate the standard deviations (k,) of the noise of the samples of a cloud.

    A quadratic over a patch, grown `level` times, of noisy values of a smooth function leaves
    the noise as its residual; a low quantile over the vertices keeps features out that the
    quadratic cannot follow. Where no region of a field is smooth, third differences are taken
    for noise, which are small against the second ones on any mesh that resolves the field.
    """
    rows = np.arange(0, len(points), max(1, len(points) // NOISE_SAMPLE))
    fits = fit_patches(
        points, cloud, neighbours, degree=2, rows=rows, levels=(level,), with_residual=True
    )
    noise = np.zeros(cloud.values.shape[1])
    known = np.isfinite(fits.residual).all(axis=1) & (fits.level >= 0)
    if known.any():
        noise = np.quantile(fits.residual[known], SMOOTHEST, axis=0)
    return noise


def hessian_norm(H: Array, covariance: Array) -> Array:
    """Norms (n, k) of Hessians (n, k, d, d): second differences over patches.

    This is the Frobenius norm in coordinates in which the patch has the covariance one, so that
    a patch of any size and anisotropy gives the same norm to the noise of its values.
    """
    product = np.matmul(covariance[:, None], H)
    square = np.einsum("nkij,nkji->nk", product, product)
    return np.asarray(np.sqrt(np.maximum(square, 0.0)))


def damped(H: Array, covariance: Array, threshold: Array) -> Array:
    """Reduce Hessians (n, k, d, d) to what rises above the noise.

    They are multiplied by ``max(0, 1 - (threshold / norm)^2)``, which is zero below the
    threshold (n, k) and one far above it.
    """
    square = hessian_norm(H, covariance) ** 2
    kept = 1.0 - np.divide(
        threshold**2, square, out=np.ones_like(square), where=square > threshold**2
    )
    return np.asarray(H * kept[:, :, None, None])
