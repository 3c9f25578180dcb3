"""XDMF with the numbers inside: one grid of triangles, tetrahedra, or a mixture.

Numbers in other files (HDF5, raw binary) are not followed: a file read here opens no other.

References
----------
XDMF, "XDMF Model and Format", versions 2 and 3.
"""

from __future__ import annotations

import math
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from ..base.arrays import AnyArray
from .content.kinds import KINDS
from .content.raw import Block, RawMesh
from .content.tag_arrays import read_tagged
from .parsing.rows import leading_rows
from .parsing.text_rows import parsed
from .parsing.xml_tree import attribute, only_child, root_of

# XDMF's numbers of types in a mixture, and their names where all cells are of one.
_MIXED = {
    1: "vertex",
    2: "line",
    4: "triangle",
    5: "quad",
    6: "tetra",
    7: "pyramid",
    8: "wedge",
    9: "hexahedron",
    34: "line3",
    35: "quad9",
    36: "triangle6",
    37: "quad8",
    38: "tetra10",
    39: "pyramid13",
    40: "wedge15",
    41: "wedge18",
    48: "hexahedron20",
    50: "hexahedron27",
}
_UNIFORM = {
    "triangle": "triangle",
    "tetrahedron": "tetra",
    "quadrilateral": "quad",
    "hexahedron": "hexahedron",
    "wedge": "wedge",
    "pyramid": "pyramid",
    "edge_3": "line3",
    "triangle_6": "triangle6",
    "quadrilateral_8": "quad8",
    "quadrilateral_9": "quad9",
    "tetrahedron_10": "tetra10",
    "hexahedron_20": "hexahedron20",
    "hexahedron_27": "hexahedron27",
}
_DIMENSIONS = {"XY": 2, "XYZ": 3}
_IGNORED = ("Time", "Information")
_WITH_COUNT = (1, 2)
_MOST_DIMENSIONS = 3


def read(path: Path) -> RawMesh:
    """Read a mesh with its tags and fields.

    Raises
    ------
    FormatError
        If the file is damaged, holds another kind of grid, or has its numbers elsewhere.
    """
    return read_tagged(path, _mesh)


def _mesh(data: bytes) -> RawMesh:
    root = root_of(data)
    grids = root.findall("Domain/Grid")
    if root.tag != "Xdmf" or len(grids) != 1:
        raise ValueError(f"it has {len(grids)} grids: one mesh is read, without a time series")
    grid = grids[0]
    if grid.get("GridType", "Uniform") != "Uniform":
        raise ValueError(f"its grid is {grid.get('GridType')!r}: one mesh is read, no collection")
    for child in grid:
        if child.tag not in ("Topology", "Geometry", "Attribute", *_IGNORED):
            raise ValueError(f"the element {child.tag} in Grid is not known")
    points = _points(only_child(grid, "Geometry"))
    kinds, rows = _cells(only_child(grid, "Topology"))
    n_cells = sum(len(part) for part in rows)
    on_points, on_cells = (
        _data(grid, center, length) for center, length in (("Node", len(points)), ("Cell", n_cells))
    )
    starts = np.cumsum([0, *(len(part) for part in rows)])
    blocks = []
    for kind in dict.fromkeys(kinds):
        runs = [i for i, other in enumerate(kinds) if other == kind]
        members = np.concatenate([np.arange(starts[i], starts[i + 1]) for i in runs])
        of_kind = {name: values[members] for name, values in on_cells.items()}
        blocks.append(Block(kind, np.concatenate([rows[i] for i in runs]), None, of_kind))
    return RawMesh(points, blocks, point_data=on_points, six="xdmf")


def _points(geometry: Element) -> AnyArray:
    kind = geometry.get("GeometryType", geometry.get("Type", "XYZ"))
    if kind not in _DIMENSIONS:
        raise ValueError(f"the geometry {kind!r} is not known, only XY and XYZ")
    values = _numbers(only_child(geometry, "DataItem")).astype(np.float64)
    if values.ndim != 2 or values.shape[1] != _DIMENSIONS[kind]:
        raise ValueError(f"its points have the shape {values.shape}, which is not {kind}")
    return values


