"""Finding rows by the numbers that a file gives to its nodes or elements."""

from __future__ import annotations

import numpy as np

from ...base.arrays import AnyArray
from .text_rows import integers


class Numbering:
    """The rows of nodes or elements by their numbers.

    Parameters
    ----------
    what : str
        What is numbered, for messages.
    numbers : (n,) array
        The number of each row.

    Raises
    ------
    ValueError
        If a number is given twice.
    """

    def __init__(self, what: str, numbers: AnyArray) -> None:
        self._what = what
        numbers = integers(np.asarray(numbers, dtype=np.float64))
        self._order = np.argsort(numbers, kind="stable")
        self._sorted = numbers[self._order]
        twice = self._sorted[1:] == self._sorted[:-1]
        if twice.any():
            number = self._sorted[1:][twice][0]
            raise ValueError(f"the {what} number {number} is given twice: only one can be meant")

    def __len__(self) -> int:
        return len(self._sorted)

    def rows(self, wanted: AnyArray) -> AnyArray:
        """Return the row of each number; raise ValueError on an unknown one."""
        wanted = integers(np.asarray(wanted, dtype=np.float64))
        at = np.searchsorted(self._sorted, wanted).clip(max=max(len(self._sorted) - 1, 0))
        unknown = self._sorted[at] != wanted if len(self._sorted) else np.ones(wanted.shape, bool)
        if unknown.any():
            raise ValueError(f"it refers to {self._what} {wanted[unknown][0]}, which is not given")
        return np.asarray(self._order[at])
