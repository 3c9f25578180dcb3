"""Surfaces that users hold as objects of other packages."""

from __future__ import annotations

from typing import Any

import numpy as np

from ....formats.content.raw import Block, RawMesh
from ....formats.content.tag_arrays import take_tags
from ..content.raw_surface import Faces, RawSurface
from ..vtk.polydata import surface_of_cells
from .of_meshes import surface_of


def surface_of_meshio(mesh: Any) -> RawSurface:
    """Return the surface in a `meshio.Mesh`, polygons and tags with it."""
    simple, polygons = [], []
    for k, cells in enumerate(mesh.cells):
        data = {name: np.asarray(arrays[k]) for name, arrays in mesh.cell_data.items()}
        if cells.type == "polygon":
            rows = [np.asarray(row, np.int64) for row in cells.data]
            sizes = np.array([len(row) for row in rows], np.int64)
            polygons.append((Faces(np.concatenate(rows), sizes), data))
        else:
            simple.append(Block(str(cells.type), np.asarray(cells.data, np.int64), None, data))
    raw = RawMesh(np.array(mesh.points, np.float64), simple)
    raw.names = {
        (int(entry[1]), int(entry[0])): name
        for name, entry in mesh.field_data.items()
        if np.shape(entry) == (2,) and 0 <= int(entry[1]) <= 3
    }
    take_tags(raw)
    surface = surface_of(raw)
    if polygons:
        n = len(surface.faces)
        surface.faces = Faces.joined([surface.faces, *(faces for faces, _ in polygons)])
        if surface.tags is not None:
            none = np.zeros(len(surface.faces) - n, np.int64)
            surface.tags = np.r_[surface.tags, none]
    return surface


def surface_of_polydata(data: Any) -> RawSurface:
    """Return the surface in a `vtkPolyData`, or what PyVista makes of it."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    cells = {}
    for kind, array in (
        ("verts", data.GetVerts()),
        ("lines", data.GetLines()),
        ("polys", data.GetPolys()),
        ("strips", data.GetStrips()),
    ):
        if array is not None and array.GetNumberOfCells():
            ends = vtk_to_numpy(array.GetOffsetsArray()).astype(np.int64)
            indices = vtk_to_numpy(array.GetConnectivityArray()).astype(np.int64)
            cells[kind] = Faces(indices, np.diff(ends))
    points = np.zeros((0, 3))
    if data.GetNumberOfPoints():
        points = vtk_to_numpy(data.GetPoints().GetData()).astype(np.float64)
    arrays = data.GetCellData()
    tags = {
        arrays.GetArrayName(k): vtk_to_numpy(arrays.GetArray(k))
        for k in range(arrays.GetNumberOfArrays())
        if arrays.GetArray(k) is not None
    }
    return surface_of_cells(points, cells, tags)


def surface_of_arrays(vertices: Any, faces: Any) -> RawSurface:
    """Return the surface of an object with vertices (n, 3) and faces (f, k), as trimesh has."""
    rows = np.asarray(faces)
    if rows.ndim != 2 or rows.dtype.kind not in "iu":
        raise TypeError(f"faces must be rows of points, not {rows.dtype} of shape {rows.shape}")
    return RawSurface(np.array(vertices, np.float64), Faces.of_rows(rows))
