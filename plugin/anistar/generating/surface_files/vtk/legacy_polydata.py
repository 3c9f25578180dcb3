"""Legacy VTK files with a surface, as text or binary, of versions 1 to 5."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ....base.arrays import AnyArray
from ....formats.content.raw import not_read
from ....formats.parsing.cursor import Cursor
from ....formats.parsing.reading import reading
from ....formats.vtk.legacy_arrays import Arrays, count_in, word_in
from ....formats.vtk.legacy_numbers import LegacyNumbers
from ..content.raw_surface import Faces, RawSurface
from ..content.sized_rows import sized_rows
from .polydata import surface_of_cells

_CELLS = {
    "VERTICES": "verts",
    "LINES": "lines",
    "POLYGONS": "polys",
    "TRIANGLE_STRIPS": "strips",
}


def holds_polydata(path: Path) -> bool:
    """Return whether a legacy VTK file says that it holds a surface."""
    with reading(path), path.open("rb") as file:
        head = file.read(2048).upper()
    return b"DATASET POLYDATA" in b" ".join(head.split())


def read(path: Path) -> RawSurface:
    """Read the cells and their tags.

    Raises
    ------
    FormatError
        If the file is damaged.
    """
    with reading(path):
        cursor = Cursor(path.read_bytes(), ">")
        _, _, encoding = (cursor.line() for _ in range(3))
        numbers = LegacyNumbers(cursor, is_text=encoding.upper() == "ASCII")
        numbers.next_words()  # DATASET
        return _surface(numbers)


def _surface(numbers: LegacyNumbers) -> RawSurface:
    points: AnyArray | None = None
    cells: dict[str, Faces] = {}
    current = Arrays()
    data: dict[str, Arrays] = {}
    while words := numbers.next_words():
        section = words[0].upper()
        if section == "POINTS":
            n = count_in(words, 1)
            points = numbers.read(word_in(words, 2), 3 * n).reshape(n, 3)
        elif section in _CELLS:
            cells[_CELLS[section]] = _cells(words, numbers)
        elif section in ("POINT_DATA", "CELL_DATA"):
            current = data[section] = Arrays(section, count_in(words, 1))
        else:
            current.read(words, numbers)
    if points is None:
        raise ValueError("it is truncated: its points are missing")
    arrays = data.get("CELL_DATA", Arrays()).kept
    raw = surface_of_cells(points, cells, arrays)
    skipped = [name for section in data.values() for name in section.skipped]
    raw.warnings += not_read(skipped, what="array", why="no tags")
    return raw


def _cells(words: list[str], numbers: LegacyNumbers) -> Faces:
    n, length = count_in(words, 1), count_in(words, 2)
    if numbers.peek().upper().startswith("OFFSETS"):
        ends = numbers.read(word_in(numbers.next_words(), 1), n).astype(np.int64)
        indices = numbers.read(word_in(numbers.next_words(), 1), length)
        sizes = np.diff(ends)
        if n == 0 or ends[0] != 0 or (sizes < 0).any() or ends[-1] != length:
            raise ValueError(f"the offsets of its {words[0]} do not fit to {length} points")
        return Faces(indices.astype(np.int64), sizes)
    values = numbers.read("int", length)
    rows, at = [], 0
    for _ in range(n):
        row, at = sized_rows(values, at)
        rows.append(row)
    indices = np.concatenate([np.zeros(0, np.int64), *rows])
    return Faces(indices.astype(np.int64), np.array([len(row) for row in rows], np.int64))
