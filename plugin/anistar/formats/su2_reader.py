"""SU2's native mesh: keys with a value each, and rows of numbers behind some of them.

Everything is counted in such a file, so that a part that is missing is noticed.

References
----------
SU2 documentation, "Mesh File": elements by their VTK type, one marker for each boundary.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from ..base.arrays import AnyArray, Floats
from .content.kinds import KINDS
from .content.raw import REFUSED, Block, RawMesh, not_read
from .parsing.reading import reading
from .parsing.rows import leading_rows
from .parsing.text_rows import integers, parsed
from .vtk.cells import kind_of

_KEY = re.compile(r"^[ \t]*([A-Z_0-9]+)[ \t]*=[ \t]*(.*)$", re.MULTILINE)
_NEEDED = ("NDIME", "NELEM", "NPOIN", "NMARK")
_OF_MARKERS = ("MARKER_TAG", "MARKER_ELEMS")
_UNREAD = ("SEND_RECV", "NPERIODIC", "NZONE", "IZONE")

Entry = tuple[str, str, str]
"""A key, what follows it in its line, and the lines until the next key."""


def read(path: Path) -> RawMesh:
    """Read cells, points and markers; a marker that is no number gets a free one and a name."""
    with reading(path):
        return _mesh(path.read_text(encoding="utf-8-sig", errors="replace"))


def _mesh(text: str) -> RawMesh:
    if not text[-1:].isspace():
        raise ValueError(
            "it is truncated: its last line does not end. If it is whole, end it with a line break"
        )
    entries = _entries(text)
    single = _single(entries)
    dim = _count(single["NDIME"])
    if dim not in (2, 3):
        raise ValueError(f"NDIME is {dim}, it must be 2 or 3")
    cells = [Block(*run) for run in _elements(single["NELEM"], dim)]
    markers = _markers(entries, dim - 1)
    if len(markers) != _count(single["NMARK"]):
        raise ValueError(f"NMARK announces {single['NMARK'][1]} markers, {len(markers)} follow")
    tags = _tags([name for name, _ in markers])
    blocks = [
        Block(kind, rows, np.full(len(rows), tag, np.int64))
        for tag, (_, runs) in zip(tags, markers, strict=True)
        for kind, rows in runs
    ]
    raw = RawMesh(_points(single["NPOIN"], dim), [*cells, *blocks])
    raw.names = {
        (dim - 1, tag): name
        for tag, (name, _) in zip(tags, markers, strict=True)
        if name != str(tag)
    }
    known = {*_NEEDED, *_OF_MARKERS, *_UNREAD}
    raw.warnings += not_read(sorted({key for key, _, _ in entries} - known))
    return raw


def _entries(text: str) -> list[Entry]:
    clean = re.sub(r"%.*", "", text)
    found = list(_KEY.finditer(clean))
    if not found or clean[: found[0].start()].strip():
        raise ValueError("it does not begin with a key such as NDIME=")
    ends = [match.start() for match in found[1:]] + [len(clean)]
    return [
        (match[1], match[2].strip(), clean[match.end() : end])
        for match, end in zip(found, ends, strict=True)
    ]


def _single(entries: list[Entry]) -> dict[str, Entry]:
    """Return the entries of which there must be exactly one."""
    single: dict[str, Entry] = {}
    for entry in entries:
        if entry[0] in single:
            raise ValueError(f"it has two parts {entry[0]}=: only one can be meant")
        if entry[0] in _NEEDED:
            single[entry[0]] = entry
    for key in _NEEDED:
        if key not in single and key == "NMARK":
            raise ValueError("NMARK= is missing: it is truncated, or needs NMARK= 0 at its end")
        if key not in single:
            raise ValueError(f"it is truncated: {key}= is missing")
    return single


def _count(entry: Entry) -> int:
    # behind NPOIN there may be the number of points without those of other processes
    first = entry[1].split()[:1]
    if not first or not first[0].isdecimal() or len(first[0]) > len(str(2**53)):
        raise ValueError(f"{entry[0]}= {entry[1][:40]!r} is no count")
    return int(first[0])


def _table(entry: Entry, widths: tuple[int, ...]) -> Floats:
    """Return the rows of an entry; each has one of the given numbers of columns."""
    try:
        numbers = parsed(entry[2])
    except ValueError as error:
        raise ValueError(f"{entry[0]} {error}") from error
    count = _count(entry)
    for width in widths:
        if len(numbers) == count * width:
            return numbers.reshape(count, width)
    raise ValueError(
        f"{entry[0]} announces {count} rows of {' or '.join(map(str, widths))} numbers, "
        f"but {len(numbers)} numbers follow"
    )


def _elements(entry: Entry, dim: int) -> list[tuple[str, AnyArray]]:
    """Return runs of one kind and their points.

    The type comes first, and a running number ends all rows or none.
    """
    try:
        values = integers(parsed(entry[2]))
    except ValueError as error:
        raise ValueError(f"{entry[0]} {error}") from error
    for n_behind in (1, 0):
        runs = _runs(entry, values, dim, n_behind)
        if sum(len(rows) for _, rows in runs) == _count(entry):
            return runs
    raise ValueError(f"{entry[0]} announces {_count(entry)} rows of elements, others follow")


def _runs(entry: Entry, values: AnyArray, dim: int, n_behind: int) -> list[tuple[str, AnyArray]]:
    """Return the runs of rows with as many numbers behind the points, none if they do not fit."""
    runs, at = [], 0
    while at < len(values):
        kind = kind_of(int(values[at]))
        if kind in REFUSED:
            raise ValueError(f"{entry[0]} holds elements of type {kind!r}; {REFUSED[kind]}")
        if kind not in KINDS or KINDS[kind].dim != dim:
            if n_behind:
                return []
            raise ValueError(f"{entry[0]} has elements of type {values[at]}")
        n_nodes = KINDS[kind].n_nodes
        width = 1 + n_nodes + n_behind
        if at + width > len(values):
            return []
        rows = leading_rows(values, at, width, [0])
        runs.append((kind, rows[:, 1 : 1 + n_nodes]))
        at += rows.size
    return runs


def _points(entry: Entry, dim: int) -> Floats:
    return np.ascontiguousarray(_table(entry, (dim + 1, dim, dim + 2))[:, :dim])


def _markers(entries: list[Entry], dim: int) -> list[tuple[str, list[tuple[str, AnyArray]]]]:
    found: list[tuple[str, list[tuple[str, AnyArray]]]] = []
    tag, seen = "", set()
    for entry in entries:
        if entry[0] == "MARKER_TAG":
            tag = entry[1]
            if not tag or tag in seen:
                raise ValueError(f"the marker {tag!r} has no name, or comes twice")
            seen.add(tag)
        elif entry[0] == "MARKER_ELEMS":
            if not tag:
                raise ValueError("MARKER_ELEMS= comes without a MARKER_TAG=")
            found.append((tag, _elements(entry, dim)))
            tag = ""
    if tag:
        raise ValueError(f"it is truncated: the marker {tag!r} has no MARKER_ELEMS=")
    return found


def _tags(markers: list[str]) -> list[int]:
    """Return the number of each marker: its own, or the next one that is free."""
    own = {int(name) for name in markers if _is_tag(name)}
    free = (number for number in range(1, len(own) + len(markers) + 1) if number not in own)
    return [int(name) if _is_tag(name) else next(free) for name in markers]


def _is_tag(name: str) -> bool:
    digits = name.removeprefix("-")
    return digits.isdecimal() and len(digits) < len(str(2**31)) and str(int(name)) == name
