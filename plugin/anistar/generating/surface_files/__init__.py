"""Files with geometry: read as a complex, and written from one; the suffix chooses the format."""

from __future__ import annotations

import logging
import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from ...base.errors import FormatError
from ...formats import read_with_report
from ...formats.parsing.reading import reading
from ...formats.suffixes import suffix_of
from ..geometry.planar_facets import FLAT_ANGLE, FLATNESS
from ..geometry.plc import PLC
from .content.assembly import Planar, SurfaceReport, assembled
from .content.raw_surface import RawSurface
from .others import meshio_reader, of_meshes
from .others.of_objects import surface_of_meshio
from .surfaces import obj_reader, off_reader, ply_reader, stl_reader
from .tetgen import poly_reader
from .vtk import legacy_polydata, vtp_reader
from .writing import write_plc

__all__ = ["SurfaceReport", "holds_geometry", "read_plc", "read_plc_with_report", "write_plc"]

_log = logging.getLogger(__name__)

PathLike = str | os.PathLike[str]

_SURFACES: dict[str, Callable[[Path], RawSurface]] = {
    ".obj": obj_reader.read,
    ".off": off_reader.read,
    ".coff": off_reader.read,
    ".noff": off_reader.read,
    ".ply": ply_reader.read,
    ".stl": stl_reader.read,
    ".vtp": vtp_reader.read,
}
_COMPLEXES = (".poly", ".smesh")


def read_plc(path: PathLike, *, flat_angle: float = FLAT_ANGLE, flatness: float = FLATNESS) -> PLC:
    """Read the geometry of a domain.

    Parameters
    ----------
    path : path
        Surfaces: STL, OBJ, OFF, PLY and VTP, and those in the formats of meshes (Gmsh, medit, VTK
        and what else `anistar.read` and meshio read), of which lines at one height without
        triangles are an outline in 2D. Complexes: TetGen's `.poly` and `.smesh`, Triangle's
        `.poly`. Of a mesh with cells its facets, and the regions that they bound.
    flat_angle, flatness : float
        What of a surface is one planar facet, see `PLC.from_surface`.

    Returns
    -------
    PLC

    Raises
    ------
    FormatError
        If the file is unreadable, truncated or holds no geometry; names the file and the place.

    Notes
    -----
    What is left out or changed is a logged warning; `read_plc_with_report` returns it.
    """
    plc, report = read_plc_with_report(path, flat_angle=flat_angle, flatness=flatness)
    for text in report.warnings:
        _log.warning("%s: %s", path, text)
    return plc


def read_plc_with_report(
    path: PathLike, *, flat_angle: float = FLAT_ANGLE, flatness: float = FLATNESS
) -> tuple[PLC, SurfaceReport]:
    """Read the geometry of a domain as `read_plc`, and tell what was left out or changed."""
    path = Path(path)
    if not path.is_file():
        raise FormatError(f"cannot read {path}: no such file")
    planar = Planar(flat_angle=flat_angle, flatness=flatness)
    with reading(path):
        plc, report = _read(path, planar)
    return plc, replace(report, path=str(path))


def _read(path: Path, planar: Planar) -> tuple[PLC, SurfaceReport]:
    suffix = suffix_of(path)
    if suffix in _COMPLEXES:
        plc, notes = poly_reader.read(path, flatness=planar.flatness)
        return plc, SurfaceReport(warnings=tuple(notes))
    if suffix in _SURFACES:
        return assembled(_SURFACES[suffix](path), planar)
    if suffix == ".vtk" and legacy_polydata.holds_polydata(path):
        return assembled(legacy_polydata.read(path), planar)
    if suffix in of_meshes.READERS:
        raw = of_meshes.read(path)
        if of_meshes.is_mesh(raw):
            mesh, _, told = read_with_report(path)
            return PLC.from_mesh(mesh), SurfaceReport(warnings=told.warnings)
        return assembled(of_meshes.surface_of(raw), planar)
    if meshio_reader.is_known(suffix):
        return assembled(surface_of_meshio(meshio_reader.read(path)), planar)
    raise FormatError(
        f"cannot read {path}: files {path.suffix or 'without suffix'} are not known as geometry"
    )


def holds_geometry(path: Path) -> bool:
    """Return whether a file holds the geometry of a domain and no mesh of one.

    Raises
    ------
    FormatError
        If that takes a look into the file, and it is unreadable.
    """
    suffix = suffix_of(path)
    if suffix in of_meshes.READERS and path.is_file():
        if suffix == ".vtk" and legacy_polydata.holds_polydata(path):
            return True
        with reading(path):
            return of_meshes.is_geometry(of_meshes.read(path))
    return suffix in (*_SURFACES, *_COMPLEXES)
