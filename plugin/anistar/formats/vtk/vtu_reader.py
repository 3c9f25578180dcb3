"""VTU of any writer: unstructured grids in one or more pieces."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from ...base.arrays import AnyArray
from ..content.raw import Block, RawMesh, not_read
from ..content.tag_arrays import NAMES, TAGS, decoded_names, read_tagged
from ..parsing.xml_tree import attribute, count, only_child, root_of
from .cells import blocks_of
from .vtu_arrays import Encoding, numbers_of

_APPENDED = re.compile(rb"<AppendedData\b([^<>]*)>\s*_")
_NOT_NUMBERS = ("String", "Bit")


def read(path: Path) -> RawMesh:
    """Read a mesh with its tags, names and fields.

    Raises
    ------
    FormatError
        If the file is damaged or holds another kind of data.
    """
    return read_tagged(path, _mesh)


def _mesh(data: bytes) -> RawMesh:
    document, appended, is_raw = parted(data)
    root = root_of(document)
    if root.tag != "VTKFile" or root.get("type") != "UnstructuredGrid":
        raise ValueError(f"it holds {root.get('type')!r}: save it as an unstructured grid")
    encoding = Encoding.of(root, appended, raw=is_raw, n_bytes=len(data))
    grid = only_child(root, "UnstructuredGrid")
    pieces = grid.findall("Piece")
    if not pieces:
        raise ValueError("it has no Piece")
    _check_tags(grid, {"Piece", "FieldData"})
    skipped: list[str] = []
    raw = _joined([_piece(piece, encoding, skipped) for piece in pieces])
    raw.six = "vtk"
    raw.warnings += not_read(skipped)
    for array in grid.iterfind("FieldData/DataArray"):
        if array.get("Name") == NAMES:
            if raw.names:
                raise ValueError(f"it has two arrays {NAMES}")
            raw.names = decoded_names(numbers_of(array, encoding).tolist())
            if raw.names and any(TAGS not in block.data for block in raw.blocks):
                raw.warnings.append(f"it has names in {NAMES} but no tags in {TAGS}")
    return raw


def parted(data: bytes) -> tuple[bytes, bytes, bool]:
    """Return the document without its appended data, those, and whether they are raw."""
    found = _APPENDED.search(data)
    if found is None:
        return data, b"", False
    end = data.rfind(b"</AppendedData>")
    if end < found.end():
        raise ValueError("it is truncated: its appended data do not end")
    is_raw = b'"raw"' in found[1] or b"'raw'" in found[1]
    appended = data[found.end() : end]
    rest = data[end + len(b"</AppendedData>") :]
    return data[: found.start()] + rest, appended if is_raw else appended.rstrip(), is_raw


def _check_tags(parent: Element, known: set[str]) -> None:
    for child in parent:
        if child.tag not in known:
            raise ValueError(f"the element {child.tag} in {parent.tag} is not known")


def _piece(piece: Element, encoding: Encoding, skipped: list[str]) -> RawMesh:
    _check_tags(piece, {"Points", "Cells", "PointData", "CellData"})
    n_points, n_cells = count(piece, "NumberOfPoints"), count(piece, "NumberOfCells")
    points = numbers_of(only_child(only_child(piece, "Points"), "DataArray"), encoding)
    if points.shape != (n_points, 3):
        raise ValueError(f"it announces {n_points} points, {points.shape} numbers follow")
    cells = _arrays(only_child(piece, "Cells"), encoding, skipped)
    missing = {"types", "offsets", "connectivity"} - cells.keys()
    if missing:
        raise ValueError(f"its cells have no array {sorted(missing)[0]!r}")
    if len(cells["types"]) != n_cells:
        raise ValueError(f"it announces {n_cells} cells, {len(cells['types'])} types follow")
    on_points, on_cells = (
        _data(piece, tag, length, encoding, skipped)
        for tag, length in (("PointData", n_points), ("CellData", n_cells))
    )
    blocks = blocks_of(cells["types"], cells["offsets"], cells["connectivity"], on_cells)
    return RawMesh(points.astype(np.float64), blocks, point_data=on_points)


def _data(
    piece: Element, tag: str, length: int, encoding: Encoding, skipped: list[str]
) -> dict[str, AnyArray]:
    if piece.find(tag) is None:
        return {}
    arrays = _arrays(only_child(piece, tag), encoding, skipped)
    for name, values in arrays.items():
        if len(values) != length:
            raise ValueError(f"{tag} {name!r} has {len(values)} values, not {length}")
    return arrays


def _arrays(parent: Element, encoding: Encoding, skipped: list[str]) -> dict[str, AnyArray]:
    arrays: dict[str, AnyArray] = {}
    for element in parent:
        name = attribute(element, "Name")
        if name in arrays:
            raise ValueError(f"{parent.tag} has two arrays {name!r}")
        if element.get("type") in _NOT_NUMBERS:
            skipped.append(f"{parent.tag} {name}")
        else:
            arrays[name] = numbers_of(element, encoding)
    return arrays


def _joined(pieces: list[RawMesh]) -> RawMesh:
    """Return the pieces as one mesh, with the arrays that all of them have."""
    filled = [piece for piece in pieces if len(piece.points)]
    if len(filled) <= 1:
        return (filled or pieces)[0]
    starts = np.cumsum([0, *(len(piece.points) for piece in filled)])
    blocks = [
        Block(block.kind, block.rows + start, None, block.data)
        for piece, start in zip(filled, starts, strict=False)
        for block in piece.blocks
    ]
    names = [name for name in filled[0].point_data if all(name in p.point_data for p in filled)]
    data = {name: np.concatenate([piece.point_data[name] for piece in filled]) for name in names}
    points = np.concatenate([piece.points for piece in filled])
    partial = _partial([piece.point_data for piece in filled])
    partial |= _partial([block.data for block in blocks])
    warnings = not_read(sorted(partial), what="array", why="not in all pieces")
    return RawMesh(points, blocks, point_data=data, warnings=warnings)


def _partial(groups: list[dict[str, AnyArray]]) -> set[str]:
    """Return the names of arrays that not all groups have."""
    n_groups = Counter(name for group in groups for name in group)
    return {name for name, n in n_groups.items() if n < len(groups)}
