"""Reading and writing meshes, fields and metrics; the suffix of the path chooses the format."""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats
from ..base.atomic import replaced
from ..base.errors import FormatError
from ..meshes.fields import Field, as_fields
from ..meshes.mesh import Mesh
from ..metric.base.given import AnyFields, given_fields
from ..objects import AnyMesh, Content, Form, made, opened, register
from . import inp_reader, med_reader, meshio_writer, su2_reader, su2_writer
from .carried import CARRIED, holdable, losses
from .content.assembly import ReadReport, assembled
from .content.export import exported
from .content.raw import RawMesh
from .content.series import Series, numbered
from .gmsh import converter
from .gmsh import reader as gmsh_reader
from .gmsh import writer as gmsh_writer
from .medit import files as medit_files
from .parsing.reading import reading
from .suffixes import SOLUTIONS, suffix_of
from .vtk import legacy_reader, pvd, vtu_reader, vtu_writer
from .xdmf import reader as xdmf_reader

__all__ = [
    "FormatError",
    "ReadReport",
    "holdable",
    "instants",
    "is_known",
    "losses",
    "put",
    "read",
    "read_metric",
    "read_with_report",
    "write",
    "write_metric",
]

_log = logging.getLogger(__name__)

PathLike = str | os.PathLike[str]

_READERS: dict[str, Callable[[Path], RawMesh]] = {
    ".mesh": medit_files.read_mesh,
    ".meshb": medit_files.read_mesh,
    ".inp": inp_reader.read,
    ".med": med_reader.read,
    ".msh": gmsh_reader.read,
    ".su2": su2_reader.read,
    ".vtk": legacy_reader.read,
    ".vtu": vtu_reader.read,
    **dict.fromkeys(converter.SUFFIXES, converter.read),
}
_SERIES: dict[str, Callable[[Path], Series]] = {
    ".pvd": pvd.series,
    ".xdmf": xdmf_reader.series,
    ".xmf": xdmf_reader.series,
}
_WRITERS: dict[str, Callable[[Path, Mesh, Mapping[str, Field]], None]] = {
    ".mesh": medit_files.write_mesh,
    ".meshb": medit_files.write_mesh,
    ".msh": gmsh_writer.write,
    ".pvd": pvd.write,
    ".su2": su2_writer.write,
    ".vtu": vtu_writer.write,
}
METRIC = "metric"


def read(path: PathLike, *, like: AnyMesh | None = None, instant: int | None = None) -> Any:
    """Read a mesh and its fields.

    Single inverted cells are turned, points without a cell dropped, quadrilaterals, hexahedra,
    prisms and pyramids split, and of elements of second order the corners are taken, each with a
    logged warning; `read_with_report` returns the counts, and the curved edges as a geometry.
    Meshes at one height become 2D.

    Parameters
    ----------
    path : path
        Medit (`.mesh .meshb`, with the fields of a `.sol` or `.solb` of the same name), Gmsh
        (`.msh`), VTK (`.vtu`, legacy `.vtk`), XDMF with its numbers inside (`.xdmf .xmf`), SU2
        (`.su2`) or Abaqus (`.inp`); series of VTU files (`.pvd`) and of XDMF. A number
        behind the path of a series chooses the instant: ``run.pvd:3``.
    like : object or str, optional
        An object of another form, or its name, such as ``"pyvista"``.
    instant : int, optional
        Which instant of a series, from 0, or from the end if negative; the last one by default.

    Returns
    -------
    mesh : Mesh
    fields : dict of str to Field
        Or, with `like`, an object of that form, see `anistar.objects.made`.

    Raises
    ------
    FormatError
        If the file is unreadable, truncated, or holds no valid mesh; names the file and why.
    """
    mesh, fields, _ = read_with_report(path, instant=instant)
    return (mesh, fields) if like is None else made(mesh, fields, like)


def read_with_report(
    path: PathLike, *, instant: int | None = None
) -> tuple[Mesh, dict[str, Field], ReadReport]:
    """Read a mesh and its fields as `read`, and tell what was changed to make them valid."""
    path, number = numbered(Path(path))
    instant = number if instant is None else instant
    _require_readable(path)
    if suffix_of(path) in _SERIES:
        found = _SERIES[suffix_of(path)](path)
        with reading(path):
            return assembled(found.chosen(instant), path)
    if instant is not None:
        raise FormatError(f"cannot read {path}: files {path.suffix} have no instants to choose")
    return assembled(_READERS[suffix_of(path)](path), path)


def instants(path: PathLike) -> tuple[float, ...]:
    """Return the times in a series; that of a file which is none is 0.

    Raises
    ------
    FormatError
        If the file is unreadable.
    """
    path, _ = numbered(Path(path))
    _require_readable(path)
    return _SERIES[suffix_of(path)](path).times if suffix_of(path) in _SERIES else (0.0,)


def _require_readable(path: Path) -> None:
    """Raise if there is no such file, or none of a format that is read."""
    if suffix_of(path) in SOLUTIONS:
        raise FormatError(f"cannot read {path}: a solution file holds no mesh, give the mesh file")
    if not path.is_file():
        raise FormatError(f"cannot read {path}: no such file")
    if suffix_of(path) not in (*_READERS, *_SERIES):
        raise FormatError(
            f"cannot read {path}: files {path.suffix or 'without suffix'} are not read here; "
            "convert it to VTU or Gmsh first, for example with meshio or ParaView"
        )


