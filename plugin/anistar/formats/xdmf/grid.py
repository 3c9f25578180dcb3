"""A grid of XDMF: triangles, tetrahedra, what is split into them, or a mixture, and its fields."""

from __future__ import annotations

from xml.etree.ElementTree import Element

import numpy as np

from ...base.arrays import AnyArray
from ..content.kinds import KINDS
from ..content.raw import Block, RawMesh
from ..parsing.rows import leading_rows
from ..parsing.xml_tree import attribute, only_child
from .items import Items

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
_WITH_COUNT = (1, 2)


def content_of(grid: Element, items: Items) -> RawMesh:
    """Return the mesh of a grid with its fields.

    Raises
    ------
    ValueError
        If it is damaged.
    """
    points = _points(only_child(grid, "Geometry"), items)
    kinds, rows = _cells(only_child(grid, "Topology"), items)
    n_cells = sum(len(part) for part in rows)
    on_points = _data(grid, "Node", len(points), items)
    on_cells = _data(grid, "Cell", n_cells, items)
    starts = np.cumsum([0, *(len(part) for part in rows)])
    blocks = []
    for kind in dict.fromkeys(kinds):
        runs = [i for i, other in enumerate(kinds) if other == kind]
        members = np.concatenate([np.arange(starts[i], starts[i + 1]) for i in runs])
        of_kind = {name: values[members] for name, values in on_cells.items()}
        blocks.append(Block(kind, np.concatenate([rows[i] for i in runs]), None, of_kind))
    return RawMesh(points, blocks, point_data=on_points, six="xdmf")


def _points(geometry: Element, items: Items) -> AnyArray:
    kind = geometry.get("GeometryType", geometry.get("Type", "XYZ"))
    if kind not in _DIMENSIONS:
        raise ValueError(f"the geometry {kind!r} is not known, only XY and XYZ")
    values = items.numbers(only_child(geometry, "DataItem")).astype(np.float64)
    if values.ndim != 2 or values.shape[1] != _DIMENSIONS[kind]:
        raise ValueError(f"its points have the shape {values.shape}, which is not {kind}")
    return values


def _cells(topology: Element, items: Items) -> tuple[list[str], list[AnyArray]]:
    """Return runs of cells of one kind, and their points."""
    _check_topology(topology)
    kind = topology.get("TopologyType", topology.get("Type", "")).lower()
    values = items.numbers(only_child(topology, "DataItem"))
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


def _data(grid: Element, center: str, length: int, items: Items) -> dict[str, AnyArray]:
    arrays: dict[str, AnyArray] = {}
    for element in grid.iterfind("Attribute"):
        if element.get("Center", "Node") not in ("Node", "Cell"):
            raise ValueError(f"an attribute lives on {element.get('Center')!r}, not Node or Cell")
        if element.get("Center", "Node") != center:
            continue
        name = attribute(element, "Name")
        values = items.numbers(only_child(element, "DataItem"))
        if name in arrays or values.ndim == 0 or len(values) != length:
            raise ValueError(
                f"the attribute {name!r} comes twice, or has {values.shape} values for {length}"
            )
        arrays[name] = values
    return arrays
