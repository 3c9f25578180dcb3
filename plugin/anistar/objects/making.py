"""A mesh and its fields in the form of another object."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..meshes.mesh import Mesh
from ..metric.base.mesh import AnyMesh
from .forms import Form, form_named, form_names, form_of


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
        the dict of fields, or the mesh alone if there are no fields. Fields are functions of the
        package where it has an order of its own, as dolfinx has, and arrays elsewhere.

    Raises
    ------
    TypeError
        If `like` is of no known form, or of one that cannot be made.
    ValueError
        If no form is called `like`.
    """
    form = None if isinstance(like, Mesh) else _form_like(like)
    if form is not None and form.holds_fields and form.make is not None:
        return form.make(mesh, fields, _example(like))
    other, placed = made_apart(mesh, fields, like)
    return (other, placed) if fields else other


def made_apart(mesh: Mesh, fields: Mapping[str, Any], like: AnyMesh) -> tuple[Any, dict[str, Any]]:
    """Return a mesh in another form, without fields, and its fields beside it; see `made`."""
    if isinstance(like, Mesh):
        return mesh, dict(fields)
    form = _form_like(like)
    assert form.make is not None  # it was looked at
    other = form.make(mesh, {}, _example(like))
    return other, dict(fields) if form.functions is None else form.functions(other, fields)


def _example(like: AnyMesh) -> AnyMesh | None:
    return None if isinstance(like, str) else like


def _form_like(like: AnyMesh) -> Form:
    form = form_named(like) if isinstance(like, str) else form_of(like)
    if form is None or form.make is None:
        raise TypeError(
            f"like must be a mesh object or one of {', '.join(form_names())}, "
            f"not {type(like).__name__}"
        )
    return form