def write(path: PathLike, mesh: AnyMesh, fields: AnyFields = None) -> None:
    """Write a mesh and its fields under a temporary name, then move them into place.

    Parameters
    ----------
    path : path
        The suffix chooses the format, see `read`.
    mesh : Mesh or other mesh object
    fields : mapping of str to Field or array, array, name, sequence of names, or None
        A bare array lives on the points, and is called ``u`` if it has no name. Names are those
        of fields in the object, all of which are written beside those given. The medit formats
        put fields into a `.sol` or `.solb` of the same name.

    Raises
    ------
    ValueError
        If a field does not fit the mesh.
    FormatError
        If the path cannot be written, or the format has no place for a field.

    Notes
    -----
    What else the format does not carry is a logged warning; `losses` tells it beforehand.
    """
    if not isinstance(path, str | os.PathLike):
        raise TypeError(f"the path comes first, then the mesh: got {type(path).__name__}")
    held = opened(mesh)
    given = held.fields if fields is None else given_fields(held.fields, fields).fields
    checked = as_fields(held.mesh, given)
    told = put(path, held.mesh, checked)
    if suffix_of(Path(path)) not in SOLUTIONS:
        for text in [*losses(held.mesh, checked, path), *told]:
            _log.warning("%s: this format does not carry %s", path, text)


def put(path: PathLike, mesh: Mesh, fields: Mapping[str, Field]) -> list[str]:
    """Write as `write`, and return what meshio says is lost; what `losses` tells is not logged."""
    path = Path(path)
    for name, field in fields.items():
        if field.on == "cell_nodes":
            raise FormatError(
                f"cannot write {path}: field {name!r} lives at the nodes of cells, and files hold "
                "values at points and in cells"
            )
    if suffix_of(path) in _WRITERS:
        _WRITERS[suffix_of(path)](path, mesh, fields)
        return []
    if suffix_of(path) in SOLUTIONS:
        medit_files.write_solution(path, mesh, fields)
        return []
    if not is_known(path):
        raise FormatError(f"cannot write {path}: no format has the suffix {path.suffix!r}")
    with replaced(path) as temporary:
        said = meshio_writer.write(temporary, exported(mesh, fields), path)
    return [f"all, as meshio says: {said}"] if said and suffix_of(path) not in CARRIED else []


def is_known(path: PathLike) -> bool:
    """Return whether a format has the suffix of the path."""
    suffix = suffix_of(Path(path))
    return suffix in (*_WRITERS, *SOLUTIONS) or meshio_writer.is_known(suffix)


def read_metric(path: PathLike, mesh: Mesh) -> Floats:
    """Read a metric at the points of a mesh.

    Parameters
    ----------
    path : path
        A solution file with one field: tensors are the metric, scalars are sizes h, which mean
        the metric 1/h^2. Or a mesh file with a tensor field, called `metric` if there are several.
    mesh : Mesh
        The mesh that carries the metric.

    Returns
    -------
    (n, d, d) float64

    Raises
    ------
    FormatError
        If the file holds no metric, or one of another length or dimension.
    """
    path = Path(path)
    name, values = _metric_field(path)
    if len(values) != mesh.n_points:
        raise FormatError(
            f"{path}: {name!r} has {len(values)} values, the mesh has {mesh.n_points} points"
        )
    if values.ndim == 1:
        bad = ~(np.isfinite(values) & (values > 0))
        if bad.any():
            at = int(np.argmax(bad))
            raise FormatError(f"{path}: the size at point {at} is {values[at]:.3g}, not positive")
        return np.asarray(np.eye(mesh.dim) / np.square(values[:, None, None]))
    if values.shape[1:] != (mesh.dim, mesh.dim):
        raise FormatError(f"{path}: {name!r} is not a {mesh.dim} x {mesh.dim} tensor field")
    return np.asarray(values, dtype=np.float64)


def _metric_field(path: Path) -> tuple[str, Any]:
    if suffix_of(path) in SOLUTIONS:
        arrays = medit_files.read_solution(path).arrays("SolAtVertices")
        if len(arrays) != 1:
            raise FormatError(f"{path}: a metric is one field at the points, not {len(arrays)}")
        return next(iter(arrays.items()))
    _, fields = read(path)
    tensors = {
        name: field.values
        for name, field in fields.items()
        if field.kind == "tensor" and field.on == "points"
    }
    if METRIC in tensors:
        return METRIC, tensors[METRIC]
    if len(tensors) != 1:
        raise FormatError(
            f"{path}: {len(tensors)} tensor fields at points, one or one called {METRIC!r} expected"
        )
    return next(iter(tensors.items()))


def write_metric(path: PathLike, mesh: Mesh, M: ArrayLike) -> None:
    """Write a metric: alone into a solution file, with the mesh into any other format.

    Parameters
    ----------
    path : path
    mesh : Mesh
    M : (n, d, d) array
        Metric at the points.
    """
    write(path, mesh, {METRIC: Field(np.asarray(M, dtype=np.float64), "points", "tensor")})


def _content(path: Any) -> Content:
    mesh, fields, report = read_with_report(path)
    return Content(mesh, fields, report.geometry, report.warnings)


register(Form(name="path", accepts=lambda obj: isinstance(obj, str | os.PathLike), read=_content))
