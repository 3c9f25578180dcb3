"""What of a mesh is seen: the triangles in front of a cut, and their colours."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import AnyArray, Bools, Floats, Ints, Longs
from ..judging.certificate import Certificate, certify
from ..judging.quality import mean_ratios
from ..meshes.fields import Field, Location
from ..meshes.mesh import Mesh
from ..meshes.plotted import Subject
from ..meshes.topology import facet_table
from ..metric.kernels.algebra import determinant
from ..metric.kernels.elementary import power

WORDS = ("tags", "quality", "size", "certificate")

_AXES = {"x": 0, "y": 1, "z": 2}


@dataclass(frozen=True, eq=False, kw_only=True)
class Scene:
    """Triangles in space and what they are coloured by.

    Attributes
    ----------
    dim : int
        Of the mesh.
    points : (n, 3) float64
        In 2D, z is 0.
    triangles : (k, 3) int32
        Turned outward in 3D.
    values : (n,) or (k,) float64
        At the points or on the triangles.
    on_points : bool
    label : str
        What the values are.
    categories : tuple of str
        What the values 0, 1, ... stand for; empty where they are numbers.
    lines : (l, 2) int32
        Facets of a 2D mesh.
    line_values : (l,) float64
        Their categories, -1 for those without.
    """

    dim: int
    points: Floats
    triangles: Ints
    values: Floats
    on_points: bool
    label: str
    categories: tuple[str, ...]
    lines: Ints
    line_values: Floats


@dataclass(frozen=True, eq=False)
class _Colours:
    """Values at the points, or in the cells and on the facets of a mesh."""

    values: Floats
    label: str
    on_points: bool = False
    categories: tuple[str, ...] = ()
    on_facets: Floats | None = None


def scene(
    subject: Subject,
    colour: str | ArrayLike | None = None,
    *,
    clip: str | Sequence[float] | None = None,
    origin: Sequence[float] | None = None,
) -> Scene:
    """Return what is seen of a mesh; for the parameters see `Plotted.plot`."""
    mesh: Mesh = subject.mesh
    colours = _colours(subject, subject.colour if colour is None else colour)
    kept = np.flatnonzero(kept_cells(mesh, clip, origin))
    if len(kept) == 0:
        raise ValueError("the cut takes the whole mesh away: move its origin")
    triangles, owners, facets = _surface(mesh, kept)
    values = colours.values
    if not colours.on_points:
        values = values[owners]
        if colours.on_facets is not None and mesh.dim == 3:
            values = np.where(facets >= 0, colours.on_facets[facets], values)
    points = np.zeros((mesh.n_points, 3))
    points[:, : mesh.dim] = mesh.points
    lines = mesh.facets[_at_cells(mesh, kept)] if mesh.dim == 2 else np.zeros((0, 2), np.int32)
    line_values = np.full(len(lines), -1.0)
    if colours.on_facets is not None and mesh.dim == 2:
        line_values = colours.on_facets[_at_cells(mesh, kept)]
    return Scene(
        dim=mesh.dim,
        points=points,
        triangles=triangles,
        values=np.asarray(values, dtype=np.float64),
        on_points=colours.on_points,
        label=colours.label,
        categories=colours.categories,
        lines=lines,
        line_values=line_values,
    )


def kept_cells(
    mesh: Mesh, clip: str | Sequence[float] | None, origin: Sequence[float] | None = None
) -> Bools:
    """Return which cells (m,) lie behind the cut."""
    if clip is None:
        if origin is not None:
            raise ValueError('origin is a point of the cut: give clip too, such as clip="x"')
        return np.ones(mesh.n_cells, dtype=bool)
    normal = _normal(clip, mesh.dim)
    middle = 0.5 * (mesh.points.min(axis=0) + mesh.points.max(axis=0))
    through = middle if origin is None else np.asarray(origin, dtype=np.float64)
    if through.shape != (mesh.dim,):
        raise ValueError(f"origin must have {mesh.dim} coordinates, not {through.shape}")
    centres = mesh.points[mesh.cells].mean(axis=1)
    return np.asarray((centres - through) @ normal <= 0.0)


def _normal(clip: str | Sequence[float], dim: int) -> Floats:
    if isinstance(clip, str):
        axis = _AXES.get(clip.removeprefix("-"), dim)
        if axis >= dim:
            raise ValueError(f"clip must be x, -x, y ... or a normal, not {clip!r}")
        return np.asarray(np.eye(dim)[axis] * (-1.0 if clip.startswith("-") else 1.0))
    normal = np.asarray(clip, dtype=np.float64)
    if normal.shape != (dim,) or not np.abs(normal).max() > 0:
        raise ValueError(f"a normal has {dim} components that are not all 0, not {clip!r}")
    return normal


def _surface(mesh: Mesh, kept: Longs) -> tuple[Ints, Longs, Longs]:
    """Return triangles, the cell (k,) of each, and which facet it is, -1 for none."""
    if mesh.dim == 2:
        return mesh.cells[kept], kept, np.full(len(kept), -1)
    table = facet_table(mesh.cells[kept], mesh.n_points)
    is_outer = table.counts == 1
    rows = table.find(mesh.facets)
    facet_of = np.full(len(table.facets), -1)
    facet_of[rows[rows >= 0]] = np.flatnonzero(rows >= 0)
    return table.facets[is_outer], kept[table.cells[is_outer, 0]], facet_of[is_outer]


def _at_cells(mesh: Mesh, kept: Longs) -> Bools:
    """Return which facets (k,) are of some of the cells."""
    return np.asarray(facet_table(mesh.cells[kept], mesh.n_points).find(mesh.facets) >= 0)


def _colours(subject: Subject, colour: str | ArrayLike) -> _Colours:
    if not isinstance(colour, str):
        return _of_array(subject.mesh, np.asarray(colour))
    if colour in subject.fields:
        return _of_field(subject.mesh, colour, subject.fields[colour])
    if colour == "tags":
        return _of_tags(subject.mesh)
    if colour == "quality":
        return _of_quality(subject.mesh, subject.metric)
    if colour == "size" and subject.metric is not None:
        sizes = power(determinant(subject.metric), -0.5 / subject.mesh.dim)
        return _Colours(np.asarray(sizes), "size", on_points=True)
    if colour == "certificate" and (subject.certificate or subject.metric) is not None:
        return _of_certificate(_certificate(subject))
    known = [*subject.fields, *WORDS]
    if colour in WORDS:
        raise ValueError(f"nothing is known of the {colour}: there is no metric")
    near = difflib.get_close_matches(colour, known, n=1)
    hint = f"did you mean {near[0]!r}?" if near else f"there are {', '.join(known)}"
    raise ValueError(f"no field {colour!r}: {hint}")


def _of_array(mesh: Mesh, values: AnyArray) -> _Colours:
    places: dict[int, Location] = {mesh.n_cells: "cells", mesh.n_points: "points"}
    where = places.get(len(np.atleast_1d(values)))
    if where is None:
        raise ValueError(
            f"{len(np.atleast_1d(values))} values are neither for {mesh.n_points} points nor "
            f"for {mesh.n_cells} cells"
        )
    return _of_field(mesh, "", Field(values.astype(np.float64), on=where))


def _of_field(mesh: Mesh, name: str, given: Field | ArrayLike) -> _Colours:
    field = given if isinstance(given, Field) else Field(np.asarray(given))
    values = np.asarray(field.values, dtype=np.float64)
    if field.on == "cell_nodes":
        values = values.mean(axis=1)
    if values.ndim > 1:
        values = np.sqrt(np.square(values.reshape(len(values), -1)).sum(axis=1))
    return _Colours(values, name, on_points=field.on == "points")


def _of_tags(mesh: Mesh) -> _Colours:
    regions, in_cells = np.unique(mesh.cell_tags, return_inverse=True)
    sides, on_facets = np.unique(mesh.facet_tags, return_inverse=True)
    keys = [(mesh.dim, int(tag)) for tag in regions]
    keys += [(mesh.dim - 1, int(tag)) for tag in sides]
    kinds = {mesh.dim: "region", mesh.dim - 1: "facet"}
    names = tuple(mesh.names.get(key) or f"{kinds[key[0]]} {key[1]}" for key in keys)
    return _Colours(
        in_cells.astype(np.float64),
        "tags",
        categories=names,
        on_facets=(len(regions) + on_facets).astype(np.float64),
    )


def _of_quality(mesh: Mesh, metric: Floats | None) -> _Colours:
    M = np.tile(np.eye(mesh.dim), (mesh.n_points, 1, 1)) if metric is None else metric
    return _Colours(mean_ratios(mesh, M), "quality" if metric is None else "quality in the metric")


def _certificate(subject: Subject) -> Certificate:
    if isinstance(subject.certificate, Certificate):
        return subject.certificate
    assert subject.metric is not None  # or it would not be asked for
    return certify(subject.mesh, subject.metric)


def _of_certificate(certificate: Certificate) -> _Colours:
    return _Colours(
        (~certificate.simplex_ok).astype(np.float64),
        "certificate",
        categories=("certified", "not certified"),
    )
