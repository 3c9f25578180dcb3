"""Surfaces and outlines in the formats of meshes: the triangles and lines that are in them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from ....base.arrays import AnyArray
from ....base.errors import FormatError
from ....formats import inp_reader, med_reader, su2_reader
from ....formats.content.kinds import KINDS
from ....formats.content.raw import REFUSED, Block, RawMesh
from ....formats.content.second_order import corners_of
from ....formats.gmsh import converter
from ....formats.gmsh import reader as gmsh_reader
from ....formats.medit import files as medit_files
from ....formats.suffixes import suffix_of
from ....formats.vtk import legacy_reader, vtu_reader
from ..content.raw_surface import Faces, RawSurface

READERS: dict[str, Callable[[Path], RawMesh]] = {
    ".inp": inp_reader.read,
    ".med": med_reader.read,
    ".mesh": medit_files.read_mesh,
    ".meshb": medit_files.read_mesh,
    ".msh": gmsh_reader.read,
    ".su2": su2_reader.read,
    ".vtk": legacy_reader.read,
    ".vtu": vtu_reader.read,
    **dict.fromkeys(converter.SUFFIXES, converter.read),
}


def read(path: Path) -> RawMesh:
    """Read the elements of a mesh file.

    Raises
    ------
    FormatError
        If the file is damaged.
    """
    return READERS[suffix_of(path)](path)


def is_mesh(raw: RawMesh) -> bool:
    """Return whether elements fill a domain: there are some in space, or some at one height."""
    dims = _dimensions(raw)
    if max(dims, default=0) == 2:
        return raw.points.shape[1] == 2 or _height(raw, 2) is not None
    return 3 in dims


def is_geometry(raw: RawMesh) -> bool:
    """Return whether there are elements, and they bound a domain that they do not fill."""
    return max(_dimensions(raw), default=0) > 0 and not is_mesh(raw)


def _dimensions(raw: RawMesh) -> set[int]:
    return {KINDS[block.kind].dim for block in raw.blocks if _is_known(block) and len(block.rows)}


def surface_of(raw: RawMesh) -> RawSurface:
    """Return the faces and lines of a mesh, tags and names with them.

    Lines at one height without faces are an outline in the plane.

    Raises
    ------
    ValueError
        If it holds elements that are not known.
    """
    blocks = [block for block in raw.blocks if len(block.rows)]
    for block in blocks:
        if not _is_known(block):
            reason = REFUSED.get(block.kind, "only corners, lines and faces")
            raise ValueError(f"it holds elements of type {block.kind!r}; {reason}")
    straight, notes = corners_of(blocks)
    of_dim = {d: [b for b in straight if KINDS[b.kind].dim == d] for d in range(3)}
    points = raw.points
    if not of_dim[2] and points.shape[1] == 3 and (z := _height(raw, 1)) is not None:
        points = points[:, :2]
        notes += [f"the lines are an outline in the plane z = {z:g}"] if z else []
    surface = RawSurface(points, Faces.joined([Faces.of_rows(b.rows) for b in of_dim[2]]))
    surface.tags = _tags(of_dim[2])
    surface.edges, surface.edge_tags = _edges(of_dim[1], notes)
    kept = [block.rows.ravel() for block in of_dim[0]]
    surface.points_kept = np.unique(np.concatenate([raw.corners, *kept]).astype(np.int64))
    surface.names = {key: name for key, name in raw.names.items() if key[0] <= points.shape[1]}
    surface.warnings = [*raw.warnings, *notes]
    return surface


def _is_known(block: Block) -> bool:
    return block.kind in KINDS


def _tags(blocks: list[Block]) -> AnyArray | None:
    if all(block.tags is None for block in blocks):
        return None
    none = [np.zeros(len(b.rows), np.int64) if b.tags is None else b.tags for b in blocks]
    return np.concatenate(none).astype(np.int64)


def _edges(blocks: list[Block], notes: list[str]) -> tuple[AnyArray, AnyArray | None]:
    """Return lines, each once, with the first tag that is given to each."""
    rows = np.concatenate([np.zeros((0, 2), np.int64), *(b.rows for b in blocks)]).astype(np.int64)
    tags = _tags(blocks)
    _, first, inverse = np.unique(
        np.sort(rows, axis=1), axis=0, return_index=True, return_inverse=True
    )
    if len(first) == len(rows):
        return rows, tags
    if tags is not None and (clash := tags != tags[first[inverse.ravel()]]).any():
        notes.append(f"{clash.sum()} line(s) carry several tags, the first is kept")
    first = np.sort(first)
    return rows[first], None if tags is None else tags[first]


def _height(raw: RawMesh, dim: int) -> float | None:
    """Return the height of all elements of a dimension, None if they have no single one."""
    rows = [b.rows.ravel() for b in raw.blocks if _is_known(b) and KINDS[b.kind].dim == dim]
    indices = np.concatenate([np.zeros(0, np.int64), *rows]).astype(np.int64)
    if len(indices) == 0 or indices.min() < 0 or indices.max() >= len(raw.points):
        return None
    heights = raw.points[indices][:, 2]
    return float(heights[0]) if (heights == heights[0]).all() else None


def refuse(path: Path) -> FormatError:
    """Return the error for a file of a format that holds no surface."""
    known = ", ".join(sorted(READERS))
    return FormatError(f"cannot read {path}: no surface is read from it; known: {known}")
