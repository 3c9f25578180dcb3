"""From what a file says to a valid mesh, with a report of what had to be changed."""

from __future__ import annotations

import logging
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...base.arrays import AnyArray
from ...base.errors import FormatError
from ...meshes.fields import Field, Kind
from ...meshes.mesh import Mesh
from ...meshes.violations import point_violations, volume_signs
from ...metric.tensors.orders import from_components
from .raw import KIND_DIM, KIND_OF_DIM, REFUSED, Block, RawMesh

_log = logging.getLogger(__name__)

# Third coordinates below this part of the mesh's extent are taken for a plane z = 0.
PLANAR = 1e-14


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
    warnings : tuple of str
        All changes in words.
    """

    path: str
    flipped_cells: int = 0
    dropped_points: int = 0
    repeated_facets: int = 0
    warnings: tuple[str, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """Return the report as JSON builtins."""
        return {**asdict(self), "warnings": list(self.warnings)}


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
    dim = _domain_dim(raw)
    blocks = {d: _merged(raw, d) for d in range(dim + 1)}
    for violation in point_violations(raw.points):
        raise ValueError(violation.message)
    for block in blocks.values():
        _check_indices(block, len(raw.points))
    cells = blocks[dim]
    points = _in_dimension(raw.points, dim, cells.rows)
    used = np.zeros(len(points), dtype=bool)
    used[cells.rows] = True
    number = np.cumsum(used) - 1
    rows, flipped = _flipped(points, cells.rows)
    notes = list(raw.warnings)
    _note(notes, flipped, "inverted cell(s) flipped, the first is cell")
    _note(notes, ~used, "point(s) without a cell dropped, the first is point")
    lower, repeated = _lower_arrays(blocks, dim, used, notes)
    mesh = Mesh(
        points=points[used],
        cells=number[rows],
        cell_tags=_tags(cells),
        corners=number[_corners(raw, blocks[0], used)],
        names={key: name for key, name in raw.names.items() if key[0] <= dim},
        **lower,
    )
    fields = _fields(raw, cells, used, dim)
    for text in notes:
        _log.warning("%s: %s", path, text)
    report = ReadReport(
        path=str(path),
        flipped_cells=int(flipped.sum()),
        dropped_points=int((~used).sum()),
        repeated_facets=repeated,
        warnings=tuple(notes),
    )
    return mesh, fields, report


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


def _corners(raw: RawMesh, vertices: Block, used: AnyArray) -> AnyArray:
    corners = np.unique(np.r_[raw.corners, vertices.rows.ravel()].astype(np.int64))
    inside = (corners >= 0) & (corners < len(used))
    if not inside.all():
        raise ValueError(f"corner refers to point {corners[~inside][0]} of {len(used)}")
    return np.asarray(corners[used[corners]])


def _note(notes: list[str], mask: AnyArray, text: str) -> None:
    if mask.any():
        notes.append(f"{mask.sum()} {text} {np.argmax(mask)}")


def _domain_dim(raw: RawMesh) -> int:
    kinds = {block.kind for block in raw.blocks if len(block.rows)}
    refused = sorted(kinds - KIND_DIM.keys())
    if refused:
        mixed = "cells of mixed types: " if kinds & {"triangle", "tetra"} else ""
        reason = REFUSED.get(refused[0], "only triangles and tetrahedra are")
        raise ValueError(f"{mixed}it holds elements of type {refused[0]!r}; {reason}")
    if "tetra" in kinds:
        return 3
    if "triangle" in kinds:
        return 2
    raise ValueError("the mesh is empty: it has no triangles and no tetrahedra")


def _merged(raw: RawMesh, dim: int) -> Block:
    """Return all blocks of one dimension as one, with the data that all of them carry."""
    kind = KIND_OF_DIM[dim]
    blocks = [block for block in raw.blocks if block.kind == kind and len(block.rows)]
    if not blocks:
        return Block(kind, np.zeros((0, dim + 1), np.int64), np.zeros(0, np.int64))
    common = set.intersection(*(set(block.data) for block in blocks))
    ordered = [name for name in blocks[0].data if name in common]
    return Block(
        kind,
        np.concatenate([block.rows for block in blocks]).astype(np.int64),
        np.concatenate([_tags(block) for block in blocks]),
        {name: np.concatenate([block.data[name] for block in blocks]) for name in ordered},
    )


def _tags(block: Block) -> AnyArray:
    return np.zeros(len(block.rows), np.int64) if block.tags is None else block.tags


def _check_indices(block: Block, n_points: int) -> None:
    outside = (block.rows < 0) | (block.rows >= n_points)
    if outside.any():
        at = int(np.argmax(outside.any(axis=1)))
        point = block.rows[outside][0]
        raise ValueError(
            f"{block.kind} {at} refers to point {point} (counting from 0), "
            f"the mesh has {n_points} points"
        )


def _in_dimension(points: AnyArray, dim: int, cells: AnyArray) -> AnyArray:
    if points.shape[1] == dim:
        return points
    if points.shape[1] < dim:
        raise ValueError(f"tetrahedra need three coordinates, the points have {points.shape[1]}")
    used = points[cells.ravel()]
    size = np.ptp(used, axis=0).max(initial=0)
    height = np.abs(used[:, 2]).max(initial=0)
    if height > PLANAR * size:
        raise ValueError(
            f"it is a surface mesh in 3D, which is not supported: |z| reaches {height:.3g}; "
            "a planar mesh needs z = 0"
        )
    return points[:, :2]


def _flipped(points: AnyArray, cells: AnyArray) -> tuple[AnyArray, AnyArray]:
    _, inverted = volume_signs(points, cells)
    turned = cells.copy()
    turned[inverted, -2:] = cells[inverted, :-3:-1]
    return turned, inverted


def _unrepeated(block: Block) -> tuple[AnyArray, AnyArray, int, int]:
    """Return rows and tags without repetitions, how many there were, and how many disagreed."""
    tags = _tags(block)
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
        raise ValueError(f"{name} {at} has point {point}, which belongs to no cell")


def _fields(raw: RawMesh, cells: Block, used: AnyArray, dim: int) -> dict[str, Field]:
    fields: dict[str, Field] = {}
    for name, values in raw.point_data.items():
        if len(values) != len(used):
            raise ValueError(f"field {name!r} has {len(values)} values for {len(used)} points")
        kept = np.asarray(values) if used.all() else np.asarray(values)[used]
        for part, array in _split(raw, name, kept, dim).items():
            _add(fields, part, Field(array, "points", _kind(raw, name, array)))
    for name, values in cells.data.items():
        if len(values) != len(cells.rows):
            raise ValueError(f"field {name!r} has {len(values)} values for {len(cells.rows)} cells")
        for part, array in _split(raw, name, np.asarray(values), dim).items():
            key = part if part not in fields else f"{part} (cells)"
            _add(fields, key, Field(array, "cells", _kind(raw, name, array)))
    return fields


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
