"""The piecewise linear complex: points, facets, segments, regions and holes, with tags and names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import AnyArray, Floats, Ints
from ..meshes.mesh import as_int32
from ..metric.base.told import Told
from .facet_loops import FacetLoops, Loops
from .planar_facets import FLAT_ANGLE, FLATNESS, planar_facets
from .region import Region
from .segments import segments_of
from .triangulated_facets import triangulated

_NOT_GIVEN: Any = None


@dataclass(frozen=True, eq=False)
class PLC(Told):
    """The geometry of a domain, in 2D or 3D, of which a mesh can be generated.

    Everything is checked at construction but where facets meet, which `anistar.check_plc` does.
    All arrays are copies and read-only.

    Parameters
    ----------
    points : (n, d) float array
        Coordinates, d = 2 or 3.
    facets : sequence of f facets, optional
        In 3D only. A facet is a sequence of point indices, or of such loops: the outer one first,
        then holes, and edges (two points) and points (one) that lie in the facet. An (f, 3) array
        of triangles serves as well.
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
    holes : (h, d) float array, optional
        Points in what is to be left empty.

    Attributes
    ----------
    triangles : (t, 3) int32
        The facets, triangulated.
    triangle_facets : (t,) int32
        The facet of each triangle.
    segments : (s, 2) int32
        The borders of facets and the edges given, each once, sorted by their points.
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
    names: dict[tuple[int, int], str] = field(default_factory=dict)
    regions: tuple[Region, ...] = ()
    holes: Floats = _NOT_GIVEN
    triangles: Ints = field(init=False)
    triangle_facets: Ints = field(init=False)
    segments: Ints = field(init=False)
    segment_tags: Ints = field(init=False)

    def __post_init__(self) -> None:
        points = _as_points(self.points)
        dim = points.shape[1]
        loops = FacetLoops.of(self.facets)
        if dim == 2 and len(loops):
            raise ValueError("facets are given in 3D only; in 2D give edges")
        _require_in_range("facets", loops.indices, len(points))
        edges = _as_edges(self.edges, points)
        triangles, triangle_facets = triangulated(points, loops, edges)
        arrays = {
            "points": points,
            "facet_tags": _as_tags(self.facet_tags, "facet_tags", len(loops)),
            "edges": edges,
            "edge_tags": _as_tags(self.edge_tags, "edge_tags", len(edges)),
            "points_kept": _as_kept(self.points_kept, len(points)),
            "holes": _as_holes(self.holes, dim),
            "triangles": triangles,
            "triangle_facets": triangle_facets,
        }
        self._store(loops, arrays, _as_regions(self.regions, dim))

    def _store(
        self, facets: Sequence[Loops], arrays: dict[str, Any], regions: tuple[Region, ...]
    ) -> None:
        arrays["segments"], arrays["segment_tags"] = segments_of(
            arrays["triangles"], arrays["triangle_facets"], arrays["edges"], arrays["edge_tags"]
        )
        for name, array in arrays.items():
            array.flags.writeable = False
            object.__setattr__(self, name, array)
        dim = arrays["points"].shape[1]
        object.__setattr__(self, "facets", facets)
        object.__setattr__(self, "regions", regions)
        object.__setattr__(self, "names", _as_names(self.names, regions, dim))

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
        """Return the complex of a triangle surface; what is planar in it becomes one facet.

        Parameters
        ----------
        points : (n, 3) float array
        triangles : (t, 3) int array
        tags : (t,) int array, optional
            0 by default. Triangles of one facet have one tag.
        flat_angle : float
            Largest angle in degrees between triangles of one facet.
        flatness : float
            Largest distance of a point from the plane of its facet, in diagonals of the surface.
        **others
            Edges, names, regions and the like, as `PLC` takes them.
        """
        rows = as_int32(triangles, "triangles")
        owners = planar_facets(_as_points(points), rows, tags, flat_angle, flatness)
        facet_tags = None if tags is None else np.asarray(tags)
        return cls(
            points, facets=rows[np.argsort(owners, kind="stable")], facet_tags=facet_tags, **others
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
        counts = {"points": self.n_points, "facets": self.n_facets, "segments": len(self.segments)}
        return {"dim": self.dim, **counts, "names": ", ".join(sorted(self.names.values())) or None}


def _as_points(given: ArrayLike) -> Floats:
    points = _as_floats(given, "points")
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise ValueError(f"points must have shape (n, 2) or (n, 3), not {points.shape}")
    if len(points) == 0:
        raise ValueError("the complex is empty: it has no points")
    _require_finite("point", points)
    return points


def _as_floats(given: ArrayLike, name: str) -> Floats:
    array = np.asarray(given)
    if array.dtype.kind not in "biuf":
        raise TypeError(f"{name} must be real numbers, not {array.dtype}")
    return np.array(array, dtype=np.float64, order="C")


def _require_finite(what: str, rows: Floats) -> None:
    bad = ~np.isfinite(rows).all(axis=1)
    if bad.any():
        at = int(np.argmax(bad))
        raise ValueError(f"{what} {at} is {tuple(rows[at].tolist())}, not finite")


def _require_in_range(name: str, indices: AnyArray, n_points: int) -> None:
    outside = (indices < 0) | (indices >= n_points)
    if outside.any():
        raise ValueError(
            f"{name} refer to point {indices[outside].flat[0]} (counting from 0), "
            f"there are {n_points} points"
        )


def _as_edges(given: ArrayLike | None, points: Floats) -> Ints:
    edges = np.zeros((0, 2), np.int32) if given is None else as_int32(given, "edges")
    if edges.size == 0:
        edges = edges.reshape(0, 2)
    if edges.ndim != 2 or edges.shape[1] != 2:
        raise ValueError(f"edges must have shape (e, 2), not {edges.shape}")
    _require_in_range("edges", edges, len(points))
    loops = edges[:, 0] == edges[:, 1]
    if loops.any():
        at = int(np.argmax(loops))
        raise ValueError(f"edges[{at}] joins point {edges[at, 0]} to itself")
    return edges


def _as_tags(given: ArrayLike | None, name: str, length: int) -> Ints:
    tags = np.zeros(length, np.int32) if given is None else as_int32(given, name)
    if tags.shape != (length,):
        raise ValueError(f"{name} must have shape ({length},), not {tags.shape}")
    return tags


def _as_kept(given: ArrayLike | None, n_points: int) -> Ints:
    kept = as_int32([] if given is None else given, "points_kept")
    if kept.ndim != 1:
        raise ValueError(f"points_kept must have shape (k,), not {kept.shape}")
    _require_in_range("points_kept", kept, n_points)
    return np.unique(kept)


def _as_holes(given: ArrayLike | None, dim: int) -> Floats:
    holes = np.zeros((0, dim)) if given is None else _as_floats(given, "holes")
    if holes.size == 0:
        holes = holes.reshape(0, dim)
    if holes.ndim != 2 or holes.shape[1] != dim:
        raise ValueError(f"holes must have shape (h, {dim}), not {holes.shape}")
    _require_finite("hole", holes)
    return holes


def _as_regions(given: Sequence[Region], dim: int) -> tuple[Region, ...]:
    regions = tuple(given)
    for number, region in enumerate(regions):
        if not isinstance(region, Region):
            raise TypeError(f"regions[{number}] must be a Region, not {type(region).__name__}")
        if len(region.seed) != dim:
            raise ValueError(
                f"the seed of regions[{number}] has {len(region.seed)} coordinates, "
                f"the points have {dim}"
            )
    return regions


def _as_names(
    given: Mapping[tuple[int, int], str] | None, regions: tuple[Region, ...], dim: int
) -> dict[tuple[int, int], str]:
    names: dict[tuple[int, int], str] = {}
    for key, name in (given or {}).items():
        if not (isinstance(key, tuple) and len(key) == 2):
            raise TypeError(f"names must have keys (dim, tag), not {key!r}")
        if not isinstance(name, str):
            raise TypeError(f"the name of {key} must be a string, not {name!r}")
        if not 0 <= key[0] <= dim:
            raise ValueError(f"names has dimension {key[0]} in {key}, the complex has {dim}")
        names[int(key[0]), int(key[1])] = name
    for region in regions:
        if region.name is not None and names.setdefault((dim, region.tag), region.name) != (
            region.name
        ):
            other = names[dim, region.tag]
            raise ValueError(f"region {region.tag} is called {region.name!r} and {other!r}")
    return names
