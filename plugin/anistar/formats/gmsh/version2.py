"""Nodes and elements of Gmsh's versions 2.x."""

from __future__ import annotations

import numpy as np

from ...base.arrays import AnyArray
from ..parsing.rows import leading_rows
from .elements import Elements, kind_and_width
from .streams import BinaryStream, Stream, TextStream

_TEXT_HEAD, _BINARY_HEAD = 3, 3
_NUMBER, _TYPE, _N_TAGS = 0, 1, 2


def read_nodes(stream: Stream) -> tuple[AnyArray, AnyArray]:
    """Return numbers and points."""
    count = counted(stream, "Nodes")
    numbers, points = stream.table(count, 3)
    stream.finish()
    return numbers, points


def counted(stream: Stream, name: str) -> int:
    """Return the count that stands alone in the first line of a section."""
    line = stream.line()
    longest = len(str(2**63))
    if not line.isdecimal() or len(line) > longest:
        raise ValueError(f"the section {name} begins with {line[:40]!r}, no count")
    return int(line)


def read_elements(stream: Stream) -> list[Elements]:
    """Return runs of elements of equal type and number of tags."""
    count = counted(stream, "Elements")
    if isinstance(stream, TextStream):
        return _from_text(stream, count)
    return _from_binary(stream, count)


def _from_text(stream: TextStream, count: int) -> list[Elements]:
    values = stream.all_ints()
    runs: list[Elements] = []
    at = n_read = 0
    while at < len(values):
        if at + _TEXT_HEAD > len(values):
            raise ValueError("Elements ends within a row")
        kind, n_nodes = kind_and_width(int(values[at + _TYPE]))
        n_tags = _checked_n_tags(int(values[at + _N_TAGS]))
        rows = leading_rows(values, at, _TEXT_HEAD + n_tags + n_nodes, [_TYPE, _N_TAGS])
        runs.append(_run(kind, rows[:, _NUMBER], rows[:, _TEXT_HEAD:], n_tags))
        at += rows.size
        n_read += len(rows)
    if n_read != count:
        raise ValueError(f"Elements announces {count} rows, {n_read} follow")
    return runs


def _from_binary(stream: BinaryStream, count: int) -> list[Elements]:
    """Read blocks of a type, a number of elements, and a number of tags.

    Gmsh itself writes a block for each element: those that look alike are read at once.
    """
    runs: list[Elements] = []
    n_read = 0
    while n_read < count:
        number, n_rows, n_tags = stream.peek_ints(_BINARY_HEAD).tolist()
        kind, n_nodes = kind_and_width(number)
        width = 1 + _checked_n_tags(n_tags) + n_nodes
        if n_rows == 1:
            whole = stream.alike_ints(_BINARY_HEAD + width, _BINARY_HEAD, most=count - n_read)
            rows = whole[:, _BINARY_HEAD:]
        elif n_rows > 1:
            stream.ints(_BINARY_HEAD)
            rows = stream.ints(n_rows * width).reshape(n_rows, width)
        else:
            raise ValueError(f"Elements has a block of {n_rows} elements")
        runs.append(_run(kind, rows[:, 0], rows[:, 1:], n_tags))
        n_read += len(rows)
    if n_read != count:
        raise ValueError(f"Elements announces {count} rows, {n_read} follow")
    stream.finish()
    return runs


def _checked_n_tags(n_tags: int) -> int:
    most = 1000  # of processes that share an element
    if not 0 <= n_tags <= most:
        raise ValueError(f"Elements: an element has {n_tags} tags")
    return n_tags


def _run(kind: str, numbers: AnyArray, rest: AnyArray, n_tags: int) -> Elements:
    none = np.zeros(len(numbers), np.int64)
    physical = rest[:, 0] if n_tags > 0 else none
    entity = rest[:, 1] if n_tags > 1 else none
    return Elements(kind, numbers, rest[:, n_tags:], physical, entity)
