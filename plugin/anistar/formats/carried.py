"""What each format carries of a mesh and its fields: one table for writers, commands and pages."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

import numpy as np

from ..meshes.fields import Field
from ..meshes.mesh import Mesh
from .su2_writer import marker_of
from .suffixes import suffix_of

#: Whole numbers up to here are doubles too.
LARGEST_DOUBLE = 2**53

#: What cells are called in two and three dimensions.
CELL_NAMES = {2: "triangles", 3: "tetrahedra"}
# Formats whose cells are all of one dimension.
_ONE_DIMENSION = {
    **dict.fromkeys((".obj", ".off", ".ply", ".stl", ".svg", ".wkt"), 2),
    **dict.fromkeys((".cgns", ".ele", ".node"), 3),
}

_Found = Callable[[Mesh, Mapping[str, Field]], str]


def _of_tags(what: str, tags: str) -> _Found:
    def found(mesh: Mesh, fields: Mapping[str, Field]) -> str:
        given = np.unique(getattr(mesh, tags))
        given = given[given != 0]
        return f"the tags of {what} ({_listed(given.tolist())})" if len(given) else ""

    return found


def _of_names(what: str, codimension: int) -> _Found:
    def found(mesh: Mesh, fields: Mapping[str, Field]) -> str:
        dim = mesh.dim - codimension
        names = [name for (d, _), name in sorted(mesh.names.items()) if d == dim > 0]
        return f"the names of {what} ({_listed(map(repr, names))})" if names else ""

    return found


def _of_fields(what: str, chosen: Callable[[str, Field], bool], *, why: str = "") -> _Found:
    def found(mesh: Mesh, fields: Mapping[str, Field]) -> str:
        names = [name for name, field in fields.items() if chosen(name, field)]
        return f"{what} ({_listed(map(repr, names))}){why}" if names else ""

    return found


def _is_skew(name: str, field: Field) -> bool:
    if field.kind != "tensor":
        return False
    return not np.array_equal(field.values, np.swapaxes(field.values, -1, -2), equal_nan=True)


def _is_too_large(name: str, field: Field) -> bool:
    return field.kind == "label" and bool((np.abs(field.values) > LARGEST_DOUBLE).any())


ASPECTS: dict[str, _Found] = {
    "cells": lambda mesh, _: f"the cells ({mesh.n_cells} {CELL_NAMES[mesh.dim]})",
    "height": lambda mesh, _: f"the height z = {mesh.z:g}" if mesh.z else "",
    "tags of cells": _of_tags("cells", "cell_tags"),
    "tags of facets": _of_tags("facets", "facet_tags"),
    "ridges": lambda mesh, _: f"{len(mesh.edges)} ridges" if len(mesh.edges) else "",
    "corners": lambda mesh, _: f"{len(mesh.corners)} corners" if len(mesh.corners) else "",
    "names of cells": _of_names("cells", 0),
    "names of facets": _of_names("facets", 1),
    "names of ridges": _of_names("ridges", 2),
    "numbers of names": lambda mesh, _: "the numbers of tags with names" if mesh.names else "",
    "point fields": _of_fields("the fields at points", lambda _, field: field.on == "points"),
    "cell fields": _of_fields("the fields in cells", lambda _, field: field.on == "cells"),
    "full tensors": _of_fields("tensors that are not symmetric", _is_skew),
    "names of fields": _of_fields("the names of fields", lambda name, field: True),
    "blanks in names": _of_fields(
        "blanks in the names of fields", lambda name, _: len(name.split()) > 1
    ),
    "labels": _of_fields(
        "that fields are labels", lambda _, field: field.kind == "label", why=": they are reals"
    ),
    "large labels": _of_fields("digits of labels beyond 2**53", _is_too_large),
}
"""Each tells what a mesh with fields has of it, an empty text if nothing."""

ALL = frozenset(ASPECTS)
_FIELDS = frozenset({"point fields", "cell fields", "full tensors"})
_OF_FIELDS = _FIELDS | {"names of fields", "blanks in names", "labels", "large labels"}
_NAMES = frozenset({"names of cells", "names of facets", "names of ridges", "numbers of names"})

CARRIED: dict[str, frozenset[str]] = {
    ".med": ALL - {"numbers of names", "labels", "large labels"},
    ".mesh": ALL - {"full tensors", "large labels"},
    ".meshb": ALL
    - _NAMES
    - {"height", "full tensors", "names of fields", "blanks in names", "labels", "large labels"},
    ".msh": ALL - {"large labels"},
    ".pvd": ALL,
    ".su2": frozenset({"cells", "tags of facets", "names of facets"}),
    ".vtk": ALL - _NAMES - {"blanks in names"},
    ".vtu": ALL,
    ".xdmf": ALL - _NAMES - {"corners"},
    ".xmf": ALL - _NAMES - {"corners"},
}
"""Of the formats that are written and read here, by their suffix."""

_NOT_READ_HERE = frozenset({"cells"})
# A solution is a part of what goes to a medit mesh.
_SOLUTIONS = {".sol": CARRIED[".mesh"] & _OF_FIELDS, ".solb": CARRIED[".meshb"] & _OF_FIELDS}
# Their names have no place without the fields, blanks none without the names.
_WITHIN = {
    "names of fields": ("point fields", "cell fields"),
    "numbers of names": ("names of facets",),
    "blanks in names": ("names of fields",),
    "labels": ("point fields", "cell fields"),
    "large labels": ("labels",),
    "full tensors": ("point fields", "cell fields"),
}


def losses(mesh: Mesh, fields: Mapping[str, Field], path: str | os.PathLike[str]) -> list[str]:
    """Return what is lost of a mesh and its fields when they are written to a path, in words.

    Parameters
    ----------
    mesh : Mesh
    fields : mapping of str to Field
    path : path
        The suffix chooses the format; nothing is written.

    Returns
    -------
    list of str
        Empty if all comes back when the file is read.
    """
    suffix = suffix_of(Path(path))
    nodal = _of_fields("the fields at nodes of cells", lambda _, field: field.on == "cell_nodes")
    lost = [text] if (text := nodal(mesh, fields)) else []
    rest = {name: field for name, field in fields.items() if field.on != "cell_nodes"}
    if suffix in _SOLUTIONS:
        lost.append(f"the mesh ({mesh.n_points} points, {mesh.n_cells} cells)")
        carried = _SOLUTIONS[suffix] | (ALL - _OF_FIELDS)
    else:
        carried = CARRIED.get(suffix, _NOT_READ_HERE)
    if not holds_cells(suffix, mesh.dim):
        carried -= {"cells"}
    missing = [name for name in ASPECTS if name not in carried]
    for name in missing:
        if not set(_WITHIN.get(name, ())) & set(missing):
            lost += [text] if (text := ASPECTS[name](mesh, rest)) else []
    if suffix == ".su2":
        lost += [text] if (text := _blanks_in_markers(mesh)) else []
    if suffix not in _SOLUTIONS and suffix not in CARRIED and lost:
        lost[-1] += "; meshio writes this format, which may keep some of it"
    return lost


def holds_cells(suffix: str, dim: int) -> bool:
    """Return whether a format has a place for the cells of meshes of a dimension."""
    return _ONE_DIMENSION.get(suffix, dim) == dim


def holdable(
    mesh: Mesh, fields: Mapping[str, Field], path: str | os.PathLike[str]
) -> dict[str, Field]:
    """Return the fields that the format of a path has a place for, under names that it can hold."""
    suffix = suffix_of(Path(path))
    carried = CARRIED.get(suffix, _SOLUTIONS.get(suffix, _FIELDS))
    kept = {
        name: field
        for name, field in fields.items()
        if field.on != "cell_nodes"
        and f"{field.on.removesuffix('s')} fields" in carried
        and ("full tensors" in carried or not _is_skew(name, field))
    }
    if {"names of fields", "blanks in names"} & carried == {"names of fields"}:
        joined = ["_".join(name.split()) for name in kept]
        if len(set(joined)) == len(kept):  # else it is for the writer to refuse
            return dict(zip(joined, kept.values(), strict=True))
    return kept


def _blanks_in_markers(mesh: Mesh) -> str:
    renamed = [
        f"{name!r} becomes {marker_of(name)!r}"
        for (dim, _), name in mesh.names.items()
        if dim == mesh.dim - 1 and marker_of(name) != name
    ]
    return f"blanks in the names of facets: {_listed(renamed)}" if renamed else ""


def _listed(things: Iterable[object], most: int = 5) -> str:
    words = [str(thing) for thing in things]
    more = f" and {len(words) - most} more" if len(words) > most else ""
    return ", ".join(words[:most]) + more
