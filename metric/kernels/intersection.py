"""Intersections of two metrics."""

from __future__ import annotations

from ..base.arrays import Floats
from . import compiled, simultaneous_reduction


def intersect(M: Floats, N: Floats) -> Floats:
    """Intersect checked metrics (n, d, d), see `tensors.combination.intersected`."""
    if compiled.core is None:
        return simultaneous_reduction.intersect(M, N)
    result: Floats = compiled.core.intersect(M, N)
    return result
