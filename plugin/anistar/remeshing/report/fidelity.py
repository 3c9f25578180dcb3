"""How far the shape of a new mesh is from the geometry that it was given."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from ... import _core
from ...base.arrays import Floats, Ints, Longs
from ...base.errors import MeshingError
from ...meshes.mesh import Mesh
from ...meshes.mesh_arrays import mesh_arrays
from ...meshes.topology import (
    cell_volumes,
    edge_lengths,
    facet_measures,
    facet_normals,
    facet_table,
    measure_by_tag,
)
from ..options import RemeshOptions

#: A smooth shape lies as far from the given facets as their turns tell, but for this factor:
#: measured, up to 1.08 on ellipsoids, tori and tubes of few facets, from 1.48 across ridges.
SAG_SLACK = 1.25

#: Relative change of a measure that is worth a warning.
WORTH_A_WARNING = 0.01

#: Lengths below this part of the extent of the geometry are round-off.
ROUND_OFF = 1e-9


@dataclass(frozen=True, eq=False)
class Measures:
    """Length, area or volume that each tag of edges, facets and cells carries."""

    edges: dict[int, float]
    facets: dict[int, float]
    cells: dict[int, float]


@dataclass(frozen=True, eq=False)
class SmoothShape:
    """The smooth curves or surfaces that `remesh` puts through the facets of a geometry.

    Attributes
    ----------
    measures : Measures
    sag : (k,) float64
        How far a smooth shape may lie from each facet, as the turns of the facets around tell
        (Grinspun et al., 2006, section 4).
    """

    measures: Measures
    sag: Floats


@dataclass(frozen=True, slots=True, kw_only=True)
class TagMeasure:
    """Length, area or volume that a tag carries, in the geometry and in the new mesh.

    Attributes
    ----------
    dim, tag : int
    name : str
    before : float
        Of the facets, edges or cells of the geometry.
    smooth : float
        Of the smooth shape through the points of the geometry, which `remesh` samples.
    after : float
        Of the new mesh.
    """

    dim: int
    tag: int
    name: str
    before: float
    smooth: float
    after: float

    @property
    def change(self) -> float:
        """Relative change of the measure."""
        return self.after / self.before - 1.0

    @property
    def change_from_smooth(self) -> float:
        """Relative difference from the smooth shape."""
        return self.after / self.smooth - 1.0

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only; the keys are those of the attributes and properties."""
        changes = {"change": self.change, "change_from_smooth": self.change_from_smooth}
        return {**asdict(self), **changes}


