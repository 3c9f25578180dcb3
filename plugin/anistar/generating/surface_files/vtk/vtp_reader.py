"""VTP, the surfaces of VTK in XML."""

from __future__ import annotations

from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from ....base.arrays import AnyArray
from ....formats.content.raw import not_read
from ....formats.content.tag_arrays import FOREIGN_TAGS, NAMES, TAGS, decoded_names
from ....formats.parsing.reading import reading
from ....formats.parsing.xml_tree import attribute, count, only_child, root_of
from ....formats.vtk.vtu_arrays import Encoding, numbers_of
from ....formats.vtk.vtu_reader import parted
from ..content.raw_surface import Faces, RawSurface
from .polydata import surface_of_cells

_CELLS = ("Verts", "Lines", "Polys", "Strips")


def read(path: Path) -> RawSurface:
    """Read the cells and their tags.

    Raises
    ------
    FormatError
        If the file is damaged, holds another kind of data, or is in several pieces.
    """
    with reading(path):
        data = path.read_bytes()
        document, appended, is_raw = parted(data)
        root = root_of(document)
        if root.tag != "VTKFile" or root.get("type") != "PolyData":
            raise ValueError(f"it holds {root.get('type')!r}, not PolyData")
        encoding = Encoding.of(root, appended, raw=is_raw, n_bytes=len(data))
        grid = only_child(root, "PolyData")
        raw = _piece(only_child(grid, "Piece"), encoding)
        for array in grid.iterfind("FieldData/DataArray"):
            if array.get("Name") == NAMES:
                raw.names = decoded_names(numbers_of(array, encoding).tolist())
        return raw


def _piece(piece: Element, encoding: Encoding) -> RawSurface:
    points = numbers_of(only_child(only_child(piece, "Points"), "DataArray"), encoding)
    if points.shape != (n := count(piece, "NumberOfPoints"), 3):
        raise ValueError(f"it announces {n} points, {points.shape} numbers follow")
    cells = {
        tag.lower(): _cells(piece.find(tag), encoding)
        for tag in _CELLS
        if piece.find(tag) is not None
    }
    tags: dict[str, AnyArray] = {}
    skipped = []
    for element in piece.iterfind("CellData/DataArray"):
        name = attribute(element, "Name")
        if name in (TAGS, *FOREIGN_TAGS):
            tags[name] = numbers_of(element, encoding)
        else:
            skipped.append(name)
    skipped += [attribute(element, "Name") for element in piece.iterfind("PointData/DataArray")]
    raw = surface_of_cells(points, cells, tags)
    raw.warnings += not_read(skipped, what="array", why="no tags")
    return raw


def _cells(parent: Element | None, encoding: Encoding) -> Faces:
    arrays = (
        {}
        if parent is None
        else {attribute(element, "Name"): numbers_of(element, encoding) for element in parent}
    )
    if not {"connectivity", "offsets"} <= arrays.keys():
        return Faces()
    ends, indices = (arrays[name].astype(np.int64) for name in ("offsets", "connectivity"))
    sizes = np.diff(ends, prepend=0)
    if (sizes < 0).any() or int(sizes.sum()) != len(indices):
        raise ValueError(f"the offsets of its cells do not fit to {len(indices)} points")
    return Faces(indices, sizes)
