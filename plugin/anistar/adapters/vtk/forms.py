"""The grids of VTK and PyVista as forms of meshes: data sets of any class are read as grids."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter

from ...formats.content.export import rejoined
from ...formats.content.raw import KIND_DIM
from ...formats.vtk.cells import kind_of
from ...meshes.mesh import Mesh
from ...objects import Content, Form, register
from .grids import add_arrays, arrays_of, as_grid, cell_types, from_vtk_with_report, to_vtk


def _is_grid(obj: object) -> bool:
    return isinstance(obj, vtkDataSet)


def _is_pyvista(obj: object) -> bool:
    return _is_grid(obj) and type(obj).__module__.partition(".")[0] == "pyvista"


def _read(data: Any) -> Content:
    mesh, fields, report = from_vtk_with_report(data)
    return Content(mesh, fields, report.geometry, report.warnings)


def _make(mesh: Mesh, fields: Mapping[str, Any], like: Any) -> Any:
    """Return a grid; where `like` has no cells of lower dimension, one without such.

    Tetrahedra have no place in a `vtkPolyData`: a mesh in 3D is a grid in any case.
    """
    if like is None:
        return to_vtk(mesh, fields)
    grid = to_vtk(mesh, fields, dims=_dims(like) | {mesh.dim})
    _rejoin(grid.GetPointData(), like.GetPointData())
    _rejoin(grid.GetCellData(), like.GetCellData())
    if mesh.dim == 3 or not like.IsA("vtkPolyData"):
        return grid
    surface = vtkGeometryFilter()
    surface.SetInputData(grid)
    surface.Update()
    return surface.GetOutput()


def _rejoin(data: Any, like: Any) -> None:
    """Put the columns together that are one array of more components in the example."""
    arrays = arrays_of(data)
    widths = {name: values[:1].size for name, values in arrays_of(like).items()}
    joined = rejoined(arrays, widths)
    for name in arrays.keys() - joined.keys():
        data.RemoveArray(name)
    add_arrays(data, {name: joined[name] for name in joined.keys() - arrays.keys()})


def _dims(data: Any) -> set[int]:
    """Return the dimensions of the cells of a data set."""
    kinds = {kind_of(int(number)) for number in np.unique(cell_types(as_grid(data)))}
    return {KIND_DIM[kind] for kind in kinds & KIND_DIM.keys()}


def _make_pyvista(mesh: Mesh, fields: Mapping[str, Any], like: Any) -> Any:
    import pyvista

    return pyvista.wrap(_make(mesh, fields, like))


register(Form(name="vtk", accepts=_is_grid, read=_read, make=_make, holds_fields=True))
register(
    Form(name="pyvista", accepts=_is_pyvista, read=_read, make=_make_pyvista, holds_fields=True)
)
