"""OFF of Geomview and its followers, text or binary: points and polygons.

Normals, colours and texture coordinates that a prefix of the word OFF announces are left out.

References
----------
Geomview manual, "OFF Files": [ST][C][N][4][n]OFF [BINARY]; binary files are big endian, but some
programs write them in the order of their CPU, which the counts show.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from ....base.arrays import AnyArray
from ....formats.parsing.cursor import Cursor
from ....formats.parsing.reading import reading
from ..content.lines import Lines
from ..content.raw_surface import Faces, RawSurface

_HEADER = re.compile(rb"\s*(ST)?(C)?(N)?(4)?(n)?OFF\b[^\S\n]*(BINARY)?")
_N_COUNTS = 3


def read(path: Path) -> RawSurface:
    """Read points and polygons.

    Raises
    ------
    FormatError
        If it is truncated, or of another dimension; names the line.
    """
    with reading(path):
        data = path.read_bytes()
        header = _HEADER.match(data)
        if header is None:
            raise ValueError("it does not begin with the word OFF")
        texture, colour, normal, four, many, is_binary = header.groups()
        if four or many:
            raise ValueError("its points have another number of coordinates than three")
        if is_binary:
            width = 3 + 3 * bool(normal) + 4 * bool(colour) + 2 * bool(texture)
            return _binary(data, header.end(), width)
        return _text(Lines(data[header.end() :]))


def _text(lines: Lines) -> RawSurface:
    n_points, n_faces, _ = lines.counts(_N_COUNTS)
    points = [_first(lines, lines.next(), 3) for _ in range(n_points)]
    indices: list[int] = []
    sizes, n_coloured = [], 0
    for _ in range(n_faces):
        words = lines.next()
        size = lines.integer(words[0])
        row = lines.integers(words[1 : size + 1]) if size > 0 else []
        if len(row) < size:
            raise lines.error(f"a face of {size} points has {len(row)}")
        indices += row
        sizes.append(len(row))
        n_coloured += len(words) > size + 1
    raw = RawSurface(np.array(points, np.float64).reshape(-1, 3))
    raw.faces = Faces(np.array(indices, np.int64), np.array(sizes, np.int64))
    _tell_colours(raw, n_coloured)
    return raw


def _first(lines: Lines, words: list[str], n: int) -> list[float]:
    if len(words) < n:
        raise lines.error(f"a point has {len(words)} coordinates, not {n}")
    return lines.floats(words[:n])


def _binary(data: bytes, at: int, width: int) -> RawSurface:
    cursor = Cursor(data, ">")
    cursor.at = start = data.find(b"\n", at) + 1
    n_points, n_faces, _ = cursor.take("i4", _N_COUNTS).tolist()
    if not 0 <= n_points * width * 4 <= len(data):  # CGAL and others write as their CPU does
        cursor.order, cursor.at = "<", start
        n_points, n_faces, _ = cursor.take("i4", _N_COUNTS).tolist()
    points = cursor.take("f4", n_points * width).reshape(-1, width)[:, :3]
    faces, n_coloured = _binary_faces(cursor, n_faces)
    raw = RawSurface(points.astype(np.float64), faces)
    _tell_colours(raw, n_coloured)
    return raw


def _binary_faces(cursor: Cursor, n_faces: int) -> tuple[Faces, int]:
    """Return the faces, each its size, its points, and the number of its colours and those.

    Some programs leave the number of colours out where there are none.
    """
    words = cursor.take("i4", (len(cursor.data) - cursor.at) // 4)
    faces, n_coloured, end = _rows(words, n_faces, has_colours=True)
    if len(faces) < n_faces or end != len(words):
        plain, _, plain_end = _rows(words, n_faces, has_colours=False)
        if len(plain) == n_faces and plain_end == len(words):
            return plain, 0
    if len(faces) < n_faces:
        raise ValueError(f"it is truncated: {len(faces)} of {n_faces} faces are there")
    return faces, n_coloured


def _rows(words: AnyArray, n_faces: int, *, has_colours: bool) -> tuple[Faces, int, int]:
    """Return the faces that are whole, how many of them have colours, and where they end."""
    parts: list[AnyArray] = []
    n_coloured = at = 0
    while len(parts) < n_faces and at < len(words):
        end = at + 1 + int(words[at])
        n_colours = int(words[end]) if has_colours and at < end < len(words) else 0
        is_whole = at < end and end + n_colours + has_colours <= len(words) and n_colours >= 0
        if not is_whole:
            break
        parts.append(words[at + 1 : end])
        n_coloured += n_colours > 0
        at = end + n_colours + has_colours
    indices = np.concatenate([np.zeros(0, np.int64), *parts]).astype(np.int64)
    sizes = np.array([len(part) for part in parts], np.int64)
    return Faces(indices, sizes), n_coloured, at


def _tell_colours(raw: RawSurface, n_coloured: int) -> None:
    if n_coloured:
        raw.warnings.append(f"the colours of {n_coloured} face(s) are not read")
