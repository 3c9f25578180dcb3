"""Wavefront OBJ: points, polygons, lines; its objects, groups and materials are tags.

Of the three, those that differ among the faces name the tags: faces of one object in two materials
have two tags called as the materials. Texture coordinates, normals and smoothing say nothing of
the shape.

References
----------
Wavefront, "Object Files", version 3.0, appendix B1 of the Advanced Visualizer manual.
"""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np

from ....formats.content.raw import not_read
from ....formats.parsing.reading import reading
from ..content.lines import Lines
from ..content.raw_surface import Faces, RawSurface

_GROUPINGS = ("o", "g", "usemtl")
_SILENT = ("vt", "vn", "s", "mtllib", "lod", "shadow_obj", "trace_obj", "bevel", "c_interp")

_Grouping = tuple[str, ...]


class _Content:
    """What was read so far."""

    def __init__(self, lines: Lines) -> None:
        self.lines = lines
        self.points: list[list[float]] = []
        self.indices: list[int] = []
        self.sizes: list[int] = []
        self.grouping: dict[str, str] = dict.fromkeys(_GROUPINGS, "")
        self.groupings: dict[_Grouping, int] = {}
        self.owners: list[int] = []
        self.edges: list[tuple[int, int]] = []
        self.kept: list[int] = []
        self.skipped: dict[str, int] = {}

    def read(self, words: list[str]) -> None:
        """Read one statement."""
        keyword, rest = words[0], words[1:]
        if keyword == "v":
            if len(rest) < 3:
                raise self.lines.error("a point has three coordinates")
            self.points.append(self.lines.floats(rest[:3]))
        elif keyword in ("f", "fo"):
            row = self._points_in(rest)
            self.indices += row
            self.sizes.append(len(row))
            key = tuple(self.grouping.values())
            self.owners.append(self.groupings.setdefault(key, len(self.groupings)))
        elif keyword == "l":
            row = self._points_in(rest)
            self.edges += itertools.pairwise(row)
        elif keyword == "p":
            self.kept += self._points_in(rest)
        elif keyword in _GROUPINGS:
            self.grouping[keyword] = " ".join(rest)
        elif keyword not in _SILENT:
            self.skipped[keyword] = self.skipped.get(keyword, 0) + 1

    def _points_in(self, words: list[str]) -> list[int]:
        """Return points from 0; negative ones count from the last point before."""
        n, rows = len(self.points), []
        for word in words:
            number = self.lines.integer(word.partition("/")[0])
            row = number - 1 if number > 0 else n + number
            if number == 0 or row < 0:
                raise self.lines.error(f"there is no point {number}, {n} come before")
            rows.append(row)
        return rows


def read(path: Path) -> RawSurface:
    """Read faces, lines and points with their groups.

    Raises
    ------
    FormatError
        If something is no number or refers to no point; names the line.
    """
    with reading(path):
        lines = Lines(path.read_bytes(), continuation="\\")
        content = _Content(lines)
        for words in lines:
            content.read(words)
        return _surface(content)


def _surface(content: _Content) -> RawSurface:
    raw = RawSurface(np.array(content.points, np.float64).reshape(-1, 3))
    raw.faces = Faces(np.array(content.indices, np.int64), np.array(content.sizes, np.int64))
    raw.edges = np.array(content.edges, np.int64).reshape(-1, 2)
    raw.points_kept = np.array(content.kept, np.int64)
    names = _names(list(content.groupings))
    if any(names):
        tag_of = {name: tag for tag, name in enumerate(dict.fromkeys(names), start=1)}
        raw.tags = np.array([tag_of[name] for name in names])[content.owners]
        raw.names = {(2, tag): name for name, tag in tag_of.items() if name}
    raw.warnings += not_read(
        [f"{word} ({n} times)" for word, n in content.skipped.items()], what="statement"
    )
    return raw


def _names(groupings: list[_Grouping]) -> list[str]:
    """Return the name of each grouping, of the parts that differ, or of the first that is there."""
    varying = [k for k in range(len(_GROUPINGS)) if len({g[k] for g in groupings}) > 1]
    if not varying:
        return [next((part for part in (g[1], g[0], g[2]) if part), "") for g in groupings]
    return ["/".join(g[k] for k in varying if g[k]) for g in groupings]
