"""Gmsh `.msh` of the versions 2.x, 4.0 and 4.1, in text and binary.

References
----------
Gmsh reference manual, "MSH file format" and its legacy versions.
"""

from __future__ import annotations

import codecs
import re
from dataclasses import dataclass, field
from pathlib import Path

from ...base.arrays import AnyArray
from ..content.notes import Names
from ..content.raw import RawMesh, not_read
from ..parsing.allowance import Allowance
from ..parsing.numbering import Numbering
from ..parsing.reading import reading
from . import version2, version4
from .data import (
    Data,
    Note,
    add_element_data,
    add_node_data,
    check_complete,
    last_steps,
    note_in,
    read_data,
)
from .elements import Elements, blocks_of, joined
from .streams import Header, Stream, sections

_NAME = re.compile(r'(\d{1,2})[ \t]+(-?\d{1,10})[ \t]+"(.*)"')
_VERSIONS = ("2", "2.0", "2.1", "2.2", "4", "4.0", "4.1")
_MANY = ("NodeData", "ElementData", "Comments")
_WITHOUT_CONTENT = (
    "MeshFormat",
    "MeshVersion",
    "Periodic",
    "PartitionedEntities",
    "GhostElements",
    "Parametrizations",
)


@dataclass
class _Content:
    """What was read so far; `runs` have the entity of each in version 4."""

    allowance: Allowance
    nodes: tuple[AnyArray, AnyArray] | None = None
    runs: list[Elements] | None = None
    placed: list[tuple[tuple[int, int], Elements]] | None = None
    groups: version4.Groups | None = None
    names: Names = field(default_factory=dict)
    note: Note | None = None
    data: dict[str, list[Data]] = field(default_factory=dict)
    skipped: list[str] = field(default_factory=list)


def read(path: Path) -> RawMesh:
    """Read a mesh with its physical names and data.

    Raises
    ------
    FormatError
        If the file is damaged or of another version.
    """
    with reading(path):
        return _mesh(path.read_bytes().removeprefix(codecs.BOM_UTF8))


def _mesh(data: bytes) -> RawMesh:
    header = Header.of(data)
    if header.version not in _VERSIONS:
        raise ValueError(f"version {header.version} is not known, only {', '.join(_VERSIONS)}")
    content, seen = _Content(Allowance(len(data))), set()
    for name, stream in sections(data, header):
        if name in seen and name not in _MANY:
            raise ValueError(f"it has two sections {name}: only one can be meant")
        seen.add(name)
        _read(content, name, stream, header)
    return _raw(content)


def _read(content: _Content, name: str, stream: Stream, header: Header) -> None:
    is_old = header.version[0] == "2"
    version = version4.version_of(header.version)
    if name == "Nodes":
        content.nodes = (
            version2.read_nodes(stream) if is_old else version4.read_nodes(stream, version)
        )
    elif name == "Elements" and is_old:
        content.runs = version2.read_elements(stream)
    elif name == "Elements":
        content.placed = version4.read_elements(stream, version)
    elif name == "Entities" and not is_old:
        content.groups = version4.read_entities(stream, version)
    elif name == "PhysicalNames":
        content.names = _names(stream)
    elif name in ("NodeData", "ElementData"):
        content.data.setdefault(name, []).append(read_data(stream))
    elif name == "Comments":
        content.note = note_in(stream.rest()) or content.note
    else:
        stream.rest()
        if name not in _WITHOUT_CONTENT:
            content.skipped.append(name)


def _names(stream: Stream) -> Names:
    names: Names = {}
    for _ in range(version2.counted(stream, "PhysicalNames")):
        line = stream.line()
        found = _NAME.fullmatch(line)
        if found is None:
            raise ValueError(f"PhysicalNames has {line[:60]!r} in the place of a name")
        key = int(found[1]), int(found[2])
        if names.setdefault(key, found[3]) != found[3]:
            raise ValueError(f"PhysicalNames gives group {key[1]} of dimension {key[0]} two names")
    stream.finish()
    return names


def _raw(content: _Content) -> RawMesh:
    if content.nodes is None or (content.runs is None and content.placed is None):
        missing = "Nodes" if content.nodes is None else "Elements"
        raise ValueError(f"it is truncated: it has no section {missing}")
    numbers, points = content.nodes
    raw = RawMesh(points.copy(), [], warnings=not_read(content.skipped))
    runs = content.runs
    if runs is None:
        runs = version4.with_groups(content.placed or [], content.groups, raw.warnings)
    runs = joined(runs)
    nodes = Numbering("node", numbers)
    raw.blocks = blocks_of(runs, nodes, ours=content.note is not None)
    raw.names, raw.labels = content.names, content.note.labels if content.note else set()
    check_complete(content.note, content.data)
    for data in last_steps(content.data.get("NodeData", []), raw.warnings):
        add_node_data(raw, nodes, data, content.allowance)
    for data in last_steps(content.data.get("ElementData", []), raw.warnings):
        add_element_data(raw, runs, data, content.allowance)
    return raw
