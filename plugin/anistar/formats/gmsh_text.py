"""The text form of Gmsh 2.x, read here.

Differs from meshio's reader: element data may cover some of the elements only, as Gmsh writes it,
and is found by element number.

References
----------
Gmsh reference manual, "MSH file format version 2".
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import FormatError
from .raw import Array, Block, RawMesh
from .text_rows import integers, parsed

# Gmsh's element type -> kind and number of nodes.
_KINDS = {
    1: ("line", 2),
    2: ("triangle", 3),
    3: ("quad", 4),
    4: ("tetra", 4),
    5: ("hexahedron", 8),
    6: ("wedge", 6),
    7: ("pyramid", 5),
    8: ("line3", 3),
    9: ("triangle6", 6),
    11: ("tetra10", 10),
    15: ("vertex", 1),
}
_LABELS = "anistar:labels "
_SECTION = re.compile(r"^\$(\w+)[ \t\r]*\n(.*?)^\$End\1", re.MULTILINE | re.DOTALL)


def is_text_2(path: Path) -> bool:
    """Tell whether the file is text of version 2."""
    with path.open("rb") as file:
        head = file.read(200).split()
    return len(head) > 2 and head[0] == b"$MeshFormat" and head[1][:2] == b"2." and head[2] == b"0"


def read(path: Path) -> RawMesh:
    """Read mesh, physical names, node data and element data.

    Raises
    ------
    FormatError
        If the file is truncated or damaged.
    """
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
        return _read(text)
    except OSError as error:
        raise FormatError(f"cannot read {path}: {error.strerror or error}") from error
    except (ValueError, IndexError) as error:
        raise FormatError(f"cannot read {path}: {error}") from error


def _read(text: str) -> RawMesh:
    sections = _SECTION.findall(text)
    content = dict(sections)
    opened = re.findall(r"^\$(?!End)(\w+)", text, re.MULTILINE)
    if len(opened) != len(sections):
        raise ValueError(f"it is truncated: the section {opened[len(sections)]} does not end")
    for name in ("Nodes", "Elements"):
        if name not in content:
            raise ValueError(f"it has no section {name}")
    nodes = _rows("Nodes", parsed(content["Nodes"]), 4)
    index = _Numbers("node", nodes[:, 0])
    labels = _labels(content.get("Comments", ""))
    blocks, numbers = _elements(parsed(content["Elements"]), index, ours=labels is not None)
    raw = RawMesh(
        nodes[:, 1:4].copy(), blocks, names=physical_names(content.get("PhysicalNames", ""))
    )
    raw.labels = labels or set()
    for name, body in sections:
        if name == "NodeData":
            _add_node_data(raw, index, body)
        elif name == "ElementData":
            _add_element_data(raw, numbers, body)
    return raw


def comment(labels: list[str]) -> str:
    """Return a section that tells which data are labels; Gmsh itself stores doubles only."""
    return f"$Comments\n{_LABELS}{json.dumps(labels)}\n$EndComments\n"


def _labels(body: str) -> set[str] | None:
    """Return what `comment` noted, None in a file that is not ours."""
    for line in body.splitlines():
        if line.startswith(_LABELS):
            return set(json.loads(line.removeprefix(_LABELS)))
    return None


class _Numbers:
    """Find rows by the numbers that a file gives to its nodes or elements."""

    def __init__(self, what: str, numbers: NDArray[Any]) -> None:
        self._what = what
        numbers = integers(np.asarray(numbers, dtype=np.float64))
        self._order = np.argsort(numbers, kind="stable")
        self._sorted = numbers[self._order]

    def rows(self, wanted: NDArray[Any]) -> Array:
        """Return the row of each number; raise on an unknown one."""
        wanted = integers(np.asarray(wanted, dtype=np.float64))
        at = np.searchsorted(self._sorted, wanted).clip(max=max(len(self._sorted) - 1, 0))
        unknown = self._sorted[at] != wanted if len(self._sorted) else np.ones(wanted.shape, bool)
        if unknown.any():
            raise ValueError(f"it refers to {self._what} {wanted[unknown][0]}, which is not given")
        return np.asarray(self._order[at])


def _rows(name: str, numbers: Array, width: int) -> Array:
    count = int(integers(numbers[:1])[0]) if len(numbers) else 0
    if len(numbers) != 1 + count * width:
        raise ValueError(f"{name} announces {count} rows, but {len(numbers) - 1} numbers follow")
    return np.asarray(numbers[1:].reshape(count, width))


def physical_names(body: str) -> dict[tuple[int, int], str]:
    """Return the names in the body of the section PhysicalNames by (dim, tag)."""
    found = re.findall(r'^\s*(\d+)\s+(-?\d+)\s+"(.*)"', body, re.MULTILINE)
    return {(int(dim), int(tag)): name for dim, tag, name in found}


def _elements(numbers: Array, index: _Numbers, *, ours: bool) -> tuple[list[Block], list[Array]]:
    """Return runs of elements of equal type, and the number of each element.

    Without physical groups the numbers of the geometric entities are the only tags; in a file
    that we wrote they mean nothing.
    """
    values = integers(numbers)
    blocks: list[Block] = []
    labels: list[Array] = []
    at = 1
    while at < len(values):
        if at + 3 > len(values) or int(values[at + 1]) not in _KINDS:
            raise ValueError(f"Elements: type {values[at + 1 : at + 2]} is not known")
        kind, n_nodes = _KINDS[int(values[at + 1])]
        n_tags = int(values[at + 2])
        run = _run(values, at, 3 + n_tags + n_nodes)
        rows = index.rows(run[:, 3 + n_tags :])
        entity = run[:, 4] if n_tags > 1 else np.zeros(len(run), np.int64)
        physical = run[:, 3] if n_tags > 0 else np.zeros(len(run), np.int64)
        blocks.append(Block(kind, rows, physical, {"entity": entity}))
        labels.append(run[:, 0])
        at += run.size
    if sum(len(label) for label in labels) != values[0]:
        raise ValueError(f"Elements announces {values[0]} rows, another number follows")
    named = ours or any(np.any(block.tags) for block in blocks if block.tags is not None)
    for block in blocks:
        entity = block.data.pop("entity")
        block.tags = block.tags if named else entity
    return blocks, labels


def _run(values: Array, at: int, width: int) -> Array:
    """Return the longest run of rows from `at` with the type and tag count of its first row."""
    ahead = 16
    while True:
        ahead = min(2 * ahead, (len(values) - at) // width)
        if ahead == 0:
            raise ValueError("Elements ends within a row")
        rows = values[at : at + ahead * width].reshape(ahead, width)
        same = (rows[:, 1] == rows[0, 1]) & (rows[:, 2] == rows[0, 2])
        if not same.all():
            return np.asarray(rows[: int(np.argmin(same))])
        if ahead == (len(values) - at) // width:
            return np.asarray(rows)


def _data(body: str) -> tuple[str, Array, Array]:
    """Return name, numbers and values of the first time step in a data section."""
    lines = body.split("\n")
    n_strings = int(lines[0])
    name = lines[1].strip().strip('"')
    at = 1 + n_strings
    at += 1 + int(lines[at])
    integers = [int(line) for line in lines[at + 1 : at + 1 + int(lines[at])]]
    components, count = integers[1], integers[2]
    rows = parsed("\n".join(lines[at + 1 + len(integers) :]))
    table = _rows(name, np.r_[count, rows], components + 1)
    values = table[:, 1] if components == 1 else table[:, 1:]
    return name, table[:, 0], values


def _add_node_data(raw: RawMesh, index: _Numbers, body: str) -> None:
    name, numbers, values = _data(body)
    full = np.full((len(raw.points), *values.shape[1:]), np.nan)
    full[index.rows(numbers)] = values
    raw.point_data[name] = full


def _add_element_data(raw: RawMesh, labels: list[Array], body: str) -> None:
    """Spread element data over the blocks; elements that it leaves out get NaN."""
    name, numbers, values = _data(body)
    rows = _Numbers("element", np.concatenate(labels)).rows(numbers)
    full = np.full((sum(len(label) for label in labels), *values.shape[1:]), np.nan)
    full[rows] = values
    starts = np.cumsum([0, *(len(label) for label in labels)])
    for block, start in zip(raw.blocks, starts, strict=False):
        block.data[name] = full[start : start + len(block.rows)]
