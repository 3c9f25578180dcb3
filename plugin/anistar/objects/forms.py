"""The forms that meshes come in, a registry that adapters fill when their package is met first."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..meshes.fields import Field, as_fields
from ..meshes.mesh import Mesh
from ..metric.base.mesh import AnyMesh, Background, set_reader

#: The adapter that registers the forms of a package, which is imported with the first object of it.
_ADAPTERS = {
    "meshio": "meshio",
    "vtk": "vtk.forms",
    "vtkmodules": "vtk.forms",
    "pyvista": "vtk.forms",
    "skfem": "skfem",
    "dolfinx": "dolfinx",
    "ngsolve": "ngsolve",
    "mfem": "mfem",
}


class Content(NamedTuple):
    """What an object holds.

    Attributes
    ----------
    mesh : Mesh
    fields : dict of str to Field
        The fields in the object; empty for forms that have none.
    geometry : Mesh or None
        A finer mesh through the curved edges of the object, where it has such.
    remarks : tuple of str
        What was changed to read it: cells that were split, corners that were taken.
    """

    mesh: Mesh
    fields: dict[str, Field]
    geometry: Mesh | None = None
    remarks: tuple[str, ...] = ()

    def outline(self, geometry: AnyMesh | None) -> Mesh:
        """Return the mesh whose facets are the geometry: that given, else that of the object."""
        return (self.geometry or self.mesh) if geometry is None else as_geometry(geometry)


@dataclass(frozen=True)
class Form:
    """A kind of mesh objects, how they are read and how they are made.

    Attributes
    ----------
    name : str
        What `like` says for it, such as ``"pyvista"``.
    accepts : callable
        ``accepts(obj)``: whether an object is of this form.
    read : callable
        ``read(obj)`` returns its `Content`.
    make : callable or None
        ``make(mesh, fields, like)`` returns an object of this form; `like` is one whose habits
        are kept, or None. None for forms that are only read.
    holds_fields : bool
        Whether its objects hold fields.
    values : callable or None
        ``values(obj)`` returns what a function object of the package has at the points, or a
        `Field`; None for an object that is none.
    functions : callable or None
        ``functions(mesh, fields)`` returns fields as function objects on a mesh of this form,
        where it has an order of points or cells of its own. None where arrays serve.
    """

    name: str
    accepts: Callable[[object], bool]
    read: Callable[[Any], Content]
    make: Callable[[Mesh, Mapping[str, Any], Any], Any] | None = None
    holds_fields: bool = False
    values: Callable[[object], Any | None] | None = None
    functions: Callable[[Any, Mapping[str, Any]], dict[str, Any]] | None = None


_FORMS: dict[str, Form] = {}


def register(form: Form) -> None:
    """Let every function take objects of a form; one of the same name is replaced."""
    _FORMS[form.name] = form


def form_names() -> list[str]:
    """Return the names of the forms that can be made, whether their packages are there or not."""
    known = {*_ADAPTERS, *(form.name for form in _FORMS.values() if form.make)}
    return sorted(known - {"vtkmodules"})


def forms_for(obj: object) -> list[Form]:
    """Return the forms known once the adapters for the class of an object are imported."""
    for base in type(obj).__mro__:
        _import_adapter(base.__module__.partition(".")[0])
    return list(_FORMS.values())


def form_named(name: str) -> Form:
    """Return the form of a name.

    Raises
    ------
    ValueError
        If there is none.
    ImportError
        If its package is missing.
    """
    _import_adapter(name)
    form = _FORMS.get(name)
    if form is None:
        raise ValueError(f"no form of meshes is called {name!r}; known: {', '.join(form_names())}")
    return form


def form_of(obj: object) -> Form | None:
    """Return the form of an object, None if it has none."""
    return next((form for form in reversed(forms_for(obj)) if form.accepts(obj)), None)


def opened(obj: AnyMesh, name: str = "mesh") -> Content:
    """Return the mesh and the fields that an object holds.

    Parameters
    ----------
    obj : Mesh, result of a function here, path, or mesh of another package
    name : str
        What the argument is called in messages.

    Raises
    ------
    TypeError
        If it is none of these.
    """
    if isinstance(obj, Mesh):
        return Content(obj, {})
    mesh = getattr(obj, "mesh", None)
    if isinstance(mesh, Mesh):  # what functions here return
        return Content(mesh, as_fields(mesh, getattr(obj, "fields", None)))
    form = form_of(obj)
    if form is None:
        raise TypeError(
            f"{name} must be an anistar.Mesh, a path, or a mesh of {', '.join(form_names())}, "
            f"not {type(obj).__name__}"
        )
    return form.read(obj)


def as_mesh(obj: AnyMesh, name: str = "mesh") -> Mesh:
    """Return the mesh that an object holds, as `opened` does."""
    return obj if isinstance(obj, Mesh) else opened(obj, name).mesh


def as_geometry(obj: AnyMesh) -> Mesh:
    """Return the mesh whose facets an object gives as the shape: its curved edges count."""
    held = opened(obj, "geometry")
    return held.geometry or held.mesh


def _import_adapter(package: str) -> None:
    adapter = _ADAPTERS.get(package)
    if adapter is not None:
        importlib.import_module(f"anistar.adapters.{adapter}")


def values_of(function: Any) -> Any:
    """Return arrays and fields as they are, and the values at the points of other functions."""
    if isinstance(function, Field | np.ndarray | Sequence):
        return function
    for form in forms_for(function):
        values = form.values(function) if form.values is not None else None
        if values is not None:
            return values
    return function


class _Reader:
    """What the metric package is told of mesh objects."""

    def opened(self, mesh: AnyMesh) -> Background:
        content = opened(mesh)
        return Background(content.mesh, content.fields)

    def values_of(self, function: Any) -> Any:
        return values_of(function)


set_reader(_Reader())
