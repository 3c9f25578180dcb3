"""Legacy VTK files with an unstructured grid, as text or binary, of versions 1 to 5.

The format has no mark at its end. In the files that we write the tags come last, and a title says
so; of others nobody can tell whether they are whole, which is a warning.

References
----------
VTK User's Guide, "VTK File Formats", "Simple Legacy Formats"; version 5 has offsets and
connectivity in the place of rows.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ...base.arrays import AnyArray
from ..content.raw import RawMesh, not_read
from ..content.tag_arrays import TAGS, read_tagged
from ..parsing.cursor import Cursor
from .cells import blocks_of, ends_of_rows
from .legacy_arrays import Arrays, count_in, word_in
from .legacy_numbers import LegacyNumbers

OWN_TITLE = f"written by anistar through meshio, {TAGS} comes last"
_LARGEST_VERSION = 5


def read(path: Path) -> RawMesh:
    """Read a mesh with its tags and fields.

    Raises
    ------
    FormatError
        If the file is damaged or holds another kind of data.
    """
    return read_tagged(path, _mesh)


@dataclass
class _Grid:
    """What was read so far; `data` is by the name of the section."""

    points: AnyArray | None = None
    rows: AnyArray | None = None
    ends: AnyArray | None = None
    types: AnyArray | None = None
    data: dict[str, Arrays] = field(default_factory=dict)

    def length(self, section: str) -> int:
        """Return how many rows the arrays of a section have."""
        entities = self.points if section == "POINT_DATA" else self.types
        return 0 if entities is None else len(entities)


def _mesh(data: bytes) -> RawMesh:
    cursor = Cursor(data, ">")
    version, title, encoding = (cursor.line() for _ in range(3))
    numbers = LegacyNumbers(cursor, is_text=encoding.upper() == "ASCII")
    _check_head(version, encoding, dataset=" ".join(numbers.next_words()))
    grid, current = _Grid(), Arrays()
    while words := numbers.next_words():
        section = words[0].upper()
        if section in ("POINT_DATA", "CELL_DATA"):
            current = _opened(grid, section, words)
            # VTK writes names with codes, we do not
            current.has_codes = title != OWN_TITLE
        elif section in ("POINTS", "CELLS", "CELL_TYPES"):
            _read_geometry(grid, section, words, numbers)
        else:
            if not current.section and grid.points is not None and section != "METADATA":
                raise ValueError(f"{section[:40]} comes before POINT_DATA or CELL_DATA")
            current.read(words, numbers)
    return _raw(grid, title)


def _check_head(version: str, encoding: str, dataset: str) -> None:
    words = version.split()
    if words[:4] != ["#", "vtk", "DataFile", "Version"] or len(words) != 5:
        raise ValueError("it does not begin as a legacy VTK file")
    if not "1" <= words[4][:1] <= str(_LARGEST_VERSION):
        raise ValueError(f"version {words[4][:20]} is not known, only 1 to {_LARGEST_VERSION}")
    if encoding.upper() not in ("ASCII", "BINARY"):
        raise ValueError(f"it is neither ASCII nor BINARY but {encoding[:40]!r}")
    if dataset.upper().split() != ["DATASET", "UNSTRUCTURED_GRID"]:
        raise ValueError(f"it holds {dataset[:40]!r}: save it as an unstructured grid")


def _opened(grid: _Grid, section: str, words: list[str]) -> Arrays:
    if section in grid.data:
        raise ValueError(f"it has two sections {section}: only one can be meant")
    n = count_in(words, 1)
    if n != grid.length(section):
        raise ValueError(f"{section} is for {n} values, there are {grid.length(section)}")
    grid.data[section] = Arrays(section, n)
    return grid.data[section]


def _read_geometry(grid: _Grid, section: str, words: list[str], numbers: LegacyNumbers) -> None:
    name = {"POINTS": "points", "CELLS": "rows", "CELL_TYPES": "types"}[section]
    if getattr(grid, name) is not None:
        raise ValueError(f"it has two sections {section}: only one can be meant")
    n = count_in(words, 1)
    if section == "POINTS":
        grid.points = numbers.read(word_in(words, 2), 3 * n).reshape(n, 3)
    elif section == "CELL_TYPES":
        grid.types = numbers.read("int", n)
    elif numbers.peek().upper().startswith("OFFSETS"):
        ends = numbers.read(_type_in(numbers.next_words(), "OFFSETS"), n)
        if n == 0 or ends[0] != 0:
            raise ValueError("the offsets of its cells do not begin with 0")
        kind = _type_in(numbers.next_words(), "CONNECTIVITY")
        grid.ends, grid.rows = ends[1:], numbers.read(kind, count_in(words, 2))
    else:
        grid.rows = numbers.read("int", count_in(words, 2))


def _type_in(words: list[str], section: str) -> str:
    if len(words) != 2 or words[0].upper() != section:
        raise ValueError(f"{section} with a type is missing behind CELLS")
    return words[1]


def _raw(grid: _Grid, title: str) -> RawMesh:
    for name in ("points", "rows", "types"):
        if getattr(grid, name) is None:
            raise ValueError(f"it is truncated: its {name} are missing")
    on_points, on_cells = (
        grid.data.get(section, Arrays()).kept for section in ("POINT_DATA", "CELL_DATA")
    )
    rows, ends = np.asarray(grid.rows), grid.ends
    if ends is None:
        rows, ends = ends_of_rows(np.asarray(grid.types), rows)
    blocks = blocks_of(np.asarray(grid.types), ends, rows, on_cells)
    raw = RawMesh(np.asarray(grid.points, np.float64), blocks)
    raw.point_data = on_points
    skipped = [name for arrays in grid.data.values() for name in arrays.skipped]
    raw.warnings += not_read(skipped, what="array", why="no field")
    raw.six = "vtk"
    if title == OWN_TITLE:
        if TAGS not in on_cells:
            raise ValueError(f"it is truncated: the array {TAGS} is missing")
    else:
        raw.warnings.append(
            "legacy VTK has no mark at its end, so a file that was cut cannot be told: "
            f"{len(raw.points)} points and {len(ends)} cells were read"
        )
    return raw
