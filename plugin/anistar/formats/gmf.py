"""The two encodings of the GMF container behind `.mesh`, `.meshb`, `.sol` and `.solb`.

Both are read into, and written from, one `Container`: a dimension and a table of numbers for
each keyword. Keywords that are not listed here are skipped.

References
----------
libMeshb 7, `libmeshb7.c`. Versions: 1 has float32, 2 float64, 3 int64 offsets, 4 int64 throughout.
Version 2 is written, because Mmg reads offsets as four bytes.
"""

from __future__ import annotations

import json
import re
import struct
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import FormatError
from .suffixes import BINARY, suffix_of
from .text_rows import integers, parsed, printed

# keyword -> (code, integers in a row); Vertices and SolAt* have their own layout.
ENTITIES = {
    "Edges": (5, 3),
    "Triangles": (6, 4),
    "Quadrilaterals": (7, 5),
    "Tetrahedra": (8, 5),
    "Prisms": (9, 7),
    "Hexahedra": (10, 9),
    "Corners": (13, 1),
    "Ridges": (14, 1),
    "RequiredVertices": (15, 1),
    "RequiredEdges": (16, 1),
    "RequiredTriangles": (17, 1),
    "TrianglesP2": (24, 7),
    "EdgesP2": (25, 4),
    "TetrahedraP2": (30, 11),
    "Pyramids": (49, 6),
}
SOLUTIONS = {"SolAtVertices": 62, "SolAtTriangles": 64, "SolAtTetrahedra": 66}
_DIMENSION, _VERTICES, _END = 3, 4, 54
_KEYWORD = re.compile(r"(?<![\w.+-])(?!Inf|Nan|NaN)([A-Z][a-z][A-Za-z0-9]+)")
_NOTE = re.compile(r"^\s*#\s*anistar:(\w+) (.*)$", re.MULTILINE)


@dataclass
class Solution:
    """Fields on one kind of entity: type codes (1 scalar, 2 vector, 3 tensor) and all columns."""

    types: list[int]
    values: NDArray[np.float64]


@dataclass
class Container:
    """The content of a GMF file; integer tables count from 1 as in the file.

    Attributes
    ----------
    dim : int
    points : (n, dim) float64, or None in a solution file
    tables : dict of keyword to (k, w) int64
    solutions : dict of keyword to Solution
    notes : dict of str to JSON values, kept in comments of the text encoding only
    """

    dim: int
    points: NDArray[np.float64] | None = None
    point_refs: NDArray[np.int64] | None = None
    tables: dict[str, NDArray[np.int64]] = field(default_factory=dict)
    solutions: dict[str, Solution] = field(default_factory=dict)
    notes: dict[str, Any] = field(default_factory=dict)


