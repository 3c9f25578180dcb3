"""Vectors, many at once."""

from __future__ import annotations

import numpy as np

from .arrays import Floats


def norms(v: Floats) -> Floats:
    """Euclidean norms (...,) of vectors (..., d)."""
    return np.asarray(np.sqrt((v * v).sum(axis=-1)))
