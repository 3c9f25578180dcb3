"""The sections of a Gmsh file, and the words and numbers in each, in text or binary.

References
----------
Gmsh reference manual, "MSH file format": sections begin with ``$Name`` and end with ``$EndName``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...base.arrays import AnyArray
from ..parsing.cursor import Cursor, Order
from ..parsing.rows import leading_rows
from ..parsing.text_rows import integers, parsed

_MARK = re.compile(r"^\$(\w+)[ \t\r]*$", re.MULTILINE)
_BINARY_MARK = re.compile(rb"\$(\w+)[ \t\r]*\n")
_FORMAT = re.compile(
    rb"^\$MeshFormat[ \t\r]*\n\s*([\d.]+)\s+([01])\s+(\d+)[ \t\r]*\n", re.MULTILINE
)


@dataclass(frozen=True)
class Header:
    """The section MeshFormat: version, whether text, bytes of a count, byte order, and its end."""

    version: str
    is_text: bool
    size: int
    order: Order
    end: int

    @classmethod
    def of(cls, data: bytes) -> Header:
        """Find it in a file."""
        found = _FORMAT.search(data)
        if found is None:
            raise ValueError("it has no section MeshFormat, or that is damaged")
        version, is_text, size = found[1].decode(), found[2] == b"0", int(found[3][:4])
        if size not in (4, 8):
            raise ValueError(f"its MeshFormat says {size} bytes, it must be 4 or 8")
        one = data[found.end() : found.end() + 4]
        if not is_text and one not in (b"\1\0\0\0", b"\0\0\0\1"):
            raise ValueError("its MeshFormat says binary, but not in which order bytes are")
        return cls(version, is_text, size, "<" if one[:1] == b"\1" else ">", found.end())


class TextStream:
    """What is in one section of a text: lines first, then numbers."""

    def __init__(self, name: str, body: str) -> None:
        self._name = name
        self._body = body.removeprefix("\n")
        self._at = 0
        self._numbers: AnyArray | None = None

    def line(self) -> str:
        """Return the next line that is not blank, nothing at the end."""
        line = ""
        while not line and self._at < len(self._body):
            end = self._body.find("\n", self._at)
            end = len(self._body) if end < 0 else end
            line = self._body[self._at : end].strip()
            self._at = min(end + 1, len(self._body))
        return line

    def ints(self, count: int) -> AnyArray:
        """Return the next tags or types."""
        numbers = self.reals(count)
        try:
            return integers(numbers)
        except ValueError as error:
            raise ValueError(f"the section {self._name} {error}") from error

    def all_ints(self) -> AnyArray:
        """Return all numbers that are left."""
        return self.ints(len(self._parsed()))

    def sizes(self, count: int) -> AnyArray:
        """Return the next counts or numbers of nodes."""
        return self.ints(count)

    def reals(self, count: int) -> AnyArray:
        """Return the next coordinates or values."""
        numbers = self._parsed()
        if not 0 <= count <= len(numbers):
            raise ValueError(
                f"the section {self._name} announces {count} numbers, {len(numbers)} follow"
            )
        self._numbers = numbers[count:]
        return numbers[:count]

    def table(self, count: int, width: int) -> tuple[AnyArray, AnyArray]:
        """Return rows of an integer and `width` reals: the integers, and the reals."""
        rows = self.reals(count * (1 + width)).reshape(count, 1 + width)
        return integers(rows[:, 0]), rows[:, 1:]

    def rest(self) -> str:
        """Return all that is left as text."""
        text, self._at = self._body[self._at :], len(self._body)
        return text

    def finish(self) -> None:
        """Raise ValueError if anything is left."""
        if len(self._parsed()):
            raise ValueError(
                f"the section {self._name} has {len(self._parsed())} more numbers than it announces"
            )

    def _parsed(self) -> AnyArray:
        if self._numbers is None:
            try:
                self._numbers = parsed(self.rest())
            except ValueError as error:
                raise ValueError(f"the section {self._name} {error}") from error
        return self._numbers


class BinaryStream:
    """What is in one section of a binary file: lines first, then numbers."""

    def __init__(self, name: str, cursor: Cursor, size: int) -> None:
        self._end = f"$End{name}".encode()
        self._cursor = cursor
        self._size = f"u{size}"

    def line(self) -> str:
        """Return the next line."""
        return self._cursor.line()

    def ints(self, count: int) -> AnyArray:
        """Return the next tags or types."""
        return self._cursor.take("i4", count).astype(np.int64)

    def peek_ints(self, count: int) -> AnyArray:
        """Return the next tags or types without going on."""
        at = self._cursor.at
        values = self.ints(count)
        self._cursor.at = at
        return values

    def alike_ints(self, width: int, n_alike: int, most: int) -> AnyArray:
        """Return the next rows that begin alike, `most` at most."""
        cursor, item = self._cursor, np.dtype("i4").itemsize
        n_left = (len(cursor.data) - cursor.at) // item
        start = cursor.at
        values = cursor.take("i4", min(n_left, most * width))
        rows = leading_rows(values, 0, width, list(range(n_alike)))
        cursor.at = start + item * rows.size
        return rows.astype(np.int64)

    def sizes(self, count: int) -> AnyArray:
        """Return the next counts or numbers of nodes."""
        return self._cursor.take(self._size, count).astype(np.int64)

    def reals(self, count: int) -> AnyArray:
        """Return the next coordinates or values."""
        return self._cursor.take("f8", count).astype(np.float64)

    def table(self, count: int, width: int) -> tuple[AnyArray, AnyArray]:
        """Return rows of an integer and `width` reals: the integers, and the reals."""
        layout = np.dtype([("number", "i4"), ("values", "f8", (width,))])
        rows = self._cursor.take(layout, count)
        return rows["number"].astype(np.int64), rows["values"].astype(np.float64)

    def rest(self) -> str:
        """Return all that is left as text."""
        end = self._cursor.data.find(self._end, self._cursor.at)
        if end < 0:
            raise ValueError(f"it is truncated: {self._end.decode()} is missing")
        text = self._cursor.data[self._cursor.at : end].decode("utf-8", errors="replace")
        self._cursor.at = end
        self.finish()
        return text

    def finish(self) -> None:
        """Raise ValueError if anything is left."""
        cursor = self._cursor
        cursor.skip_blanks()
        if not cursor.data.startswith(self._end, cursor.at):
            raise ValueError(f"{self._end.decode()} does not follow at byte {cursor.at}")
        cursor.at += len(self._end)


Stream = TextStream | BinaryStream


def sections(data: bytes, header: Header) -> Iterator[tuple[str, Stream]]:
    """Yield each section by its name; it has to be read to its end before the next one.

    Raises
    ------
    ValueError
        If a section does not end, or something stands between them.
    """
    if header.is_text:
        yield from _text_sections(data.decode("utf-8", errors="replace"))
        return
    cursor = Cursor(data, header.order)
    end = data.find(b"$EndMeshFormat", header.end)
    if end < 0:
        raise ValueError("it is truncated: the section MeshFormat does not end")
    cursor.at = end + len(b"$EndMeshFormat")
    cursor.skip_blanks()
    while not cursor.is_at_end:
        found = _BINARY_MARK.match(data, cursor.at)
        if found is None:
            raise ValueError(f"at byte {cursor.at} no section begins")
        cursor.at = found.end()
        name = found[1].decode("ascii", errors="replace")
        yield name, BinaryStream(name, cursor, header.size)
        cursor.skip_blanks()


def _text_sections(text: str) -> Iterator[tuple[str, Stream]]:
    name, start, left = "", 0, 0
    for mark in _MARK.finditer(text):
        if not name:
            if mark[1].startswith("End") or text[left : mark.start()].strip():
                raise ValueError(f"something stands before the line ${mark[1]}, in no section")
            name, start = mark[1], mark.end()
        elif mark[1] == f"End{name}":
            yield name, TextStream(name, text[start : mark.start()])
            name, left = "", mark.end()
    if name:
        raise ValueError(f"it is truncated: the section {name} does not end")
    if text[left:].strip():
        raise ValueError("it is truncated, or something follows its last section")
