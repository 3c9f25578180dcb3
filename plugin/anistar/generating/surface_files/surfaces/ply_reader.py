"""PLY, text or binary of either byte order: points, polygons and edges with any properties.

References
----------
Greg Turk, "The PLY Polygon File Format", 1994.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ....base.arrays import AnyArray
from ....formats.content.raw import not_read
from ....formats.parsing.cursor import Cursor, Order
from ....formats.parsing.reading import reading
from ..content.raw_surface import Faces, RawSurface
from .ply_rows import Property, binary_rows, text_rows

_FORMATS: dict[str, Order | None] = {
    "ascii": None,
    "binary_little_endian": "<",
    "binary_big_endian": ">",
}
_LISTS = ("vertex_indices", "vertex_index")
_LONGEST_COUNT = 19


@dataclass
class Element:
    """What the header says of one kind of element: how many there are, and what each has."""

    name: str
    count: int
    properties: list[Property] = field(default_factory=list)


def read(path: Path) -> RawSurface:
    """Read points, polygons and edges.

    Raises
    ------
    FormatError
        If it is truncated or its header is damaged; names the line.
    """
    with reading(path):
        data = path.read_bytes()
        cursor = Cursor(data)
        order, elements = _header(cursor)
        values: dict[str, dict[str, AnyArray | Faces]] = {}
        if order is not None:
            cursor.order = order
        words = None if order is not None else data[cursor.at :].split()
        for element in elements:
            if element.name in values:
                raise ValueError(f"it has two elements {element.name}: only one can be meant")
            if words is None:
                rows = binary_rows(cursor, element.name, element.count, element.properties)
            else:
                rows = text_rows(words, element.name, element.count, element.properties)
            values[element.name] = rows
        return _surface(values)


def _header(cursor: Cursor) -> tuple[Order | None, list[Element]]:
    if cursor.line() != "ply":
        raise ValueError("it does not begin with the word ply")
    elements: list[Element] = []
    order: Order | None = None
    has_format = False
    number = 1
    while True:
        if cursor.is_at_end:
            raise ValueError("it is truncated within its header")
        words = cursor.line().split()
        number += 1
        if words[:1] == ["end_header"]:
            break
        if words[:1] == ["format"] and len(words) == 3 and words[1] in _FORMATS:
            order, has_format = _FORMATS[words[1]], True
        elif words[:1] == ["element"] and len(words) == 3 and _is_count(words[2]):
            elements.append(Element(words[1], int(words[2])))
        elif words[:1] == ["property"] and elements:
            elements[-1].properties.append(Property.of(words[1:], number))
        elif words and words[0] not in ("comment", "obj_info"):
            raise ValueError(f"line {number}: {' '.join(words)[:60]!r} is not known in a header")
    if not has_format:
        raise ValueError("its header has no format")
    return order, elements


def _is_count(word: str) -> bool:
    return word.isdecimal() and len(word) <= _LONGEST_COUNT


def _surface(values: dict[str, dict[str, AnyArray | Faces]]) -> RawSurface:
    vertices, faces = values.pop("vertex", {}), values.pop("face", {})
    try:
        points = np.stack([np.asarray(vertices[axis], np.float64) for axis in "xyz"], axis=1)
    except KeyError as error:
        raise ValueError(f"its vertices have no property {error.args[0]}") from error
    raw = RawSurface(points)
    lists = [faces.pop(name) for name in _LISTS if name in faces]
    if faces and not lists:
        raise ValueError(f"its faces have no property {_LISTS[0]}")
    if lists and isinstance(lists[0], Faces):
        raw.faces = lists[0]
    edges = values.pop("edge", {})
    if {"vertex1", "vertex2"} <= edges.keys():
        ends = [np.asarray(edges[name], np.int64) for name in ("vertex1", "vertex2")]
        raw.edges = np.stack(ends, axis=1)
    raw.warnings += not_read(list(faces), what="property of faces", why="no place")
    raw.warnings += not_read(list(values), what="element")
    return raw
