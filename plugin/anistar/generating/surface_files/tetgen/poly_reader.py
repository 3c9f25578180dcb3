"""The complexes of TetGen (`.poly`, `.smesh`) and the outlines of Triangle (`.poly`).

Points may be in a file `.node` of the same name. Markers are tags, regions keep their attribute as
tag, and their largest volume or area becomes a size: that of regular cells as large.

References
----------
TetGen user's manual, section 5.2, "File formats"; Triangle, "The .poly file format".
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ....base.arrays import AnyArray, Floats
from ....formats.parsing.numbering import Numbering
from ....formats.parsing.reading import reading
from ....formats.suffixes import suffix_of
from ....metric.kernels.elementary import power
from ...plc import PLC
from ...region import Region
from ..content.lines import Lines
from .poly_facets import PolyFacet, facets_of


@dataclass
class _Nodes:
    points: Floats
    numbers: Numbering
    n_marked: int


def read(path: Path, *, flatness: float) -> tuple[PLC, list[str]]:
    """Read a complex, and what of it was left out.

    Raises
    ------
    FormatError
        If the file is damaged, or a facet is no planar polygon; names the line or the facet.
    """
    with reading(path):
        lines = Lines(path.read_bytes())
        n_points, dim, n_attributes, has_marker = lines.counts(4)
        if n_points == 0:
            beside = path.with_suffix(".node")
            with reading(beside):
                apart = Lines(beside.read_bytes())
                nodes = _nodes(apart, *apart.counts(4))
        else:
            nodes = _nodes(lines, n_points, dim, n_attributes, has_marker)
        notes = []
        if nodes.n_marked:
            notes.append(f"the markers of {nodes.n_marked} point(s) are not read")
        if nodes.points.shape[1] == 2:
            return _outline(lines, nodes), notes
        is_short = suffix_of(path) == ".smesh"
        return _complex(lines, nodes, is_short=is_short, flatness=flatness, notes=notes), notes


def _nodes(lines: Lines, n: int, dim: int, n_attributes: int, has_marker: int) -> _Nodes:
    if dim not in (2, 3):
        raise lines.error(f"points have {dim} coordinates, not 2 or 3")
    numbers, points, n_marked = [], [], 0
    for _ in range(n):
        words = lines.next()
        if len(words) <= dim:
            raise lines.error(f"a point has a number and {dim} coordinates")
        numbers.append(lines.integer(words[0]))
        points.append(lines.floats(words[1 : dim + 1]))
        marker = words[dim + 1 + n_attributes :][:1] if has_marker else []
        n_marked += bool(marker) and marker[0] != "0"
    table = np.array(points, np.float64).reshape(-1, dim)
    return _Nodes(table, Numbering("point", np.array(numbers, np.float64)), n_marked)


def _outline(lines: Lines, nodes: _Nodes) -> PLC:
    """Return segments, holes and regions in the plane."""
    n, has_marker = lines.counts(2)
    ends, tags = [], []
    for _ in range(n):
        row = lines.integers(lines.next())
        if len(row) < 3:
            raise lines.error("a segment has a number and two points")
        ends.append(row[1:3])
        tags.append(row[3] if has_marker and len(row) > 3 else 0)
    edges = nodes.numbers.rows(np.array(ends, np.float64).reshape(-1, 2))
    holes, regions = _holes(lines, 2), _regions(lines, 2)
    free = np.setdiff1d(np.arange(len(nodes.points), dtype=np.int32), edges.astype(np.int32))
    return PLC(
        nodes.points,
        edges=edges,
        edge_tags=np.array(tags, np.int64),
        points_kept=free,
        holes=holes,
        regions=regions,
    )


def _complex(
    lines: Lines, nodes: _Nodes, *, is_short: bool, flatness: float, notes: list[str]
) -> PLC:
    n, has_marker = lines.counts(2)
    read_facet = _short_facet if is_short else _facet
    given = [read_facet(lines, nodes, bool(has_marker)) for _ in range(n)]
    facets, tags = facets_of(nodes.points, given)
    holes, regions = _holes(lines, 3), _regions(lines, 3)
    used = [index for facet in facets for loop in facet for index in loop]
    free = np.setdiff1d(np.arange(len(nodes.points), dtype=np.int32), np.array(used, np.int32))
    if len(free):
        notes.append(f"{len(free)} point(s) of no facet are points of the mesh")
    return PLC(
        nodes.points,
        facets=facets,
        facet_tags=tags,
        points_kept=free,
        holes=holes,
        regions=regions,
        flatness=flatness,
    )


def _polygon(lines: Lines, nodes: _Nodes, words: list[str]) -> tuple[tuple[int, ...], list[str]]:
    """Return the points of a polygon, which may go on in the next lines, and the words after."""
    size = lines.integer(words[0])
    if size < 1:
        raise lines.error(f"a polygon has {size} points")
    rest = words[1:]
    while len(rest) < size:
        rest = rest + lines.next()
    try:
        rows = nodes.numbers.rows(np.array(lines.integers(rest[:size]), np.float64))
    except ValueError as error:
        raise lines.error(str(error)) from None
    return tuple(rows.tolist()), rest[size:]


def _facet(lines: Lines, nodes: _Nodes, has_marker: bool) -> PolyFacet:
    n_polygons, n_holes, marker = lines.counts(3)
    if n_polygons < 1 or n_holes < 0:
        raise lines.error(f"a facet has {n_polygons} polygons and {n_holes} holes")
    polygons = [_polygon(lines, nodes, lines.next())[0] for _ in range(n_polygons)]
    holes = [lines.floats(lines.next()[1:4]) for _ in range(n_holes)]
    return PolyFacet(polygons, np.array(holes).reshape(-1, 3), marker if has_marker else 0)


def _short_facet(lines: Lines, nodes: _Nodes, has_marker: bool) -> PolyFacet:
    polygon, after = _polygon(lines, nodes, lines.next())
    marker = lines.integer(after[0]) if has_marker and after else 0
    return PolyFacet([polygon], np.zeros((0, 3)), marker)


def _holes(lines: Lines, dim: int) -> AnyArray:
    rows = []
    for _ in range(_announced(lines)):
        words = lines.next()
        if len(words) <= dim:
            raise lines.error(f"a hole has a number and {dim} coordinates")
        rows.append(lines.floats(words[1 : dim + 1]))
    return np.array(rows, np.float64).reshape(-1, dim)


def _regions(lines: Lines, dim: int) -> tuple[Region, ...]:
    regions = []
    for number in range(_announced(lines)):
        words = lines.next()
        if len(words) <= dim:
            raise lines.error(f"a region has a number and {dim} coordinates")
        values = lines.floats(words[1:])
        attribute = values[dim] if len(values) > dim else float(number + 1)
        if attribute != np.rint(attribute):
            raise lines.error(f"the attribute of a region is {attribute:g}, no integer for a tag")
        largest = values[dim + 1] if len(values) > dim + 1 else -1.0
        size = _size_of(largest, dim) if largest > 0 else None
        regions.append(Region(values[:dim], int(attribute), size))
    return tuple(regions)


def _size_of(measure: float, dim: int) -> float:
    """Return the length of the edges of a regular cell of a volume or an area."""
    of_unit_edges = np.sqrt(2.0) / 12 if dim == 3 else np.sqrt(3.0) / 4
    return float(power(float(measure / of_unit_edges), 1.0 / dim))


def _announced(lines: Lines) -> int:
    """Return how many rows a last part of the file has, which may be missing."""
    words = lines.next_or_none()
    return 0 if words is None else lines.integer(words[0])
