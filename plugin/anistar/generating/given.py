"""Geometry as users have it: complexes, files, meshes and surfaces of other packages."""

from __future__ import annotations

import os
from typing import Any

from ..objects import as_mesh
from .planar_facets import FLAT_ANGLE, FLATNESS
from .plc import PLC
from .surface_files import read_plc
from .surface_files.content.assembly import Planar, assembled
from .surface_files.content.raw_surface import RawSurface
from .surface_files.others.of_objects import (
    surface_of_arrays,
    surface_of_meshio,
    surface_of_polydata,
)


def as_plc(geometry: Any, *, flat_angle: float = FLAT_ANGLE, flatness: float = FLATNESS) -> PLC:
    """Return the complex that an object holds.

    Parameters
    ----------
    geometry : PLC, path, Mesh or object of another package
        A surface of VTK, PyVista (`PolyData`), meshio, or what has `vertices` and `faces` as
        trimesh has; else a mesh, of which the facets count.
    flat_angle, flatness : float
        What of a surface is one planar facet, see `PLC.from_surface`.

    Raises
    ------
    TypeError
        If it is none of these.
    ValueError
        If the surface refers to a point that is not there, or the like.
    """
    if isinstance(geometry, PLC):
        return geometry
    if isinstance(geometry, str | os.PathLike):
        return read_plc(geometry, flat_angle=flat_angle, flatness=flatness)
    surface = _surface(geometry)
    if surface is not None:
        return assembled(surface, Planar(flat_angle=flat_angle, flatness=flatness))[0]
    mesh = as_mesh(geometry, "geometry")
    return PLC.from_mesh(mesh, flat_angle=flat_angle, flatness=flatness)


def _surface(obj: Any) -> RawSurface | None:
    """Return the surface in an object of another package, None if it is none."""
    packages = {base.__module__.partition(".")[0] for base in type(obj).__mro__}
    if packages & {"vtkmodules", "pyvista"} and obj.IsA("vtkPolyData"):
        return surface_of_polydata(obj)
    if "meshio" in packages and not _has_cells(obj):
        return surface_of_meshio(obj)
    if hasattr(obj, "vertices") and hasattr(obj, "faces"):
        return surface_of_arrays(obj.vertices, obj.faces)
    return None


def _has_cells(mesh: Any) -> bool:
    """Return whether a `meshio.Mesh` has cells in space."""
    kinds = ("tetra", "hexahedron", "wedge", "pyramid")
    return any(cells.type.startswith(kinds) for cells in mesh.cells)
