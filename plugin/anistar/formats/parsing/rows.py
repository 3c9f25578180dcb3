"""Rows of numbers that stand in one array although they may differ in length."""

from __future__ import annotations

import numpy as np

from ...base.arrays import AnyArray

_FIRST_LOOK = 16


def leading_rows(values: AnyArray, at: int, width: int, alike: list[int]) -> AnyArray:
    """Return the longest run of rows from `at` that agree with the first one in some columns.

    The work is in proportion to what is returned.

    Parameters
    ----------
    values : (n,) array
    at : int
    width : int
        Length of the first row.
    alike : list of int
        Columns whose values fix the width.

    Returns
    -------
    (k, width) array

    Raises
    ------
    ValueError
        If not even one row is left.
    """
    most = (len(values) - at) // width
    ahead = _FIRST_LOOK
    while True:
        ahead = min(2 * ahead, most)
        if ahead <= 0:
            raise ValueError("it ends within a row")
        rows = values[at : at + ahead * width].reshape(ahead, width)
        same = (rows[:, alike] == rows[0, alike]).all(axis=1)
        if not same.all():
            return np.asarray(rows[: int(np.argmin(same))])
        if ahead == most:
            return np.asarray(rows)
