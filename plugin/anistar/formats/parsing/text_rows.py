"""Numbers in text: fast printing that keeps every bit, and parsing that notices garbage."""

from __future__ import annotations

import warnings

import numpy as np
from numpy.typing import DTypeLike

from ...base.arrays import AnyArray, Floats, Longs


def printed(*columns: AnyArray) -> str:
    """Return one line for each row, the columns side by side, doubles with 17 digits."""
    if len(columns[0]) == 0:
        return ""
    tables = [column.reshape(len(column), -1) for column in columns]
    formats = ["%d" if t.dtype.kind in "iu" else "%.17g" for t in tables for _ in t.T]
    flat = [values for table in tables for values in table.T.tolist()]
    line = " ".join(formats)
    return "\n".join([line % row for row in zip(*flat, strict=True)]) + "\n"


def parsed(text: str, dtype: DTypeLike = np.float64) -> AnyArray:
    """Return the numbers in a text.

    Raises
    ------
    ValueError
        If anything in it is not a number.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)
        try:
            # fromstring makes a number of blanks alone
            blank = not text or text.isspace()
            return np.zeros(0, dtype) if blank else np.fromstring(text, dtype=dtype, sep=" ")
        except (DeprecationWarning, ValueError) as error:
            raise ValueError("holds something that is not a number") from error


def integers(numbers: Floats) -> Longs:
    """Return numbers as integers.

    Raises
    ------
    ValueError
        If one of them is not an integer.
    """
    bad = ~(np.abs(numbers) < 2.0**53) | (numbers != np.floor(numbers))
    if bad.any():
        raise ValueError(f"holds {numbers[bad][0]} where an integer is expected")
    return numbers.astype(np.int64)
