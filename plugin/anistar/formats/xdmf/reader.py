"""XDMF documents: a grid, or collections of grids in time that may share their mesh.

References
----------
XDMF, "XDMF Model and Format", versions 2 and 3.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from ..content.raw import RawMesh
from ..content.series import Series
from ..content.tag_arrays import take_tags
from ..parsing.reading import reading
from ..parsing.xml_tree import attribute, only_child, root_of
from .grid import content_of
from .items import Items

# Of any version of XInclude.
_INCLUDE = "{*}include"
_NAMED = re.compile(r"""@Name=["']([^"']*)["']""")


@dataclass(frozen=True)
class _Instant:
    """What makes up the mesh and the fields of a time: a grid of each collection."""

    time: float
    grids: list[Element]


def series(path: Path) -> Series:
    """Return the instants of a document, one where it has no series.

    Raises
    ------
    FormatError
        If the file is damaged or holds another kind of grid.
    """
    with reading(path):
        root = root_of(path.read_bytes())
        if root.tag != "Xdmf":
            raise ValueError(f"it begins with {root.tag[:40]!r}, it is no XDMF")
        top = root.findall("Domain/Grid")
        instants = _instants(top, Items(path.parent))
    times = tuple(instant.time for instant in instants)
    return Series(times, partial(_content, path, top, instants))


def _content(path: Path, top: list[Element], instants: list[_Instant], number: int) -> RawMesh:
    with reading(path):
        grids = instants[number].grids
        parts = [_mesh_of(grids[0], top)] + [g.findall("Attribute") for g in grids]
        whole = Element("Grid")
        whole.extend([element for part in parts for element in part])
        raw = content_of(whole, Items(path.parent))
        take_tags(raw)
    return raw


def _instants(top: list[Element], items: Items) -> list[_Instant]:
    """Return the grids of each time: those of all collections that have the time."""
    collections = [grid for grid in top if grid.get("GridType", "Uniform") == "Collection"]
    if not collections:
        if len(top) != 1:
            raise ValueError(f"it has {len(top)} grids: one mesh or one series is read")
        _check_uniform(top[0])
        return [_Instant(_time_of(top[0], 0.0), top)]
    lists = []
    for collection in collections:
        if collection.get("CollectionType", "Spatial") != "Temporal":
            raise ValueError(
                "it has a spatial collection: merge the parts of the mesh, a series in time is read"
            )
        grids = collection.findall("Grid")
        for grid in grids:
            _check_uniform(grid)
        times = _times_in(collection, len(grids), items)
        lists.append([(_time_of(grid, times[k]), grid) for k, grid in enumerate(grids)])
    first = [time for time, _ in lists[0]]
    if any([time for time, _ in other] != first for other in lists[1:]):
        raise ValueError("its collections have not the same times")
    return [_Instant(time, [members[k][1] for members in lists]) for k, time in enumerate(first)]


def _check_uniform(grid: Element) -> None:
    if grid.get("GridType", "Uniform") != "Uniform":
        raise ValueError(f"its grid is {grid.get('GridType')!r}: no grid of grids is read")
    known = ("Topology", "Geometry", "Attribute", "Time", "Information")
    for child in grid:
        if child.tag not in known and not child.tag.endswith("}include"):
            raise ValueError(f"the element {child.tag} in Grid is not known")


def _times_in(collection: Element, count: int, items: Items) -> list[float]:
    """Return the times that a collection gives its grids, their numbers where it gives none."""
    element = collection.find("Time")
    if element is None:
        return [float(number) for number in range(count)]
    kind = element.get("TimeType", element.get("Type", "Single"))
    if kind not in ("List", "HyperSlab"):
        raise ValueError(
            f"its collection has times of type {kind[:40]!r}: List and HyperSlab are read, or a "
            "Time in every grid"
        )
    values = items.numbers(only_child(element, "DataItem")).ravel()
    if kind == "HyperSlab":
        if len(values) != 3:
            raise ValueError(f"its times are a HyperSlab of {len(values)} numbers, not 3")
        start, step, n = values.tolist()
        values = start + step * np.arange(min(n, count + 1))
    if len(values) != count:
        raise ValueError(f"its collection has {len(values)} times for {count} grids")
    return [float(time) for time in values]


def _time_of(grid: Element, otherwise: float) -> float:
    element = grid.find("Time")
    if element is None:
        return otherwise
    if (kind := element.get("TimeType", element.get("Type", "Single"))) != "Single":
        raise ValueError(f"a grid has a time of type {kind[:40]!r}: one number is read")
    return float(attribute(element, "Value"))


def _mesh_of(grid: Element, top: list[Element]) -> list[Element]:
    """Return topology and geometry of a grid, which may be those of another grid above."""
    own = [*grid.findall("Topology"), *grid.findall("Geometry")]
    include = grid.find(_INCLUDE)
    if own or include is None:
        return own
    if include.get("href") is not None:
        raise ValueError("it includes another file, which is not opened")
    named = _NAMED.search(include.get("xpointer", ""))
    meshes = [g for g in top if g.get("GridType", "Uniform") == "Uniform"]
    found = [g for g in meshes if named is None or g.get("Name") == named[1]]
    if len(found) != 1:
        raise ValueError(
            f"one of its grids has the mesh of {named[1] if named else 'another grid'!r}, of "
            f"which there are {len(found)}"
        )
    return [*found[0].findall("Topology"), *found[0].findall("Geometry")]
