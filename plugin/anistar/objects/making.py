"""A mesh and its fields in the form of another object."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..meshes.mesh import Mesh
from ..metric.base.mesh import AnyMesh
from .forms import form_named, form_names, form_of


def made(mesh: Mesh, fields: Mapping[str, Any], like: AnyMesh) -> Any:
    """Return a mesh and its fields in another form.

    Parameters
    ----------
    mesh : Mesh
    fields : mapping of str to Field or array
        On the mesh.
    like : object or str
        An object of the form wanted, or its name, such as ``"pyvista"``.

    Returns
    -------
    object
        One that holds the fields too; or, where the form holds none, the pair of the mesh and
        the dict of fields, or the mesh alone if there are no fields.

    Raises
    ------
    TypeError
        If `like` is of no known form, or of one that cannot be made.
    ValueError
        If no form is called `like`.
    """
    if isinstance(like, Mesh):
        return (mesh, dict(fields)) if fields else mesh
    form = form_named(like) if isinstance(like, str) else form_of(like)
    if form is None or form.make is None:
        raise TypeError(
            f"like must be a mesh object or one of {', '.join(form_names())}, "
            f"not {type(like).__name__}"
        )
    example = None if isinstance(like, str) else like
    if form.holds_fields:
        return form.make(mesh, fields, example)
    other = form.make(mesh, {}, example)
    return (other, dict(fields)) if fields else other
