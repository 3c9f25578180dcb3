"""Rows that begin with their length."""

from __future__ import annotations

from ....base.arrays import AnyArray


def sized_rows(values: AnyArray, at: int) -> tuple[AnyArray, int]:
    """Return what follows the length at a place, and where it ends.

    Raises
    ------
    ValueError
        If the values end before.
    """
    size = int(values[at]) if at < len(values) else -1
    if size < 0 or at + 1 + size > len(values):
        raise ValueError("it is truncated: it ends within a row")
    return values[at + 1 : at + 1 + size], at + 1 + size
