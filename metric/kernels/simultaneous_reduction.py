"""Two metrics in one common basis: their intersection."""

from __future__ import annotations

import numpy as np

from ..base.arrays import Bools, Floats
from . import jacobi
from .algebra import congruent, lower_factor
from .spectra import compose, product


def intersect(M: Floats, N: Floats) -> Floats:
    """Intersect checked metrics (n, d, d): at least as fine as both, to round-off.

    A second pass takes back what the first rounds off where sizes differ by many orders of
    magnitude.
    """
    once, changed = intersection(M, N, 0.0)
    once[changed], _ = intersection(once[changed], N[changed], 0.0)
    return once


def intersection(M: Floats, N: Floats, tolerance: float) -> tuple[Floats, Bools]:
    """Intersect checked metrics; leave `M` where `N` exceeds it by a factor < 1 + `tolerance`.

    Returns the metrics (n, d, d) and a mask (n,) of those that changed. What is added to `M`
    is positive semidefinite, so the result is never coarser.
    """
    L = lower_factor(M)
    values, vectors = jacobi.spectra(congruent(L, N))
    changed = values.max(axis=1, initial=0.0) > 1.0 + tolerance
    result = M.copy()
    gain = np.maximum(values[changed] - 1.0, 0.0)
    result[changed] += compose(gain, product(L[changed], vectors[changed]))
    return result, changed