def _cells(topology: Element) -> tuple[list[str], list[AnyArray]]:
    """Return runs of cells of one kind, and their points."""
    _check_topology(topology)
    kind = topology.get("TopologyType", topology.get("Type", "")).lower()
    values = _numbers(only_child(topology, "DataItem"))
    if values.dtype.kind not in "iu":
        raise ValueError("its topology is not of integers")
    if kind == "mixed":
        return _mixed(values.ravel())
    if kind not in _UNIFORM:
        raise ValueError(f"the topology {kind[:40]!r} is not known")
    name = _UNIFORM[kind]
    width = KINDS[name].n_nodes
    if values.ndim != 2 or values.shape[1] != width:
        raise ValueError(f"its cells have the shape {values.shape}, {kind} has {width} points")
    return [name], [values]


def _check_topology(topology: Element) -> None:
    """Raise if the points of cells are counted or ordered in another way than usual."""
    if (base := topology.get("BaseOffset", "0").strip()) != "0":
        raise ValueError(f"its topology has BaseOffset {base[:20]!r}: count its points from 0")
    order = topology.get("Order", "").split()
    if order != [str(place) for place in range(len(order))]:
        raise ValueError(
            f"its topology has Order {' '.join(order)[:40]!r}: write the points of cells in order"
        )


def _mixed(values: AnyArray) -> tuple[list[str], list[AnyArray]]:
    kinds, rows, at = [], [], 0
    while at < len(values):
        number = int(values[at])
        if number not in _MIXED:
            raise ValueError(f"cells of type {number} are not known")
        kind = _MIXED[number]
        # a polyline has its number of points behind the type
        before = 2 if number in _WITH_COUNT else 1
        width = before + KINDS[kind].n_nodes
        alike = list(range(before))
        run = leading_rows(values, at, width, alike)
        if number in _WITH_COUNT and int(run[0, 1]) != width - before:
            raise ValueError(f"a {kind} of {run[0, 1]} points is not supported")
        kinds.append(kind)
        rows.append(run[:, before:])
        at += run.size
    return kinds, rows


def _data(grid: Element, center: str, length: int) -> dict[str, AnyArray]:
    arrays: dict[str, AnyArray] = {}
    for element in grid.iterfind("Attribute"):
        if element.get("Center", "Node") not in ("Node", "Cell"):
            raise ValueError(f"an attribute lives on {element.get('Center')!r}, not Node or Cell")
        if element.get("Center", "Node") != center:
            continue
        name = attribute(element, "Name")
        values = _numbers(only_child(element, "DataItem"))
        if name in arrays or values.ndim == 0 or len(values) != length:
            raise ValueError(
                f"the attribute {name!r} comes twice, or has {values.shape} values for {length}"
            )
        arrays[name] = values
    return arrays


def _numbers(item: Element) -> AnyArray:
    form = item.get("Format", "XML")
    if form != "XML" or item.get("Reference") is not None or len(item):
        raise ValueError(
            f"its numbers are elsewhere ({form}): write them into the XDMF file, or write VTU"
        )
    shape = _shape(attribute(item, "Dimensions"))
    kind = item.get("NumberType", item.get("DataType", "Float"))
    if kind not in ("Float", "Int", "UInt", "Char", "UChar"):
        raise ValueError(f"numbers of type {kind!r} are not known")
    # all digits count: without a precision, which means four bytes, programs write them too
    values = parsed(item.text or "", np.float64 if kind == "Float" else np.int64)
    if math.prod(shape) != len(values):
        raise ValueError(f"an item announces {shape} numbers, {len(values)} follow")
    return values.reshape(shape)


def _shape(text: str) -> list[int]:
    words, longest = text.split(), len(str(2**63))
    if not 0 < len(words) <= _MOST_DIMENSIONS or not all(
        word.isdecimal() and len(word) < longest for word in words
    ):
        raise ValueError(f"the dimensions {text[:40]!r} of an item are no counts")
    return [int(word) for word in words]
