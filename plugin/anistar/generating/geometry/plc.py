"""The piecewise linear complex: points, facets and segments, with tags, names and regions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, InitVar, dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...base.arrays import Floats, Ints
from ...meshes.conversion import as_rows, as_tags
from ...meshes.svg import drawing_of
from ...metric.base.told import Told
from ...objects import AnyMesh, as_mesh
from .borders import borders_of
from .facet_loops import FacetLoops, Loops
from .of_mesh import MeshBorder
from .planar_facets import FLAT_ANGLE, FLATNESS, diagonal, planar_facets
from .plc_arrays import (
    Names,
    as_edges,
    as_holes,
    as_names,
    as_points,
    as_points_kept,
    as_regions,
    require_different,
    require_in_range,
)
from .region import Region
from .segments import segments_of
from .surface_facets import SurfaceFacets

# Optional arrays are never None once constructed, so the fields keep their array types.
_NOT_GIVEN: Any = None


@dataclass(frozen=True, eq=False, repr=False)
class PLC(Told):
    """The geometry of a domain, in 2D or 3D, of which a mesh can be generated.

    Everything is checked at construction but how facets meet, which `anistar.check_plc` does.
    All arrays are copies and read-only.

    Parameters
    ----------
    points : (n, d) float array
        Coordinates, d = 2 or 3.
    facets : sequence of f facets, optional
        In 3D only. A facet is a sequence of point indices, or of such loops, the outer one first.
        Loops of three or more points after it are holes, those of two points edges in the facet,
        those of one point points in it. What an odd number of loops enclose is the facet. An
        (f, 3) array of triangles serves as well.
    facet_tags : (f,) int array, optional
        0 by default.
    edges : (e, 2) int array, optional
        In 2D the segments; in 3D embedded edges, or edges of facets that carry a tag.
    edge_tags : (e,) int array, optional
        0 by default.
    points_kept : (k,) int array, optional
        Points that must be in the mesh although they belong to no facet or edge.
    names : mapping of (dim, tag) to str, optional
        Names of tags; `dim` is that of the tagged entities.
    regions : sequence of Region, optional
        Their names become names of tags.
    holes : (h, d) float array, optional
        Points in what is to be left empty.
    flatness : float, optional
        How far a point may lie from the plane of its facet, in diagonals of all points.

    Attributes
    ----------
    triangles : (t, 3) int32
        The facets, triangulated, and turned as their outer loops.
    triangle_facets : (t,) int32
        The facet of each triangle.
    segments : (s, 2) int32
        The borders of facets, and the edges given, each once and sorted.
    segment_tags : (s,) int32
        0 unless the edge was given with a tag.

    Raises
    ------
    TypeError
        If an array cannot be converted without loss.
    ValueError
        If shapes do not fit, a number is not finite, an index is out of range, or a facet is no
        planar polygon; the message names the culprit.
    """

    points: Floats
    _: KW_ONLY
    facets: Sequence[Loops] = ()
    facet_tags: Ints = _NOT_GIVEN
    edges: Ints = _NOT_GIVEN
    edge_tags: Ints = _NOT_GIVEN
    points_kept: Ints = _NOT_GIVEN
    names: Names = field(default_factory=dict)
    regions: tuple[Region, ...] = ()
    holes: Floats = _NOT_GIVEN
    flatness: InitVar[float] = FLATNESS
    triangles: Ints = field(init=False)
    triangle_facets: Ints = field(init=False)
    segments: Ints = field(init=False)
    segment_tags: Ints = field(init=False)

    def __post_init__(self, flatness: float) -> None:
        points, edges = as_points(self.points), as_edges(self.edges)
        dim = points.shape[1]
        given = self.facets
        facets = given if isinstance(given, SurfaceFacets) else FacetLoops.of(given)
        if dim == 2 and len(facets):
            raise ValueError("facets are given in 3D only; in 2D give edges")
        kept = as_points_kept(self.points_kept)
        for name, indices in (("facets", facets.indices), ("edges", edges), ("points_kept", kept)):
            require_in_range(name, indices, len(points))
        edge_tags = as_tags(self.edge_tags, "edge_tags", len(edges))
        triangles, triangle_facets = _triangulated(points, facets, edges, flatness)
        borders, _ = borders_of(triangles, triangle_facets)
        segments, segment_tags = segments_of(
            edges, edge_tags, np.concatenate([facets.inner_edges, borders])
        )
        regions = as_regions(self.regions, dim)
        self._store(
            facets=facets,
            regions=regions,
            names=as_names(self.names, regions, dim),
            points=points,
            facet_tags=as_tags(self.facet_tags, "facet_tags", len(facets)),
            edges=edges,
            edge_tags=edge_tags,
            points_kept=kept,
            holes=as_holes(self.holes, dim),
            triangles=triangles,
            triangle_facets=triangle_facets,
            segments=segments,
            segment_tags=segment_tags,
        )

    def _store(self, **values: Any) -> None:
        for name, value in values.items():
            if isinstance(value, np.ndarray):
                value = value.view()
                value.flags.writeable = False
            object.__setattr__(self, name, value)

    @classmethod
    def from_surface(
        cls,
        points: ArrayLike,
        triangles: ArrayLike,
        tags: ArrayLike | None = None,
        *,
        flat_angle: float = FLAT_ANGLE,
        flatness: float = FLATNESS,
        **others: Any,
    ) -> PLC:
        """Return the complex of a triangle surface, in which what is planar is one facet.

        A facet grows from its largest triangle across edges that two triangles share, and ends
        where they have another tag, or are not planar with that first one.

        Parameters
        ----------
        points : (n, 3) float array
        triangles : (t, 3) int array
            They may be turned in any way.
        tags : (t,) int array, optional
            0 by default.
        flat_angle : float
            The largest angle to the plane of the facet, in degrees.
        flatness : float
            The largest distance of a point from that plane, in diagonals of the surface.
        **others
            Edges, points kept, names, regions and holes, as `PLC` takes them.
        """
        places = as_points(points)
        rows = as_rows(triangles, "triangles", 3)
        if places.shape[1] != 3:
            raise ValueError("a surface has points (n, 3)")
        require_in_range("triangles", rows, len(places))
        require_different(rows)
        given = as_tags(tags, "tags", len(rows))
        owners = planar_facets(places, rows, given, flat_angle=flat_angle, flatness=flatness)
        first = np.unique(owners, return_index=True)[1]
        facets = SurfaceFacets(places, rows, owners)
        return cls(places, facets=facets, facet_tags=given[first], **others)

    @classmethod
    def from_mesh(
        cls, mesh: AnyMesh, *, flat_angle: float = FLAT_ANGLE, flatness: float = FLATNESS
    ) -> PLC:
        """Return the complex whose facets are those of a mesh, with tags, names and regions.

        Each part of a region, as the facets bound it, has a seed in its largest cell.

        Parameters
        ----------
        mesh : Mesh or other mesh object
        flat_angle, flatness : float
            See `from_surface`.
        """
        border = MeshBorder.of(as_mesh(mesh))
        if border.points.shape[1] == 2:
            return cls(
                border.points,
                edges=border.facets,
                edge_tags=border.facet_tags,
                **border.others,
            )
        return cls.from_surface(
            border.points,
            border.facets,
            border.facet_tags,
            flat_angle=flat_angle,
            flatness=flatness,
            **border.others,
        )

    @property
    def dim(self) -> int:
        """Dimension of the domain, 2 or 3."""
        return int(self.points.shape[1])

    @property
    def n_points(self) -> int:
        """Number of points."""
        return len(self.points)

    @property
    def n_facets(self) -> int:
        """Number of facets."""
        return len(self.facet_tags)

    def _figures(self) -> dict[str, Any]:
        counts: dict[str, Any] = {"dim": self.dim, "points": self.n_points}
        if self.dim == 3:
            counts |= {"facets": self.n_facets, "triangles": len(self.triangles)}
        counts |= {"segments": len(self.segments), "regions": len(self.regions)}
        return {**counts, "names": ", ".join(sorted(self.names.values())) or None}

    def _drawing(self) -> str:
        return drawing_of(self.points, self.triangles, self.segments) if self.dim == 2 else ""


def _triangulated(
    points: Floats, facets: FacetLoops | SurfaceFacets, edges: Ints, flatness: float
) -> tuple[Ints, Ints]:
    if len(facets) == 0:
        return np.zeros((0, 3), np.int32), np.zeros(0, np.int32)
    return facets.triangulated(points, edges, flatness * diagonal(points))
