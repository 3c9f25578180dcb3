"""The mesh: immutable arrays of simplices, tags and names."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import AnyArray, Bools, Floats, Ints
from ..metric.base.names import Tag, tags_called
from ..metric.base.told import Told
from .conversion import as_int32, as_rows, as_tags
from .plotted import Plotted, Subject
from .svg import drawing_of
from .topology import FacetTable, facet_table
from .violations import (
    Violation,
    cell_violations,
    constraint_violations,
    needs_facet,
    side_violations,
)

# Optional arrays are never None once constructed, so the fields keep their array types.
_NOT_GIVEN: Any = None

_FILES_ARE_SPLIT = "anistar.read splits those of a file, here give the simplices"
_UNSUPPORTED = {
    (2, 4): f"these are quadrilaterals: {_FILES_ARE_SPLIT}",
    (2, 6): "these are quadratic triangles: give the three corners, cells[:, :3]",
    (3, 8): f"these are hexahedra: {_FILES_ARE_SPLIT}",
    (3, 6): f"these are prisms, or a surface mesh: {_FILES_ARE_SPLIT}",
    (3, 5): f"these are pyramids: {_FILES_ARE_SPLIT}",
    (3, 10): "these are quadratic tetrahedra: give the four corners, cells[:, :4]",
    (3, 3): "surface meshes in 3D are not supported; for a plane at one height give points[:, :2] "
    "and z=points[0, 2]",
}


@dataclass(frozen=True, eq=False)
class Mesh(Plotted, Told):
    """A conforming simplicial mesh of a 2D or 3D domain, with tags and names.

    The constructor converts what can be converted without loss, checks everything that
    `anistar.validate` checks, and adds the facets on the boundary and between regions that were
    not given, with tag 0. Boundary facets are turned outward (2D: the domain lies on the left of
    ``a -> b``). All arrays are copies and read-only.

    Parameters
    ----------
    points : (n, d) float array
        Coordinates, d = 2 or 3.
    cells : (m, d + 1) int array
        Positively oriented triangles or tetrahedra.
    cell_tags : (m,) int array, optional
        Region of each cell, 0 by default.
    facets : (k, d) int array, optional
        Boundary and internal facets that carry a tag. An internal facet between cells of the
        same region is a slit.
    facet_tags : (k,) int array, optional
        Tags of the facets, 0 by default.
    edges : (e, 2) int array, optional
        Ridges, in 3D only.
    edge_tags : (e,) int array, optional
        Tags of the ridges, 0 by default.
    corners : (c,) int array, optional
        Points that a remesher must keep.
    names : mapping of (dim, tag) to str, optional
        Names of tags; `dim` is that of the tagged entities.
    z : float, optional
        Height of the plane of a 2D mesh in space, 0 by default; 0 in 3D. Nothing is computed with
        it: files and other programs that have three coordinates get it.

    Raises
    ------
    TypeError
        If an array cannot be converted without loss, or cells have mixed types.
    ValueError
        If the mesh is not valid; the message names the culprit.
    """

    points: Floats
    cells: Ints
    _: KW_ONLY
    cell_tags: Ints = _NOT_GIVEN
    facets: Ints = _NOT_GIVEN
    facet_tags: Ints = _NOT_GIVEN
    edges: Ints = _NOT_GIVEN
    edge_tags: Ints = _NOT_GIVEN
    corners: Ints = _NOT_GIVEN
    names: dict[tuple[int, int], str] = field(default_factory=dict)
    z: float = 0.0

    def __post_init__(self) -> None:
        points = _as_points(self.points)
        cells = _as_cells(self.cells, points.shape[1])
        arrays = _constraints(self, points.shape[1], len(cells))
        _raise_first(cell_violations(points, cells))
        table = facet_table(cells, len(points))
        _raise_first(side_violations(points, cells, table))
        given: dict[str, Any] = {"points": points, "cells": cells, **arrays}
        _raise_first(
            constraint_violations(
                points, cells, arrays["facets"], arrays["edges"], arrays["corners"], table
            )
        )
        _complete_facets(given, table)
        names = _as_names(self.names, points.shape[1])
        self._store(given, names, _as_height(self.z, points.shape[1]))

    @classmethod
    def _trusted(cls, **arrays: Any) -> Mesh:
        """Return a mesh of arrays that are known to be valid: nothing is checked or completed."""
        mesh = object.__new__(cls)
        names, z = arrays.pop("names", {}), arrays.pop("z", 0.0)
        dim, n_cells = arrays["points"].shape[1], len(arrays["cells"])
        n_facets = len(arrays["facets"]) if "facets" in arrays else 0
        n_edges = len(arrays["edges"]) if "edges" in arrays else 0
        defaults = {
            "cell_tags": np.zeros(n_cells, np.int32),
            "facets": np.zeros((0, dim), np.int32),
            "facet_tags": np.zeros(n_facets, np.int32),
            "edges": np.zeros((0, 2), np.int32),
            "edge_tags": np.zeros(n_edges, np.int32),
            "corners": np.zeros(0, np.int32),
        }
        mesh._store({**defaults, **arrays}, dict(names), z)
        return mesh

    def _store(
        self, arrays: Mapping[str, AnyArray], names: dict[tuple[int, int], str], z: float
    ) -> None:
        for name, array in arrays.items():
            view = array.view()
            view.flags.writeable = False
            object.__setattr__(self, name, view)
        object.__setattr__(self, "names", names)
        object.__setattr__(self, "z", z)

    @property
    def dim(self) -> int:
        """Dimension of the domain, 2 or 3."""
        return int(self.points.shape[1])

    @property
    def n_points(self) -> int:
        """Number of points."""
        return len(self.points)

    @property
    def n_cells(self) -> int:
        """Number of cells."""
        return len(self.cells)

    @property
    def n_facets(self) -> int:
        """Number of boundary and internal facets that are stored."""
        return len(self.facets)

    def facets_of(self, called: Tag | Sequence[Tag]) -> Ints:
        """Return the facets (k, d), rows of points, that have a name or a tag.

        Parameters
        ----------
        called : str, int, or sequence of these
            ``mesh.facets_of("wall")``; ``np.unique`` of it are the points there.

        Raises
        ------
        ValueError
            If no facet is called so; the nearest name is suggested.
        """
        tags = tags_called(called, self.names, self.dim - 1, self.facet_tags)
        return np.asarray(self.facets[np.isin(self.facet_tags, tags)])

    def region(self, called: Tag | Sequence[Tag]) -> Bools:
        """Return which cells (m,) are of the regions that have a name or a tag.

        Parameters
        ----------
        called : str, int, or sequence of these
            ``np.where(mesh.region("steel"), 50.0, 1.0)`` is a conductivity for each cell.

        Raises
        ------
        ValueError
            If no cell is called so; the nearest name is suggested.
        """
        tags = tags_called(called, self.names, self.dim, self.cell_tags, kind="cell")
        return np.isin(self.cell_tags, tags)

    def arrays(self) -> dict[str, Any]:
        """Return the arrays, names and height by field name, as the constructor takes them."""
        return {item.name: getattr(self, item.name) for item in fields(self)}

    def _subject(self) -> Subject:
        return Subject(mesh=self)

    def _figures(self) -> dict[str, Any]:
        counts = {"points": self.n_points, "cells": self.n_cells, "facets": self.n_facets}
        return {"dim": self.dim, **counts, "names": ", ".join(sorted(self.names.values())) or None}

    def _drawing(self) -> str:
        return drawing_of(self.points, self.cells, self.facets)

    def __repr__(self) -> str:
        return (
            f"Mesh(dim={self.dim}, n_points={self.n_points}, n_cells={self.n_cells}, "
            f"n_facets={self.n_facets}, names={sorted(self.names.values())})"
        )


def _raise_first(violations: Iterable[Violation]) -> None:
    for violation in violations:
        raise ValueError(violation.message)


def _as_points(given: ArrayLike) -> Floats:
    points = np.asarray(given)
    if points.dtype.kind not in "biuf":
        raise TypeError(f"points must be real numbers, not {points.dtype}")
    if points.ndim != 2 or (points.size and points.shape[1] not in (2, 3)):
        raise ValueError(f"points must have shape (n, 2) or (n, 3), not {points.shape}")
    if len(points) == 0:
        raise ValueError("the mesh is empty: it has no points")
    return np.array(points, dtype=np.float64, order="C")


def _as_cells(given: ArrayLike, dim: int) -> Ints:
    try:
        cells = np.asarray(given)
    except ValueError as error:
        raise TypeError("cells of mixed types: every cell must be of one type") from error
    if cells.dtype == object:
        raise TypeError("cells of mixed types: every cell must be of one type")
    if len(np.atleast_1d(cells)) == 0:
        raise ValueError("the mesh is empty: it has no cells")
    if cells.ndim != 2:
        raise ValueError(f"cells must have shape (m, {dim + 1}), not {cells.shape}")
    if cells.shape[1] != dim + 1:
        reason = _UNSUPPORTED.get((dim, cells.shape[1]), "only triangles and tetrahedra are")
        raise ValueError(
            f"cells must have shape (m, {dim + 1}) for {dim}D points, not {cells.shape}: {reason}"
        )
    return as_int32(cells, "cells")


def _constraints(mesh: Mesh, dim: int, n_cells: int) -> dict[str, Ints]:
    """Return tags, facets, edges and corners with defaults filled in and shapes checked."""
    facets = as_rows(mesh.facets, "facets", dim)
    edges = as_rows(mesh.edges, "edges", 2)
    if dim == 2 and len(edges):
        raise ValueError("edges are the ridges of a 3D mesh; in 2D give facets")
    corners = as_int32([] if mesh.corners is None else mesh.corners, "corners")
    if corners.ndim != 1:
        raise ValueError(f"corners must have shape (c,), not {corners.shape}")
    return {
        "cell_tags": as_tags(mesh.cell_tags, "cell_tags", n_cells),
        "facets": facets,
        "facet_tags": as_tags(mesh.facet_tags, "facet_tags", len(facets)),
        "edges": edges,
        "edge_tags": as_tags(mesh.edge_tags, "edge_tags", len(edges)),
        "corners": corners,
    }


def _complete_facets(arrays: dict[str, Any], table: FacetTable) -> None:
    """Turn boundary facets outward and add the missing facets, with tag 0."""
    rows = table.find(arrays["facets"])
    boundary = table.counts[rows] == 1
    arrays["facets"][boundary] = table.facets[rows[boundary]]
    needed = needs_facet(arrays["cell_tags"], table)
    needed[rows] = False
    missing = table.facets[needed]
    arrays["facets"] = np.concatenate([arrays["facets"], missing])
    arrays["facet_tags"] = np.r_[arrays["facet_tags"], np.zeros(len(missing), np.int32)]


def _as_names(given: Mapping[tuple[int, int], str], dim: int) -> dict[tuple[int, int], str]:
    names: dict[tuple[int, int], str] = {}
    for key, name in given.items():
        if not (isinstance(key, tuple) and len(key) == 2):
            raise TypeError(f"names must have keys (dim, tag), not {key!r}")
        if not isinstance(name, str):
            raise TypeError(f"the name of {key} must be a string, not {name!r}")
        if not 0 <= key[0] <= dim:
            raise ValueError(f"names has dimension {key[0]} in {key}, the mesh has {dim}")
        names[int(key[0]), int(key[1])] = name
    return names


def _as_height(given: float, dim: int) -> float:
    z = float(given)
    if not math.isfinite(z):
        raise ValueError(f"z, the height of the plane of a 2D mesh, is {z}, not finite")
    if dim == 3 and z != 0.0:
        raise ValueError(f"z is the height of the plane of a 2D mesh, a 3D mesh has none, not {z}")
    return z + 0.0  # no negative zero
