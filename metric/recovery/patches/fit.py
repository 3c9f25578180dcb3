"""Polynomials fitted over patches of samples around vertices, many at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from itertools import combinations_with_replacement

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from ...base.arrays import AnyArray, Bools, Floats, Ints
from ...kernels.algebra import eigh
from ...kernels.spectra import product
from .least_squares import Equations, factored, gain, residual, solved

Rows = NDArray[np.intp]

PATCH_LEVELS = 4
"""A patch is grown by the neighbours of its points up to this many times less one."""

TRUSTED_LEVELS = 2
"""The same where there is another method to turn to. Where patches lie on few lines, as in
needles from one wall to the other, growing ends in features that no quadratic can follow, and
finds second derivatives where there are none."""

SMALLEST_PIVOT = 1e-3
"""A pivot of the scaled normal matrix is the squared sine of the angle between a basis
function and the span of the previous ones over the patch. Regular patches, one-sided ones
of two layers included, stay above 1e-2; patches that lie on a conic fall to round-off."""

FLATTEST_PATCH = 1e-12
"""Smallest ratio of the extents squared of a patch; below, its points are on a line."""

BLOCK = 4096
"""Vertices fitted at once, so that the arrays of a block stay in the cache; half of it
for each level but the first that a patch was grown."""


@dataclass(frozen=True, kw_only=True)
class Cloud:
    """Samples of k functions, and which of them each vertex looks at first.

    Attributes
    ----------
    positions : ndarray (s, d)
        Where the samples are: points, or centroids of cells.
    values : ndarray (s, k)
        Values there, or means over the cells.
    first : csr_array (n, s)
        The patch of each of the n vertices before it is grown, as nonzero entries.
    spread : ndarray (s, d, d), optional
        For means over cells: the mean of ``(x - c) (x - c)^T`` over the cell.
    weights : ndarray (s,), optional
        Weights of the equations; by the distance to the vertex if None.
    at_vertices : ndarray (n, k), optional
        Values at the vertices; the fits then pass through them.
    """

    positions: Floats
    values: Floats
    first: sparse.csr_array
    spread: Floats | None = None
    weights: Floats | None = None
    at_vertices: Floats | None = None


@dataclass(frozen=True, kw_only=True)
class Fits:
    """Polynomials fitted around r vertices.

    Attributes
    ----------
    value : ndarray (r, k)
    gradient : ndarray (r, k, d)
    hessian : ndarray (r, k, d, d)
        Of the fitted polynomial at the vertex; zero where there is no fit.
    pivot : ndarray (r,)
        The smallest pivot of the patch that was taken, 0 where there is no fit.
    level : ndarray (r,) of int8
        How often the patch was grown, -1 where there is no fit.
    covariance : ndarray (r, d, d)
        Of the positions of the samples, seen from the vertex, in length**2.
    gain : ndarray (r,)
        Root mean square of the norm of the Hessian, measured with the covariance, that noise
        of standard deviation one makes; zero if it was not asked for.
    residual : ndarray (r, k)
        Standard deviation that the fit leaves, NaN where there are too few samples to say.
    """

    value: Floats
    gradient: Floats
    hessian: Floats
    pivot: Floats
    level: NDArray[np.int8]
    covariance: Floats
    gain: Floats
    residual: Floats

    def put(self, where: Rows, other: Fits, chosen: Bools) -> None:
        """Overwrite the fits at `where` by the chosen ones of `other`."""
        for array in fields(self):
            getattr(self, array.name)[where] = getattr(other, array.name)[chosen]


def fit_patches(
    points: Floats,
    cloud: Cloud,
    neighbours: sparse.csr_array,
    *,
    degree: int,
    rows: Rows | None = None,
    levels: Sequence[int] = range(PATCH_LEVELS),
    pivots: Sequence[float] = (SMALLEST_PIVOT,),
    with_residual: bool = False,
    with_gain: bool = False,
) -> Fits:
    """Fit polynomials of `degree` around vertices, over patches grown until well conditioned.

    Parameters
    ----------
    points : ndarray (n, d)
        The vertices.
    cloud : Cloud
        What is fitted to.
    neighbours : csr_array (n, n)
        By which a patch grows.
    degree : {1, 2}
        Of the polynomials.
    rows : ndarray (r,), optional
        The vertices to fit around, all if None.
    levels : sequence of int
        How often to grow a patch, tried in this order.
    pivots : sequence of float
        The smallest pivots to accept, tried in this order.
    with_residual : bool
        Whether to compute the residuals.
    with_gain : bool
        Whether to compute the gains.

    Notes
    -----
    Coordinates are scaled by the covariance of the patch, so that an anisotropic patch is as
    well conditioned as a regular one.
    """
    rows = np.arange(len(points)) if rows is None else rows
    fits = _empty(len(rows), cloud.values.shape[1], points.shape[1])
    pending = np.arange(len(rows))
    for smallest_pivot in pivots:
        for level in levels:
            step = max(BLOCK >> max(level - 1, 0), 64)
            for start in range(0, len(pending), step):
                part = pending[start : start + step]
                patches = _patches(cloud.first, neighbours, rows[part], level)
                found = _fit(points, cloud, rows[part], patches, degree, with_residual, with_gain)
                found.level[:] = level
                well = found.pivot > smallest_pivot
                fits.put(part[well], found, well)
            pending = pending[fits.level[pending] < 0]
            if pending.size == 0:
                return fits
    return fits


def _empty(r: int, k: int, d: int) -> Fits:
    return Fits(
        value=np.zeros((r, k)),
        gradient=np.zeros((r, k, d)),
        hessian=np.zeros((r, k, d, d)),
        pivot=np.zeros(r),
        level=np.full(r, -1, dtype=np.int8),
        covariance=np.zeros((r, d, d)),
        gain=np.zeros(r),
        residual=np.full((r, k), np.nan),
    )


def _patches(
    first: sparse.csr_array, neighbours: sparse.csr_array, rows: Rows, level: int
) -> sparse.csr_array:
    """Return the samples in the patches of `rows`, as the nonzero entries of a matrix."""
    if level == 0:
        return sparse.csr_array(first[rows])
    ball = sparse.csr_array(
        (np.ones(len(rows), dtype=np.int32), (np.arange(len(rows)), rows)),
        shape=(len(rows), first.shape[0]),
    )
    for _ in range(level):
        ball = ball @ neighbours + ball
        ball.data[:] = 1  # only who is a member counts
    return sparse.csr_array(ball @ first)


@dataclass(frozen=True, kw_only=True)
class _Patches:
    """The patches with enough samples, in coordinates of their own.

    Attributes
    ----------
    rows, starts, counts : ndarray (r,) of int
        The vertices, and where the samples of each begin and how many they are.
    members : ndarray (s,) of int
        The samples of one patch after the other.
    covariance, scaling : ndarray (r, d, d)
        Of the samples, seen from the vertex, and the inverse of its root.
    xi : ndarray (d, s)
        Scaled coordinates of the samples.
    """

    rows: Rows
    starts: NDArray[np.intp]
    counts: Ints
    members: Ints
    covariance: Floats
    scaling: Floats
    xi: Floats


def _scaled_patches(
    points: Floats,
    cloud: Cloud,
    rows: Rows,
    patches: sparse.csr_array,
    enough: Bools,
) -> _Patches:
    sizes = np.diff(patches.indptr)
    counts, members = sizes[enough], patches.indices[np.repeat(enough, sizes)]
    starts = np.concatenate([[0], np.cumsum(counts)[:-1]])
    rows = rows[enough]
    v = cloud.positions[members] - np.repeat(points[rows], counts, axis=0)
    covariance = covariances(v, starts, counts)
    scaling = _inverse_root(covariance)
    return _Patches(
        rows=rows,
        starts=starts,
        counts=counts,
        members=members,
        covariance=covariance,
        scaling=scaling,
        xi=_scaled(v, scaling, counts),
    )


def _fit(
    points: Floats,
    cloud: Cloud,
    rows: Rows,
    patches: sparse.csr_array,
    degree: int,
    with_residual: bool,
    with_gain: bool,
) -> Fits:
    """Fit around `rows`; patches with too few samples or on a line get the pivot 0."""
    d, k = points.shape[1], cloud.values.shape[1]
    fits = _empty(len(rows), k, d)
    pairs = list(combinations_with_replacement(range(d), 2)) if degree == 2 else []
    unknowns = d + len(pairs) + (cloud.at_vertices is None)
    enough = np.diff(patches.indptr) >= unknowns
    if not enough.any():
        return fits
    around = _scaled_patches(points, cloud, rows, patches, enough)
    equations = Equations(
        basis=_basis(around, cloud, pairs),
        weight=_weight(around, cloud),
        starts=around.starts,
        counts=around.counts,
    )
    base = _base(around, cloud)
    rise = (cloud.values[around.members] - np.repeat(base, around.counts, axis=0)).T
    factor = factored(equations)
    coefficients = solved(equations, factor, rise)
    if with_gain:
        # the response to the value at the vertex, of which all the rises are differences
        through = np.full((1, rise.shape[1]), 0.0 if cloud.at_vertices is None else 1.0)
        response = solved(equations, factor, through)[:, 0]
        fits.gain[enough] = gain(equations, factor, response, pairs)
    if with_residual:
        fits.residual[enough] = residual(equations, coefficients, rise)
    fits.value[enough] = base if cloud.at_vertices is not None else base + coefficients[0].T
    derivatives = coefficients[unknowns - len(pairs) - d :]
    fits.gradient[enough] = np.einsum("ikn,nia->nka", derivatives[:d], around.scaling)
    if pairs:
        fits.hessian[enough] = _hessians(derivatives[d:], pairs, around.scaling)
    fits.pivot[enough], fits.covariance[enough] = factor.pivot, around.covariance
    return fits


def _base(around: _Patches, cloud: Cloud) -> Floats:
    """Values (r, k) that the fits are the rise from: at the vertices, or means of the samples."""
    if cloud.at_vertices is not None:
        return np.asarray(cloud.at_vertices[around.rows])
    sums = np.add.reduceat(cloud.values[around.members], around.starts, axis=0)
    return np.asarray(sums / around.counts[:, None])


def _hessians(second: Floats, pairs: list[tuple[int, int]], scaling: Floats) -> Floats:
    """Hessians (r, k, d, d) from the second derivatives in scaled coordinates."""
    k, r = second.shape[1:]
    d = scaling.shape[1]
    local = np.zeros((r, k, d, d))
    for c, (i, j) in zip(second, pairs, strict=True):
        local[:, :, i, j] = local[:, :, j, i] = c.T
    S = scaling[:, None]
    return product(product(S, local), S)


def _scaled(v: Floats, scaling: Floats, counts: Ints) -> Floats:
    """Vectors (d, s) in the coordinates of their patches."""
    d = v.shape[1]
    xi = np.zeros((d, len(v)))
    for i in range(d):
        for j in range(i + 1):
            entry = np.repeat(scaling[:, i, j], counts)
            xi[i] += entry * v[:, j]
            if i != j:
                xi[j] += entry * v[:, i]
    return xi


def _basis(around: _Patches, cloud: Cloud, pairs: list[tuple[int, int]]) -> list[Floats]:
    """Basis functions at the samples, such that coefficients are derivatives."""
    xi = around.xi
    basis = [*xi, *(xi[i] * xi[j] * (0.5 if i == j else 1.0) for i, j in pairs)]
    if cloud.spread is not None and pairs:
        S = np.repeat(around.scaling, around.counts, axis=0)
        spread = product(product(S, cloud.spread[around.members]), S)
        for a, (i, j) in enumerate(pairs):
            basis[len(xi) + a] += spread[:, i, j] * (0.5 if i == j else 1.0)
    if cloud.at_vertices is None:
        basis.insert(0, np.ones_like(xi[0]))
    return basis


def _weight(around: _Patches, cloud: Cloud) -> Floats:
    if cloud.weights is not None:
        return np.asarray(cloud.weights[around.members])
    distance: Floats = np.square(around.xi).sum(axis=0)
    if cloud.at_vertices is None:
        return np.asarray(1.0 / (1.0 + distance))
    # the vertex itself may be a member: its equation is 0 = 0 and must weigh nothing
    return np.divide(1.0, distance, out=np.zeros_like(distance), where=distance > 0.0)


def covariances(v: Floats, starts: AnyArray, counts: AnyArray) -> Floats:
    """Means (r, d, d) of ``v v^T`` over consecutive vectors (s, d)."""
    d = v.shape[1]
    result = np.empty((len(starts), d, d))
    for i in range(d):
        for j in range(i + 1):
            entry = np.add.reduceat(v[:, i] * v[:, j], starts) / counts
            result[:, i, j] = result[:, j, i] = entry
    return result


def _inverse_root(covariance: Floats) -> Floats:
    values, vectors = eigh(covariance)
    values = np.maximum(values, FLATTEST_PATCH * values[:, -1:])
    root = vectors / np.sqrt(values)[:, None, :]
    return product(root, vectors.transpose(0, 2, 1))
