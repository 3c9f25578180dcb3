"""Arrays of integers from what is given: converted without loss, their shapes checked."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Ints


def as_int32(given: ArrayLike, name: str) -> Ints:
    """Return a new int32 array; raise and name the entry that would lose information."""
    array = np.asarray(given)
    if array.dtype.kind not in "biuf":
        raise TypeError(f"{name} must be integers, not {array.dtype}")
    with np.errstate(invalid="ignore"):
        result = np.array(array, dtype=np.int32, order="C")
    changed = result != array
    if changed.any():
        at = np.unravel_index(int(np.argmax(changed)), array.shape)
        where = ", ".join(str(int(i)) for i in at)
        raise TypeError(f"{name}[{where}] = {array[at]} is not a 32-bit integer")
    return result


def as_rows(given: ArrayLike | None, name: str, width: int) -> Ints:
    """Return rows (k, width) of point indices as a new array; None are none."""
    rows = np.zeros((0, width), np.int32) if given is None else as_int32(given, name)
    if rows.size == 0:
        rows = rows.reshape(0, width)
    if rows.ndim != 2 or rows.shape[1] != width:
        raise ValueError(f"{name} must have shape (k, {width}), not {rows.shape}")
    return rows


def as_tags(given: ArrayLike | None, name: str, length: int) -> Ints:
    """Return tags as a new array, 0 if none are given."""
    tags = np.zeros(length, np.int32) if given is None else as_int32(given, name)
    if tags.shape != (length,):
        raise ValueError(f"{name} must have shape ({length},), not {tags.shape}")
    return tags
