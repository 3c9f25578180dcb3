"""A `Mesh` with fields as a `vtkUnstructuredGrid`, and back.

The arrays are those of the VTU files that `anistar.write` makes: a grid that ParaView read from one
of them is the same as one from here.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from vtkmodules.numpy_interface.dataset_adapter import WrapDataObject
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataSet, vtkUnstructuredGrid
from vtkmodules.vtkFiltersCore import vtkAppendFilter

from ...base.arrays import AnyArray
from ...formats.content.assembly import ReadReport, assembled
from ...formats.content.export import exported
from ...formats.content.raw import KIND_DIM, RawMesh, not_read
from ...formats.content.tag_arrays import NAMES, TAGS, decoded_names, take_tags
from ...formats.parsing.reading import reading
from ...formats.vtk.cells import blocks_of, types_and_rows
from ...meshes.fields import Field, as_fields
from ...meshes.mesh import Mesh


def to_vtk(
    mesh: Mesh,
    fields: Mapping[str, Field | ArrayLike] | None = None,
    *,
    dims: Collection[int] = range(4),
) -> Any:
    """Return a mesh and its fields as a `vtkUnstructuredGrid`.

    Parameters
    ----------
    mesh : Mesh
        2D meshes are at their height `z`. Cells come first, then facets, ridges and corners as
        cells of lower dimension; all have their tags in the cell array ``medit:ref``.
    fields : mapping of str to Field or array, optional
        Vectors get three components, tensors nine, row by row. Cell fields are NaN (labels 0)
        on the cells of lower dimension.
    dims : collection of int
        Dimensions of the cells that are written; all by default.

    Returns
    -------
    vtkUnstructuredGrid
        Scalar fields at points and, in 3D, the points and all fields there are the arrays given,
        not copies.
    """
    content = exported(mesh, as_fields(mesh, fields))
    grid = vtkUnstructuredGrid()
    points = vtkPoints()
    points.SetData(numpy_to_vtk(content.points))
    grid.SetPoints(points)
    blocks = [block for block in content.blocks if KIND_DIM[block.kind] in dims]
    types, ends, connectivity = types_and_rows(blocks)
    cells = vtkCellArray()
    cells.SetData(
        numpy_to_vtkIdTypeArray(np.r_[0, ends], deep=True),
        numpy_to_vtkIdTypeArray(connectivity, deep=True),
    )
    grid.SetCells(numpy_to_vtk(types, deep=True), cells)
    add_arrays(grid.GetPointData(), content.point_data)
    cell_data = {name: np.concatenate([b.data[name] for b in blocks]) for name in blocks[0].data}
    tags = np.concatenate([np.asarray(b.tags, np.int32) for b in blocks])
    add_arrays(grid.GetCellData(), {TAGS: tags, **cell_data})
    entries = [[dim, tag, name] for (dim, tag), name in sorted(content.names.items())]
    encoded = np.frombuffer(json.dumps(entries).encode("ascii"), dtype=np.uint8)
    add_arrays(grid.GetFieldData(), {NAMES: encoded.copy()})
    return grid


def from_vtk(grid: Any) -> tuple[Mesh, dict[str, Field]]:
    """Return the mesh and fields of a `vtkUnstructuredGrid`, or of another data set, as one.

    Parameters
    ----------
    grid : vtkUnstructuredGrid or other vtkDataSet
        Triangles need one z. Quadrilaterals, hexahedra, prisms and pyramids are split, of cells of
        second order the corners are taken. Cells of lower dimension become facets, ridges and
        corners; their tags are looked for in ``medit:ref``, ``gmsh:physical`` and ``cell_tags``.

    Returns
    -------
    mesh : Mesh
    fields : dict of str to Field
        Symmetric tensors of six components are taken in VTK's order. Where every point has a cell
        and no component has to go, the values are those of the grid, not copies.

    Raises
    ------
    TypeError
        If it is no data set.
    FormatError
        If it holds no valid mesh.
    """
    mesh, fields, _ = from_vtk_with_report(grid)
    return mesh, fields


def from_vtk_with_report(grid: Any) -> tuple[Mesh, dict[str, Field], ReadReport]:
    """Return the mesh and fields of a grid as `from_vtk`, and what was changed on the way.

    Raises
    ------
    TypeError
        If it is no unstructured grid.
    FormatError
        If it holds no valid mesh.
    """
    if not isinstance(grid, vtkDataSet):
        kind = getattr(grid, "GetClassName", lambda: type(grid).__name__)()
        raise TypeError(f"a vtkUnstructuredGrid is needed, not {kind}")
    name = Path(grid.GetClassName())
    with reading(name):
        raw = _content(as_grid(grid))
        looks = _of_looks(grid)
        raw.point_data = {n: values for n, values in raw.point_data.items() if n not in looks}
        raw.warnings += not_read(sorted(looks), what="array", why="how a surface looks")
        take_tags(raw)
    return assembled(raw, name)


def as_grid(data: Any) -> Any:
    """Return a data set of any class as a `vtkUnstructuredGrid`."""
    if data.IsA("vtkUnstructuredGrid"):
        return data
    append = vtkAppendFilter()
    append.SetInputData(data)
    append.Update()
    return append.GetOutput()


def cell_types(grid: Any) -> AnyArray:
    """Return VTK's number of the type of each cell of a grid."""
    return np.asarray(WrapDataObject(grid).CellTypes)


def _content(grid: Any) -> RawMesh:
    n = grid.GetNumberOfPoints()
    points = vtk_to_numpy(grid.GetPoints().GetData()) if n else np.zeros((0, 3))
    raw = RawMesh(points.astype(np.float64, copy=False), [], six="vtk")
    raw.point_data = arrays_of(grid.GetPointData())
    skipped = [*_without_numbers(grid.GetPointData()), *_without_numbers(grid.GetCellData())]
    raw.warnings += not_read(skipped, what="array", why="no field")
    if grid.GetNumberOfCells():
        raw.blocks = blocks_of(
            cell_types(grid),
            vtk_to_numpy(grid.GetCells().GetOffsetsArray())[1:],
            vtk_to_numpy(grid.GetCells().GetConnectivityArray()),
            arrays_of(grid.GetCellData()),
        )
    names = arrays_of(grid.GetFieldData()).get(NAMES)
    if names is not None:
        raw.names = decoded_names(names.tolist())
    return raw


def add_arrays(data: Any, arrays: Mapping[str, AnyArray]) -> None:
    """Add arrays to the data of points, cells or a grid."""
    for name, values in arrays.items():
        array = numpy_to_vtk(np.ascontiguousarray(values))
        array.SetName(name)
        data.AddArray(array)


def arrays_of(data: Any) -> dict[str, AnyArray]:
    """Return the arrays of numbers in the data of points, cells or a grid."""
    found = {}
    for i in range(data.GetNumberOfArrays()):
        array = data.GetArray(i)
        if array is not None and array.GetName():  # arrays of strings are no numbers
            found[array.GetName()] = vtk_to_numpy(array)
    return found


def _of_looks(grid: Any) -> set[str]:
    """Return the names of the normals and texture coordinates, which the new mesh has others of."""
    data = grid.GetPointData()
    return {array.GetName() for array in (data.GetNormals(), data.GetTCoords()) if array}


def _without_numbers(data: Any) -> list[str]:
    """Return the names of the arrays that are no fields, such as texts."""
    arrays = [data.GetAbstractArray(i) for i in range(data.GetNumberOfArrays())]
    names, numbers = [array.GetName() or "without a name" for array in arrays], arrays_of(data)
    return [name for name in names if name not in numbers]