def columns_of(types: list[int], dim: int) -> list[int]:
    """Return the number of columns of each field type."""
    widths = {1: 1, 2: dim, 3: dim * (dim + 1) // 2, 4: dim * dim}
    try:
        return [widths[code] for code in types]
    except KeyError as error:
        raise FormatError(f"unknown field type {error.args[0]}") from error


def load(path: Path) -> Container:
    """Read either encoding; the suffix tells which.

    Raises
    ------
    FormatError
        If the file is unreadable, truncated or not what it says.
    """
    try:
        if suffix_of(path) in BINARY:
            return _Binary(path.read_bytes()).container()
        return _from_text(path.read_text(encoding="utf-8", errors="replace"))
    except OSError as error:
        raise FormatError(f"cannot read {path}: {error.strerror or error}") from error
    except FormatError as error:
        raise FormatError(f"cannot read {path}: {error}") from error


def save(path: Path, container: Container) -> None:
    """Write the encoding that the suffix names."""
    if suffix_of(path) in BINARY:
        path.write_bytes(_to_bytes(container))
    else:
        path.write_text(_to_text(container), encoding="utf-8")


# ---- text ----


def _from_text(text: str) -> Container:
    notes = {name: _note(value) for name, value in _NOTE.findall(text)}
    clean = re.sub(r"#.*", "", text)
    found = list(_KEYWORD.finditer(clean))
    if not found or found[0].group() != "MeshVersionFormatted":
        raise FormatError("it does not begin with MeshVersionFormatted")
    ends = [match.start() for match in found[1:]] + [len(clean)]
    sections = {
        match.group(): clean[match.end() : end] for match, end in zip(found, ends, strict=True)
    }
    if "Dimension" not in sections:
        raise FormatError("it has no Dimension")
    # Solution files written by hand often lack it; their one section is checked by its count.
    if "End" not in sections and "Vertices" in sections:
        raise FormatError("it is truncated: the keyword End is missing")
    first = _numbers("Dimension", sections["Dimension"])[:1]
    dim = _checked_dim(int(_integers("Dimension", first)[0]))
    container = Container(dim=dim, notes=notes)
    for keyword, body in sections.items():
        if keyword == "Vertices":
            rows = _table(keyword, _numbers(keyword, body), dim + 1)
            container.points = rows[:, :dim].copy()
            container.point_refs = _integers(keyword, rows[:, dim])
        elif keyword in ENTITIES:
            rows = _table(keyword, _numbers(keyword, body), ENTITIES[keyword][1])
            container.tables[keyword] = _integers(keyword, rows)
        elif keyword in SOLUTIONS:
            container.solutions[keyword] = _text_solution(keyword, _numbers(keyword, body), dim)
    return container


def _note(value: str) -> Any:
    try:
        return json.loads(value)
    except json.JSONDecodeError as error:
        raise FormatError(f"a comment of anistar is not JSON: {error}") from error


def _checked_dim(dim: int) -> int:
    if dim not in (2, 3):
        raise FormatError(f"Dimension is {dim}, it must be 2 or 3")
    return dim


def _numbers(keyword: str, body: str) -> NDArray[np.float64]:
    try:
        numbers = parsed(body)
    except ValueError as error:
        raise FormatError(f"{keyword} {error}") from error
    if len(numbers) == 0:
        raise FormatError(f"it is truncated: {keyword} has no numbers")
    return numbers


def _integers(keyword: str, numbers: NDArray[np.float64]) -> NDArray[np.int64]:
    try:
        return integers(numbers)
    except ValueError as error:
        raise FormatError(f"{keyword} {error}") from error


def _table(keyword: str, numbers: NDArray[np.float64], width: int) -> NDArray[np.float64]:
    count = int(_integers(keyword, numbers[:1])[0])
    if len(numbers) - 1 != count * width:
        raise FormatError(
            f"{keyword} announces {count} rows of {width} numbers, "
            f"but {len(numbers) - 1} numbers follow"
        )
    return numbers[1:].reshape(count, width)


def _text_solution(keyword: str, numbers: NDArray[np.float64], dim: int) -> Solution:
    n_types = int(_integers(keyword, numbers[1:2])[0]) if len(numbers) > 1 else 0
    types = _integers(keyword, numbers[2 : 2 + n_types]).tolist()
    body = np.r_[numbers[0], numbers[2 + n_types :]]
    return Solution(types, _table(keyword, body, sum(columns_of(types, dim))).copy())


def _to_text(container: Container) -> str:
    parts = ["MeshVersionFormatted 2\n"]
    parts += [f"# anistar:{name} {json.dumps(value)}\n" for name, value in container.notes.items()]
    parts.append(f"Dimension {container.dim}\n")
    if container.points is not None:
        refs = _point_refs(container)
        parts += [f"Vertices\n{len(refs)}\n", printed(container.points, refs)]
    for keyword, table in container.tables.items():
        parts += [f"{keyword}\n{len(table)}\n", printed(table)]
    for keyword, solution in container.solutions.items():
        types = " ".join(str(code) for code in (len(solution.types), *solution.types))
        parts += [f"{keyword}\n{len(solution.values)}\n{types}\n", printed(solution.values)]
    return "".join([*parts, "End\n"])


def _point_refs(container: Container) -> NDArray[np.int64]:
    if container.point_refs is not None:
        return container.point_refs
    return np.zeros(0 if container.points is None else len(container.points), np.int64)


# ---- binary ----


class _Binary:
    """A cursor over the bytes of a binary file that refuses to run past the end."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._at = 0
        if len(data) < 8:
            raise FormatError("it is truncated: no header")
        self._order = "<" if data[:4] == b"\x01\0\0\0" else ">"
        if self._integer(4) != 1:
            raise FormatError("it is not a GMF file: the first word is not 1")
        self._version = self._integer(4)
        if not 1 <= self._version <= 4:
            raise FormatError(f"version {self._version} is not known, only 1 to 4")
        self._real = "f4" if self._version == 1 else "f8"
        self._index = "i8" if self._version == 4 else "i4"
        self._offset_size = 8 if self._version >= 3 else 4

    def _take(self, dtype: np.dtype[Any], count: int) -> NDArray[Any]:
        end = self._at + dtype.itemsize * count
        if count < 0 or end > len(self._data):
            raise FormatError(f"it is truncated: {len(self._data)} bytes, {end} needed")
        array = np.frombuffer(self._data, dtype=dtype, count=count, offset=self._at)
        self._at = end
        return array

    def _integer(self, size: int) -> int:
        return int(self._take(np.dtype(f"{self._order}i{size}"), 1)[0])

    def _count(self) -> int:
        return self._integer(8 if self._version == 4 else 4)

    def container(self) -> Container:
        """Walk the chain of keywords."""
        result: Container | None = None
        names = {code: keyword for keyword, (code, _) in ENTITIES.items()}
        names |= {code: keyword for keyword, code in SOLUTIONS.items()}
        while (code := self._integer(4)) != _END:
            following = self._integer(self._offset_size)
            if code == _DIMENSION:
                result = Container(dim=_checked_dim(self._integer(4)))
            elif result is None:
                raise FormatError("its first keyword is not Dimension")
            elif code == _VERTICES:
                self._read_points(result)
            elif code in names:
                self._read_named(result, names[code])
            if following == 0:
                break
            if following < self._at:
                raise FormatError(f"the offset {following} points back: the file is damaged")
            self._at = following
        if result is None:
            raise FormatError("it has no Dimension")
        return result

    def _read_points(self, result: Container) -> None:
        layout = np.dtype(
            [("x", f"{self._order}{self._real}", (result.dim,)), ("r", self._order + self._index)]
        )
        rows = self._take(layout, self._count())
        result.points, result.point_refs = rows["x"].astype(np.float64), rows["r"].astype(np.int64)

    def _read_named(self, result: Container, keyword: str) -> None:
        count = self._count()
        if keyword in ENTITIES:
            width = ENTITIES[keyword][1]
            flat = self._take(np.dtype(self._order + self._index), count * width)
            result.tables[keyword] = flat.reshape(count, width).astype(np.int64)
            return
        types = [self._integer(4) for _ in range(self._integer(4))]
        width = sum(columns_of(types, result.dim))
        flat = self._take(np.dtype(self._order + self._real), count * width)
        result.solutions[keyword] = Solution(types, flat.reshape(count, width).astype(np.float64))


def _to_bytes(container: Container) -> bytes:
    records: list[tuple[int, bytes]] = []
    if container.points is not None:
        rows = np.empty(
            len(container.points), np.dtype([("x", "<f8", (container.dim,)), ("r", "<i4")])
        )
        rows["x"], rows["r"] = container.points, _point_refs(container)
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
