"""What the commands read: a mesh with fields, and the geometry that it is remeshed on."""

from __future__ import annotations

from dataclasses import dataclass

from ..formats import read, read_with_report
from ..judging.cell_arrays import without_certificate
from ..meshes.fields import Field
from ..meshes.mesh import Mesh
from . import console


@dataclass(frozen=True)
class Input:
    """A mesh to remesh.

    Attributes
    ----------
    mesh : Mesh
    fields : dict of str to Field
        To carry over.
    geometry : Mesh or None
        None for the mesh itself.
    remarks : tuple of str
        What was changed to read it.
    """

    mesh: Mesh
    fields: dict[str, Field]
    geometry: Mesh | None
    remarks: tuple[str, ...]


def read_input(path: str, geometry: str | None = None, *, beside_json: bool) -> Input:
    """Read a mesh to remesh.

    What the certificate of the mesh said is of no other mesh, and left out.

    Parameters
    ----------
    path : str
    geometry : str, optional
        A mesh file whose boundary is the geometry, that of `path` by default. Elements of second
        order stand for their curved edges in both.
    beside_json : bool
        Tell about curved edges on stderr, as stdout is JSON.
    """
    mesh, fields, report = read_with_report(path)
    shape = report.geometry
    if geometry is not None:
        given, _, of_geometry = read_with_report(geometry)
        shape = of_geometry.geometry or given
    elif shape is not None:
        console.note(f"the curved edges of {path} are the geometry", beside_json=beside_json)
    return Input(mesh, without_certificate(fields), shape, report.warnings)


def read_fields(path: str) -> tuple[Mesh, dict[str, Field]]:
    """Read a mesh and the fields to carry over: what its certificate said is of no other mesh."""
    mesh, fields = read(path)
    return mesh, without_certificate(fields)
