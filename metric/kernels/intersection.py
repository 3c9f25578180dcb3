"""Intersections of two metrics."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from . import compiled, simultaneous_reduction

Array = NDArray[np.float64]


def intersect(M: Array, N: Array) -> Array:
    """Intersect checked metrics (n, d, d), see `combination.intersected`."""
    if compiled.core is None:
        return simultaneous_reduction.intersect(M, N)
    result: Array = compiled.core.intersect(M, N)
    return result
