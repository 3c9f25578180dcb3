"""The binary encoding of GMF: `.meshb` and `.solb`, a chain of records by keyword code.

References
----------
libMeshb 7, `libmeshb7.c`. Versions: 1 has float32, 2 float64, 3 int64 offsets, 4 int64 throughout.
Version 2 is written, because Mmg reads offsets as four bytes.
"""

from __future__ import annotations

import struct

import numpy as np

from ...base.errors import FormatError
from ..parsing.cursor import Cursor
from .gmf_container import (
    ENTITIES,
    SOLUTIONS,
    WITHOUT_CONTENT,
    Container,
    Solution,
    checked_dim,
    columns_of,
)

_DIMENSION, _VERTICES, _END = 3, 4, 54
_UNREAD = set(WITHOUT_CONTENT.values())
_NAMES = {
    _DIMENSION: "Dimension",
    _VERTICES: "Vertices",
    **{code: keyword for keyword, (code, _) in ENTITIES.items()},
    **{code: keyword for keyword, code in (SOLUTIONS | WITHOUT_CONTENT).items()},
}


def from_bytes(data: bytes) -> Container:
    """Return the content of a binary file.

    Raises
    ------
    ValueError
        If it is truncated or not what it says.
    """
    return _Binary(data).container()


class _Binary:
    """The chain of records of a binary file."""

    def __init__(self, data: bytes) -> None:
        if len(data) < 8:
            raise ValueError("it is truncated: no header")
        self._cursor = Cursor(data, "<" if data[:4] == b"\x01\0\0\0" else ">")
        if self._cursor.integer("i4") != 1:
            raise ValueError("it is not a GMF file: the first word is not 1")
        version = self._cursor.integer("i4")
        if not 1 <= version <= 4:
            raise ValueError(f"version {version} is not known, only 1 to 4")
        self._real = "f4" if version == 1 else "f8"
        self._index = "i8" if version == 4 else "i4"
        self._offset = "i8" if version >= 3 else "i4"

    def container(self) -> Container:
        """Walk the chain of keywords to its end, which must be that of the file."""
        result: Container | None = None
        cursor, seen = self._cursor, set()
        while (code := cursor.integer("i4")) != _END:
            following = cursor.integer(self._offset)
            if code in seen:
                raise ValueError(f"it has two sections {_name(code)}: only one can be meant")
            seen.add(code)
            if code == _DIMENSION:
                result = Container(dim=checked_dim(cursor.integer("i4")))
            elif result is None:
                raise ValueError("its first keyword is not Dimension")
            else:
                self._read(result, code, following)
            if following < cursor.at:
                raise ValueError(f"the offset {following} points back: the file is damaged")
            if following > cursor.at and code not in _UNREAD and code in _NAMES:
                raise ValueError(
                    f"{following - cursor.at} bytes follow the last row of {_name(code)}"
                )
            cursor.at = following
        self._check_end()
        if result is None:
            raise ValueError("it has no Dimension")
        return result

    def _check_end(self) -> None:
        """Raise if anything follows the keyword End but its offset and padding."""
        left = self._cursor.data[self._cursor.at + np.dtype(self._offset).itemsize :]
        if left.strip(b"\0"):
            raise ValueError(f"{len(left)} bytes follow its keyword End")

    def _read(self, result: Container, code: int, following: int) -> None:
        if code == _VERTICES:
            self._read_points(result)
        elif code in _NAMES and code not in _UNREAD:
            self._read_named(result, _NAMES[code])
        elif code not in _UNREAD and following > self._cursor.at:
            result.skipped.append(_name(code))

    def _read_points(self, result: Container) -> None:
        layout = np.dtype([("x", self._real, (result.dim,)), ("r", self._index)])
        rows = self._cursor.take(layout, self._cursor.integer(self._index))
        result.points, result.point_refs = rows["x"].astype(np.float64), rows["r"].astype(np.int64)

    def _read_named(self, result: Container, keyword: str) -> None:
        count = self._cursor.integer(self._index)
        if keyword in ENTITIES:
            width = ENTITIES[keyword][1]
            flat = self._cursor.take(self._index, count * width)
            result.tables[keyword] = flat.reshape(count, width).astype(np.int64)
            return
        types = self._cursor.take("i4", self._cursor.integer("i4")).tolist()
        width = sum(columns_of(types, result.dim))
        flat = self._cursor.take(self._real, count * width)
        result.solutions[keyword] = Solution(types, flat.reshape(count, width).astype(np.float64))


def _name(code: int) -> str:
    return _NAMES.get(code, f"of code {code}")


def to_bytes(container: Container) -> bytes:
    """Return a container as a file of version 2."""
    records: list[tuple[int, bytes]] = []
    if container.points is not None:
        rows = np.empty(
            len(container.points), np.dtype([("x", "<f8", (container.dim,)), ("r", "<i4")])
        )
        rows["x"], rows["r"] = container.points, container.references()
        records.append((_VERTICES, struct.pack("<i", len(rows)) + rows.tobytes()))
    for keyword, table in container.tables.items():
        head = struct.pack("<i", len(table))
        records.append((ENTITIES[keyword][0], head + table.astype("<i4").tobytes()))
    for keyword, solution in container.solutions.items():
        types = (len(solution.values), len(solution.types), *solution.types)
        head = struct.pack(f"<{len(types)}i", *types)
        records.append((SOLUTIONS[keyword], head + solution.values.astype("<f8").tobytes()))
    out = [struct.pack("<iiiii", 1, 2, _DIMENSION, 20, container.dim)]
    at = 20
    for code, payload in records:
        at += 8 + len(payload)
        out += [struct.pack("<ii", code, at), payload]
    if at + 8 >= 2**31:
        raise FormatError("more than 2 GiB do not fit in version 2 of the format")
    return b"".join([*out, struct.pack("<ii", _END, 0)])
