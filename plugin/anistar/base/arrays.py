"""The arrays that everything here takes and returns: those of `anistar.metric`."""

from __future__ import annotations

from ..metric.base.arrays import AnyArray, Bools, Floats, Ints, Longs

__all__ = ["AnyArray", "Bools", "Floats", "Ints", "Longs"]
