"""The numbers of a legacy VTK file, which may be text or binary."""

from __future__ import annotations

import numpy as np

from ...base.arrays import AnyArray
from ..parsing.cursor import Cursor
from ..parsing.text_rows import parsed

_TYPES = {
    "char": "i1",
    "unsigned_char": "u1",
    "short": "i2",
    "unsigned_short": "u2",
    "int": "i4",
    "unsigned_int": "u4",
    "long": "i8",
    "unsigned_long": "u8",
    "float": "f4",
    "double": "f8",
    "vtkidtype": "i4",  # so written whatever its size in memory
    "vtktypeint32": "i4",
    "vtktypeint64": "i8",
    "vtktypeuint8": "u1",
}
_LENGTHS = ("u8", "u4", "u2", "u1")
"""Of strings, by the first two bits, which are no part of the length."""
_BITS = 8
_BYTES_PER_NUMBER = 32


class LegacyNumbers:
    """Goes through a file by lines of words and runs of numbers."""

    def __init__(self, cursor: Cursor, *, is_text: bool) -> None:
        self._cursor = cursor
        self.is_text = is_text

    def next_words(self) -> list[str]:
        """Return the words of the next line that has any; none at the end."""
        self._cursor.skip_blanks()
        return self._cursor.line().split()

    def peek(self) -> str:
        """Return the next line that has words without going on."""
        at = self._cursor.at
        self._cursor.skip_blanks()
        line = self._cursor.line()
        self._cursor.at = at
        return line

    def skip_metadata(self) -> None:
        """Go behind the blank line that ends such a section."""
        while not self._cursor.is_at_end and self._cursor.line():
            pass

    def read(self, kind: str, count: int) -> AnyArray:
        """Return the next numbers of a type that is called as in the file."""
        if kind.lower() == "bit":
            return self._read_bits(count)
        dtype = _TYPES.get(kind.lower())
        if dtype is None:
            raise ValueError(f"the type {kind[:40]!r} is not known")
        if not self.is_text:
            return self._cursor.take(dtype, count).astype(dtype)
        start, self._cursor.at = self._cursor.at, self._end_of_words(count)
        text = self._cursor.data[start : self._cursor.at].decode("ascii", errors="replace")
        return parsed(text, np.int64 if dtype[0] in "iu" else dtype).astype(dtype)

    def _read_bits(self, count: int) -> AnyArray:
        if self.is_text:
            return self.read("unsigned_char", count)
        n_bytes = -(-count // _BITS)
        return np.unpackbits(self._cursor.take("u1", n_bytes), count=count)

    def skip_strings(self, count: int) -> None:
        """Go behind some strings: a line each, or a length in front of each one.

        The first two bits of a length say in how many bytes it is written.
        """
        for _ in range(count):
            if self._cursor.is_at_end:
                raise ValueError(f"it is truncated: {count} strings are announced")
            if self.is_text:
                self._cursor.line()
                continue
            kind = np.dtype(_LENGTHS[self._cursor.data[self._cursor.at] >> (_BITS - 2)])
            length = self._cursor.integer(kind) % (1 << (_BITS * kind.itemsize - 2))
            self._cursor.take("u1", length)

    def _end_of_words(self, count: int) -> int:
        """Return where the next words end; no more is looked at than a few times their length."""
        data, at = self._cursor.data, self._cursor.at
        if count > len(data):
            raise ValueError(f"it is truncated: {count} numbers are announced")
        length = _BYTES_PER_NUMBER * (count + 1)
        while True:
            part = data[at : at + length]
            words = part.split(None, count)
            is_whole = len(words) > count or at + length >= len(data)
            if is_whole:
                break
            length *= 2
        if len(words) < count:
            raise ValueError(f"it is truncated: {len(words)} of {count} numbers are there")
        return at + len(part) - (len(words[count]) if len(words) > count else 0)
