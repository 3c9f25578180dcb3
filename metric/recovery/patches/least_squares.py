"""Weighted least squares over patches of samples, many patches at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...base.arrays import Floats, Ints

LAST_PIVOT = 1e-8
"""No pivot is taken to be smaller: half of the digits are left. Also the last resort of a fit."""

LEAST_FREEDOM = 3
"""Samples beyond the number of unknowns from which a residual says something."""


@dataclass(frozen=True, kw_only=True)
class Equations:
    """The weighted equations of r patches, one below the other: s in all.

    Attributes
    ----------
    basis : list of b ndarray (s,)
        Values of the basis functions at the samples.
    weight : ndarray (s,)
    starts, counts : ndarray (r,) of int
        Where the equations of each patch begin, and how many they are.
    """

    basis: list[Floats]
    weight: Floats
    starts: NDArray[np.intp]
    counts: Ints


@dataclass(frozen=True, kw_only=True)
class Factor:
    """The Cholesky factors of the normal matrices, scaled to a unit diagonal.

    Attributes
    ----------
    lower : ndarray (b, b, r)
    scale : ndarray (b, r)
        Of the rows and columns.
    pivot : ndarray (r,)
        The smallest pivots.
    """

    lower: Floats
    scale: Floats
    pivot: Floats


def factored(equations: Equations) -> Factor:
    """Factorise the normal equations of all the patches: the loops are over the basis."""
    basis, starts = equations.basis, equations.starts
    size = len(basis)
    normal = np.empty((size, size, len(starts)))
    for a in range(size):
        weighted = equations.weight * basis[a]
        for b in range(a + 1):
            normal[a, b] = np.add.reduceat(weighted * basis[b], starts)
    diagonal = np.array([normal[a, a] for a in range(size)])
    scale = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    pivot = np.where((diagonal > 0.0).all(axis=0), 1.0, 0.0)
    for a in range(size):
        for b in range(a + 1):
            L = normal[a, b] * scale[a] * scale[b]
            for c in range(b):
                L -= normal[a, c] * normal[b, c]
            if a == b:
                pivot = np.minimum(pivot, L)
                normal[a, a] = np.sqrt(np.maximum(L, LAST_PIVOT))
            else:
                normal[a, b] = L / normal[b, b]
    return Factor(lower=normal, scale=scale, pivot=pivot)


def solved(equations: Equations, factor: Factor, values: Floats) -> Floats:
    """Coefficients (b, k, r) of the functions with the values (k, s) at the samples."""
    right = np.empty((len(equations.basis), len(values), len(equations.starts)))
    for a, phi in enumerate(equations.basis):
        weighted = equations.weight * phi
        for f, samples in enumerate(values):
            right[a, f] = np.add.reduceat(weighted * samples, equations.starts)
    scale = factor.scale[:, None]
    return np.asarray(_substituted(factor.lower, right * scale) * scale)


def gain(
    equations: Equations, factor: Factor, response: Floats, pairs: list[tuple[int, int]]
) -> Floats:
    """Root mean squares (r,) of the second derivatives that noise of the samples makes.

    `pairs` are the derivatives that the last coefficients stand for, `response` (b, r) the
    coefficients of a unit value at the vertex. Exact would be ``N^-1 (sum w^2 phi phi^T) N^-1``
    with the normal matrix N; the sum is replaced by N times a mean weight, one for each basis
    function.
    """
    basis, weight, starts = equations.basis, equations.weight, equations.starts
    square = np.zeros(len(starts))
    for c, (i, j) in enumerate(pairs, start=len(basis) - len(pairs)):
        unit = np.zeros((len(basis), 1, len(starts)))
        unit[c] = factor.scale[c]
        inverse = _substituted(factor.lower, unit)[c, 0] * factor.scale[c]
        phi = weight * np.square(basis[c])
        total = np.add.reduceat(phi, starts)
        # a function that is zero at all samples has no weight; the pivot of its patch is zero
        mean = np.add.reduceat(weight * phi, starts) / np.where(total > 0.0, total, 1.0)
        variance = inverse * mean + np.square(response[c])
        square += variance * (1.0 if i == j else 2.0)
    return np.asarray(np.sqrt(square))


def residual(equations: Equations, coefficients: Floats, values: Floats) -> Floats:
    """Return the standard deviations (r, k) that the fits leave, NaN with too few samples."""
    left, counts = values.copy(), equations.counts
    for phi, c in zip(equations.basis, coefficients, strict=True):
        left -= phi * np.repeat(c, counts, axis=1)
    freedom = counts - len(equations.basis)
    square = np.add.reduceat(np.square(left), equations.starts, axis=1)
    enough = freedom >= LEAST_FREEDOM
    variance = square / np.where(enough, freedom, 1)
    return np.asarray(np.where(enough, np.sqrt(variance), np.nan).T)


def _substituted(L: Floats, right: Floats) -> Floats:
    """Solve ``L L^T x = right`` for all patches, L (b, b, r) lower, right (b, k, r)."""
    x, size = right, len(L)
    for a in range(size):
        for c in range(a):
            x[a] -= L[a, c] * x[c]
        x[a] /= L[a, a]
    for a in reversed(range(size)):
        for c in range(a + 1, size):
            x[a] -= L[c, a] * x[c]
        x[a] /= L[a, a]
    return x
