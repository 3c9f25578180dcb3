"""Vectors, many at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def norms(v: Array) -> Array:
    """Euclidean norms (...,) of vectors (..., d)."""
    return np.asarray(np.sqrt((v * v).sum(axis=-1)))
