"""From what a file says to a valid mesh, with a report of what had to be changed."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

import numpy as np

from ...base.arrays import AnyArray
from ...base.errors import FormatError
from ...meshes.fields import Field, Kind
from ...meshes.mesh import Mesh
from ...meshes.violations import volume_signs
from ...metric.tensors.orders import from_components
from .raw import Block, RawMesh
from .second_order import MidNodes, curved_geometry
from .simplices import Simplices, simplices_of

_log = logging.getLogger(__name__)


@dataclass(frozen=True, kw_only=True)
class ReadReport:
    """What `read` changed to make the mesh valid.

    Attributes
    ----------
    path : str
        The file.
    flipped_cells : int
        Cells whose orientation was turned.
    dropped_points : int
        Points that belonged to no cell.
    repeated_facets : int
        Facets and edges given more than once; the first one counts.
    split_elements : int
        Quadrilaterals, hexahedra, prisms and pyramids, each now several simplices.
    mid_nodes : int
        Nodes of elements of second order that are no corners; the mesh and the fields are
        without them.
    warnings : tuple of str
        All changes in words.
    geometry : Mesh or None
        Where the edges of elements of second order are curved, a finer mesh whose facets follow
        them: what functions that remesh take as `geometry`.
    """

    path: str
    flipped_cells: int = 0
    dropped_points: int = 0
    repeated_facets: int = 0
    split_elements: int = 0
    mid_nodes: int = 0
    warnings: tuple[str, ...] = ()
    geometry: Mesh | None = field(default=None, repr=False, compare=False)

    def as_dict(self) -> dict[str, Any]:
        """Return the report as JSON builtins, of the geometry only whether there is one."""
        values = {item.name: getattr(self, item.name) for item in fields(self)}
        return values | {
            "warnings": list(self.warnings),
            "geometry": self.geometry is not None,
        }


def assembled(raw: RawMesh, path: Path) -> tuple[Mesh, dict[str, Field], ReadReport]:
    """Return the mesh and fields of a file, and what was changed to make them valid.

    Raises
    ------
    FormatError
        If the content is no mesh of triangles or tetrahedra, or not valid; names the file.
    """
    try:
        return _assembled(raw, path)
    except (ValueError, TypeError) as error:
        raise FormatError(f"{path}: {error}") from error


def _assembled(raw: RawMesh, path: Path) -> tuple[Mesh, dict[str, Field], ReadReport]:
    found = simplices_of(raw)
    dim, cells, used = found.dim, found.blocks[found.dim], found.used
    number = np.cumsum(used) - 1
    rows, flipped = _flipped(found.points, cells.rows)
    notes = [*raw.warnings, *found.notes]
    if raw.is_oriented:
        _note(notes, flipped, "inverted cell(s) flipped, the first is cell")
    unused = ~used & ~found.is_mid
    _note(notes, unused, "point(s) without a cell dropped, the first is point")
    lower, repeated = _lower_arrays(found.blocks, dim, used, notes)
    mesh = Mesh(
        points=found.points[used],
        cells=number[rows],
        cell_tags=np.asarray(cells.tags),
        corners=number[_corners(found, used)],
        names={key: name for key, name in raw.names.items() if key[0] <= dim},
        z=found.z,
        **lower,
    )
    geometry, told = _geometry(mesh, found, used)
    fields = _fields(raw, cells, used, dim, notes)
    for text in [*notes, *told]:
        _log.warning("%s: %s", path, text)
    report = ReadReport(
        path=str(path),
        flipped_cells=int(flipped.sum()),
        dropped_points=int(unused.sum()),
        repeated_facets=repeated,
        split_elements=found.n_split,
        mid_nodes=int((found.is_mid & ~used).sum()),
        warnings=(*notes, *told),
        geometry=geometry,
    )
    return mesh, fields, report


def _geometry(mesh: Mesh, found: Simplices, used: AnyArray) -> tuple[Mesh | None, list[str]]:
    """Return the mesh through the nodes on curved edges, in the numbers of the mesh."""
    kept = used[found.mids.edges].all(axis=1)
    number = np.cumsum(used) - 1
    nodes = found.mids.nodes[kept]
    mids = MidNodes(number[found.mids.edges[kept]], nodes, found.mids.is_unique)
    return curved_geometry(mesh, mids, found.points[nodes])


def _lower_arrays(
    blocks: dict[int, Block], dim: int, used: AnyArray, notes: list[str]
) -> tuple[dict[str, AnyArray], int]:
    """Return facets and ridges with their tags, each once, and how many were repeated."""
    number = np.cumsum(used) - 1
    arrays: dict[str, AnyArray] = {}
    repeated = 0
    for below, name in enumerate(("facet", "edge")[: dim - 1], start=1):
        rows, tags, count, clash = _unrepeated(blocks[dim - below])
        _require_used(name, rows, used)
        arrays[f"{name}s"], arrays[f"{name}_tags"] = number[rows], tags
        repeated += count
        if clash:
            notes.append(f"{clash} {name}(s) carry several tags, the first is kept")
    return arrays, repeated


def _corners(found: Simplices, used: AnyArray) -> AnyArray:
    corners = np.unique(np.r_[found.corners, found.blocks[0].rows.ravel()])
    inside = (corners >= 0) & (corners < len(used))
    if not inside.all():
        raise ValueError(f"corner refers to point {corners[~inside][0]} of {len(used)}")
    return np.asarray(corners[used[corners]])


def _note(notes: list[str], mask: AnyArray, text: str) -> None:
    if mask.any():
        notes.append(f"{mask.sum()} {text} {np.argmax(mask)}")


def _flipped(points: AnyArray, cells: AnyArray) -> tuple[AnyArray, AnyArray]:
    _, inverted = volume_signs(points, cells)
    turned = cells.copy()
    turned[inverted, -2:] = cells[inverted, :-3:-1]
    return turned, inverted


def _unrepeated(block: Block) -> tuple[AnyArray, AnyArray, int, int]:
    """Return rows and tags without repetitions, how many there were, and how many disagreed."""
    tags = np.asarray(block.tags)
    if len(block.rows) == 0:
        return block.rows, tags, 0, 0
    _, first, inverse = np.unique(
        np.sort(block.rows, axis=1), axis=0, return_index=True, return_inverse=True
    )
    original = first[inverse.ravel()]
    keep = np.sort(first)
    clash = int((tags != tags[original]).sum())
    return block.rows[keep], tags[keep], len(tags) - len(keep), clash


def _require_used(name: str, rows: AnyArray, used: AnyArray) -> None:
    bad = ~used[rows].all(axis=1)
    if bad.any():
        at = int(np.argmax(bad))
        point = rows[at][~used[rows[at]]][0]
        what = {"facet": "facets of its cells", "edge": "ridges of its facets"}[name]
        raise ValueError(
            f"{name} {at} has point {point}, which belongs to no cell: elements of fewer "
            f"dimensions than the cells are {what}, and nothing else"
        )


def _fields(
    raw: RawMesh, cells: Block, used: AnyArray, dim: int, notes: list[str]
) -> dict[str, Field]:
    fields: dict[str, Field] = {}
    for name, values in raw.point_data.items():
        if len(values) != len(used):
            raise ValueError(f"field {name!r} has {len(values)} values for {len(used)} points")
        kept = np.asarray(values) if used.all() else np.asarray(values)[used]
        parts = _split(raw, name, kept, dim)
        notes += _told_parts(name, parts, dim)
        for part, array in parts.items():
            _add(fields, part, Field(array, "points", _kind(raw, name, array)))
    for name, values in cells.data.items():
        if len(values) != len(cells.rows):
            raise ValueError(f"field {name!r} has {len(values)} values for {len(cells.rows)} cells")
        parts = _split(raw, name, np.asarray(values), dim)
        notes += _told_parts(name, parts, dim)
        for part, array in parts.items():
            key = part if part not in fields else f"{part} (cells)"
            _add(fields, key, Field(array, "cells", _kind(raw, name, array)))
    return fields


def _told_parts(name: str, parts: Mapping[str, AnyArray], dim: int) -> list[str]:
    """Return a warning about an array that became several fields, none if it did not."""
    if len(parts) <= 1:
        return []
    first, *_, last = parts
    return [
        f"field {name!r} of {len(parts)} components is no vector or tensor in {dim}D: read as "
        f"{first!r} to {last!r}"
    ]


def _add(fields: dict[str, Field], name: str, field: Field) -> None:
    # the columns of one array may be called as another one
    if name in fields:
        raise ValueError(f"it has two fields {name!r}: only one can be meant")
    fields[name] = field


def _kind(raw: RawMesh, name: str, array: AnyArray) -> Kind | None:
    return "label" if name in raw.labels and array.dtype.kind in "iu" else None


def _split(raw: RawMesh, name: str, values: AnyArray, dim: int) -> dict[str, AnyArray]:
    """Return the array as scalar, vector or tensor; as one scalar a column if it is none."""
    if values.dtype.kind not in "biuf":
        raise ValueError(f"field {name!r} holds {values.dtype}, not real numbers")
    if values.ndim == 1 or values.shape[1:] == (1,):
        flat = values.reshape(len(values))
        return {name: flat.astype(np.int64) if name in raw.labels else flat}
    if values.ndim == 3:
        values = values.reshape(len(values), -1)
    width = values.shape[1]
    if width == dim:
        return {name: np.asarray(values, np.float64)}
    if width == 6 and raw.six is not None:
        values = from_components(values.astype(np.float64), raw.six).reshape(-1, 9)
    elif width == 4 and dim == 2:
        return {name: np.asarray(values.reshape(-1, 2, 2), np.float64)}
    elif dim == 2 and width == 3 and not values[:, 2].any():
        return {name: values[:, :2].astype(np.float64)}
    if values.shape[1] == 9:
        full = np.asarray(values.reshape(-1, 3, 3), np.float64)
        if dim == 3:
            return {name: full}
        if not full[:, 2, :2].any() and not full[:, :2, 2].any():
            return {name: full[:, :2, :2].copy()}
    return {f"{name}_{i}": values[:, i] for i in range(values.shape[1])}
