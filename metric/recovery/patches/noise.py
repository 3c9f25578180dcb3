"""Noise of values, what it does to Hessians, and how it is kept out of the metric."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from ...base.arrays import Floats
from ...kernels.algebra import determinant, eigh, forward_substituted, lower_factor
from ...kernels.elementary import power
from ...kernels.spectra import compose, product
from .fit import Cloud, fit_patches

ROUNDOFF = 64.0 * float(np.finfo(np.float64).eps)
"""A second difference of values of size |u| over a distance h is uncertain by 4 eps |u| / h**2;
the rest is for the sums of a fit."""

NOISE_SAMPLE = 5000
"""Vertices, evenly taken, from which the noise of a field is estimated."""

SMOOTHEST = 0.1
"""The share of the patches, those with the least residual, that are taken for smooth: what
they leave unexplained is noise, while elsewhere it may be features."""

NOISE_MARGIN = 5.0
"""Noise reaches 2.6 times its root mean square in one of some thousand Hessians, and its
standard deviation is estimated 10 % too small."""

FEATURE_MARGIN = 3.0
"""The growth of residuals with the patch is known roughly: what could be features is taken for
them. Of pure noise, little of the residual grows."""

NOISE_GAIN = 5.0
"""Norm of the Hessian, measured with the covariance of the patch, that noise of standard
deviation one hardly ever makes by two projections."""

WEAK_NOISE_GAIN = 25.0
"""The same for weak Hessians, which average less."""

P2_NOISE_GAIN = 60.0
"""The same for second derivatives in the cells of P2 functions, whose nodes are half as far
apart as the points."""


def estimated_noise(
    points: Floats, cloud: Cloud, neighbours: sparse.csr_array, level: int
) -> Floats:
    """Estimate the standard deviations (k,) of the noise of the samples of a cloud.

    A quadratic over a patch leaves noise of the values and the third differences of a smooth
    function as its residual. The residual over a larger patch tells them apart: noise stays,
    and third differences grow with the third power of the size. The smoothest patches are
    taken, where features that no quadratic can follow do not count.

    Parameters
    ----------
    points, cloud, neighbours
        As in `fit_patches`.
    level : int
        How often the smaller patches are grown.
    """
    rows = np.arange(0, len(points), max(1, len(points) // NOISE_SAMPLE))
    small, large = (
        fit_patches(
            points, cloud, neighbours, degree=2, rows=rows, levels=(size,), with_residual=True
        )
        for size in (level, level + 1)
    )
    is_known = np.isfinite(small.residual).all(axis=1) & np.isfinite(large.residual).all(axis=1)
    noise = np.zeros(cloud.values.shape[1])
    if not is_known.any():
        return noise
    sizes = [np.sqrt(determinant(fits.covariance[is_known])) for fits in (small, large)]
    growth = power(np.maximum(sizes[1] / sizes[0], 1.5), 6.0 / points.shape[1])
    before, after = np.square(small.residual[is_known]), np.square(large.residual[is_known])
    features = FEATURE_MARGIN * (after - before) / (growth[:, None] - 1.0)
    variance = np.maximum(before - np.maximum(features, 0.0), 0.0)
    for k in range(len(noise)):
        is_smooth = after[:, k] <= np.quantile(after[:, k], SMOOTHEST)
        noise[k] = np.sqrt(np.median(variance[is_smooth, k]))
    return noise


def hessian_norm(H: Floats, covariance: Floats) -> Floats:
    """Norms (n, k) of Hessians (n, k, d, d): second differences over patches.

    This is the Frobenius norm in coordinates in which the patch has the covariance one, so that
    a patch of any size and anisotropy gives the same norm to the noise of its values.
    """
    local = product(covariance[:, None], H)
    square = np.einsum("nkij,nkji->nk", local, local)
    return np.asarray(np.sqrt(np.maximum(square, 0.0)))


def without_roundoff(H: Floats, covariance: Floats, bound: Floats) -> Floats:
    """Set eigenvalues of Hessians (n, k, d, d) to zero that round-off alone can make.

    They are taken in coordinates in which the patch has the covariance one, where an eigenvalue
    is a second difference over the patch in its direction: along a layer, where the mesh is
    coarse, less curvature counts than across it. Below the bounds (n, k) it has no digit that is
    right, and would ask for a size by chance.
    """
    k, d = H.shape[1:3]
    L = np.repeat(lower_factor(covariance), k, axis=0)
    values, vectors = eigh(_seen_from(L, H.reshape(-1, d, d)))
    is_noise = np.abs(values) <= bound.reshape(-1, 1)
    rows = np.flatnonzero(is_noise.any(axis=1) & np.isfinite(values).all(axis=1))
    kept = compose(np.where(is_noise[rows], 0.0, values[rows]), vectors[rows])
    found = np.array(H).reshape(-1, d, d)
    found[rows] = _seen_from(_inverse(L[rows]), kept)
    return found.reshape(H.shape)


def _seen_from(L: Floats, T: Floats) -> Floats:
    """Return ``L^T T L``, symmetric."""
    S = product(L.transpose(0, 2, 1), product(T, L))
    return np.asarray(0.5 * (S + S.transpose(0, 2, 1)))


def _inverse(L: Floats) -> Floats:
    """Inverses of lower triangular matrices (n, d, d)."""
    identity = np.broadcast_to(np.eye(L.shape[-1]), L.shape)
    return forward_substituted(L, identity)


def damped(H: Floats, covariance: Floats, threshold: Floats) -> Floats:
    """Reduce Hessians (n, k, d, d) to what rises above the noise.

    They are multiplied by ``max(0, 1 - (threshold / norm)^2)``, which is zero below the
    threshold (n, k) and one far above it.
    """
    square = np.square(hessian_norm(H, covariance))
    bound = np.square(threshold)
    kept = 1.0 - np.divide(bound, square, out=np.ones_like(square), where=square > bound)
    return np.asarray(H * kept[:, :, None, None])
