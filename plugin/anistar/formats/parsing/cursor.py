"""Reading numbers from the bytes of a file, never past its end."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np

from ...base.arrays import AnyArray

Order = Literal["<", ">"]
_BLANKS = b" \t\r\n"


class Cursor:
    """A place in the bytes of a file.

    Parameters
    ----------
    data : bytes
    order : {"<", ">"}
        Byte order of the numbers.
    """

    def __init__(self, data: bytes, order: Order = "<") -> None:
        self.data = data
        self.order = order
        self.at = 0

    def take(self, kind: str | np.dtype[Any], count: int) -> AnyArray:
        """Return the next `count` numbers; what the file cannot hold takes no memory.

        Raises
        ------
        ValueError
            If the file ends before.
        """
        dtype = np.dtype(kind).newbyteorder(self.order)
        end = self.at + dtype.itemsize * count
        if count < 0 or end > len(self.data):
            raise ValueError(
                f"it is truncated: {count} values of {dtype.itemsize} bytes at byte {self.at}, "
                f"the file has {len(self.data)}"
            )
        array = np.frombuffer(self.data, dtype=dtype, count=count, offset=self.at)
        self.at = end
        return array

    def integer(self, kind: str | np.dtype[Any]) -> int:
        """Return the next number."""
        return int(self.take(kind, 1)[0])

    def line(self) -> str:
        """Return the rest of the line and go to the next one; at the end an empty text."""
        end = self.data.find(b"\n", self.at)
        end = len(self.data) if end < 0 else end
        text = self.data[self.at : end].decode("utf-8", errors="replace")
        self.at = min(end + 1, len(self.data))
        return text.strip()

    def skip_blanks(self) -> None:
        """Go to the next byte that is no blank and ends no line."""
        while not self.is_at_end and self.data[self.at] in _BLANKS:
            self.at += 1

    @property
    def is_at_end(self) -> bool:
        """Whether nothing is left."""
        return self.at >= len(self.data)