@dataclass(frozen=True, slots=True, kw_only=True)
class SurfaceDeviation:
    """How far the new vertices with a facet tag lie from the given facets with that tag.

    Attributes
    ----------
    tag : int
    name : str
    distance, sag : float
        The largest distance, and how far a smooth shape through the given facets lies from them
        at most.
    place : tuple of float
        The vertex with the largest distance for the sag there.
    distance_there, sag_there : float
    """

    tag: int
    name: str
    distance: float
    sag: float
    place: tuple[float, ...]
    distance_there: float
    sag_there: float

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only; the keys are those of the attributes."""
        return {**asdict(self), "place": list(self.place)}


def measures_of(mesh: Mesh) -> Measures:
    """Return what the tags of a mesh carry."""
    return Measures(
        edges=measure_by_tag(edge_lengths(mesh.points, mesh.edges), mesh.edge_tags),
        facets=measure_by_tag(facet_measures(mesh.points, mesh.facets), mesh.facet_tags),
        cells=measure_by_tag(cell_volumes(mesh.points, mesh.cells), mesh.cell_tags),
    )


# The passes of a loop have one geometry: its shape is found once.
_known: WeakKeyDictionary[Mesh, dict[tuple[Any, ...], SmoothShape | None]] = WeakKeyDictionary()


def smooth_shape(geometry: Mesh, options: RemeshOptions) -> SmoothShape | None:
    """Return the shape that a geometry is taken for, None where its facets are that."""
    known = _known.setdefault(geometry, {})
    asked = (options.shape, options.ridge_angle, *options.frozen_tags)
    if asked not in known:
        known[asked] = _found_shape(geometry, options)
    return known[asked]


def _found_shape(geometry: Mesh, options: RemeshOptions) -> SmoothShape | None:
    measure, bulge, sag, edge_length = _core.facet_shapes(mesh_arrays(geometry), options.as_shape())
    if not (sag.any() or bulge.any()):
        return None
    cells = measures_of(geometry).cells
    for tag, added in _added_to_regions(geometry, bulge):
        cells[tag] += added
    measures = Measures(
        edges=measure_by_tag(edge_length, geometry.edge_tags),
        facets=measure_by_tag(measure, geometry.facet_tags),
        cells=cells,
    )
    return SmoothShape(measures, sag)


def _added_to_regions(geometry: Mesh, bulge: Floats) -> Iterator[tuple[int, float]]:
    """Yield what the (k,) volumes behind the facets add to the regions on their two sides."""
    table = facet_table(geometry.cells, geometry.n_points)
    sides = table.cells[table.find(geometry.facets)]
    inner = geometry.points[geometry.cells[sides[:, 0]]].mean(axis=1)
    corner = geometry.points[geometry.facets[:, 0]]
    normals = facet_normals(geometry.points, geometry.facets)
    is_behind = ((inner - corner) * normals).sum(axis=1) < 0
    first = np.where(is_behind, bulge, -bulge)
    for cells, added in ((sides[:, 0], first), (sides[:, 1], -first)):
        beside = cells >= 0
        yield from measure_by_tag(added[beside], geometry.cell_tags[cells[beside]]).items()


def tag_measures(
    geometry: Mesh, shape: SmoothShape | None, new: Mesh, *, has_ridges: bool
) -> tuple[TagMeasure, ...]:
    """Compare what every tag carries.

    The ridges of the geometry count only if the mesh that was remeshed had some.

    Raises
    ------
    MeshingError
        If a tag of the geometry is gone.
    """
    before, after = measures_of(geometry), measures_of(new)
    sampled = before if shape is None else shape.measures
    kinds = [(geometry.dim - 1, "facet", "facets"), (geometry.dim, "cell", "cells")]
    if geometry.dim == 3 and has_ridges:
        kinds.insert(0, (1, "edge", "edges"))
    found = []
    for dim, kind, attribute in kinds:
        given, smooth, made = (getattr(it, attribute) for it in (before, sampled, after))
        lost = sorted(set(given) - set(made))
        if lost:
            raise MeshingError(f"the new mesh lost {kind} tag {lost[0]}")
        found += [
            TagMeasure(
                dim=dim,
                tag=tag,
                name=geometry.names.get((dim, tag), ""),
                before=measure,
                smooth=smooth[tag],
                after=made[tag],
            )
            for tag, measure in given.items()
        ]
    return tuple(found)


def surface_deviations(
    geometry: Mesh, shape: SmoothShape, new: Mesh
) -> tuple[SurfaceDeviation, ...]:
    """Return how far the new vertices lie from the facets of the geometry, tag by tag."""
    found = []
    noise = ROUND_OFF * float(np.ptp(geometry.points, axis=0).max())
    for tag in np.unique(geometry.facet_tags).tolist():
        rows = np.flatnonzero(geometry.facet_tags == tag)
        vertices = np.unique(new.facets[new.facet_tags == tag])
        nearest, distance = _nearest_facets(geometry, rows, new.points[vertices])
        sag = shape.sag[rows[nearest]] + noise
        worst = int((distance / sag).argmax())
        found.append(
            SurfaceDeviation(
                tag=tag,
                name=geometry.names.get((geometry.dim - 1, tag), ""),
                distance=float(distance.max()),
                sag=float(shape.sag[rows].max()),
                place=tuple(new.points[vertices[worst]].tolist()),
                distance_there=float(distance[worst]),
                sag_there=float(sag[worst]),
            )
        )
    return tuple(found)


def _nearest_facets(geometry: Mesh, rows: Longs, queries: Floats) -> tuple[Ints, Floats]:
    nearest = _core.nearest_facets2 if geometry.dim == 2 else _core.nearest_facets3
    found: tuple[Ints, Floats] = nearest(geometry.points, geometry.facets[rows], queries)
    return found


def shape_warnings(
    tags: tuple[TagMeasure, ...], deviations: tuple[SurfaceDeviation, ...]
) -> tuple[str, ...]:
    """Return a line for everything about the shape that may not be what is meant."""
    return (
        *(_far_off(it) for it in deviations if it.distance_there > SAG_SLACK * it.sag_there),
        *(_changed(it) for it in tags if abs(it.change) > WORTH_A_WARNING),
    )


def _far_off(it: SurfaceDeviation) -> str:
    place = ", ".join(f"{x:g}" for x in it.place)
    return (
        f"facet {_named(it.tag, it.name)}: near ({place}) the new facets lie "
        f"{it.distance_there:.2g} from the given ones, a smooth shape would keep within "
        f"{it.sag_there:.2g}: a corner or ridge may have been taken for smooth there, or the given "
        "facets are too few to tell; lower ridge_angle, refine the geometry, or take "
        'shape="polyhedron"'
    )


def _changed(it: TagMeasure) -> str:
    what = {1: "length", 2: "area", 3: "volume"}[it.dim]
    is_coarse = abs(it.change_from_smooth) > abs(it.change)
    advice = (
        "edges are long for what is curved: lower hausdorff_number"
        if is_coarse
        else 'without project, shape="polyhedron" keeps what is given'
    )
    return (
        f"{what} of {_named(it.tag, it.name)}: {it.change:+.1%} against the given mesh, "
        f"{it.change_from_smooth:+.1%} against the smooth shape through its points; {advice}"
    )


def _named(tag: int, name: str) -> str:
    return f"tag {tag} ({name})" if name else f"tag {tag}"
