"""From the pieces that conform to a complex to an ordinary mesh, and back from a remeshed one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..base.arrays import Bools, Floats, Ints
from ..base.errors import MeshingError
from ..meshes.mesh import Mesh
from ..meshes.topology import vector_lengths
from ..metric import exp_metric, log_metric
from ..metric.kernels.elementary import exp, log
from .geometry.plc import PLC
from .pieces import Pieces

#: Two segments that meet at a point are one line if the sine of the angle between is less.
STRAIGHT = 1e-10


@dataclass(frozen=True, eq=False)
class FirstMesh:
    """A mesh that conforms to a complex, each of whose facets has a tag of its own.

    Attributes
    ----------
    plc : PLC
    mesh : Mesh
        The tag of a facet is its number in the complex.
    origin : (n,) int32
        The row of each point of the mesh in `pieces`.
    pieces : Pieces
    """

    plc: PLC
    mesh: Mesh
    origin: Ints
    pieces: Pieces

    @classmethod
    def of(cls, plc: PLC, pieces: Pieces) -> FirstMesh:
        """Return the mesh of the cells; points of no cell are left out.

        Raises
        ------
        MeshingError
            If it is no valid mesh; names the culprit.
        """
        origin = np.unique(pieces.cells).astype(np.int32)
        row = np.full(len(pieces.points), -1, np.int32)
        row[origin] = np.arange(len(origin), dtype=np.int32)
        arrays: dict[str, Any] = {}
        if plc.dim == 3:
            arrays["edges"], arrays["edge_tags"] = _used(pieces.edges, pieces.edge_segments, row)
        arrays["facets"], arrays["facet_tags"] = _used(pieces.walls, pieces.wall_facets, row)
        corners = row[_corners(plc)]
        try:
            mesh = Mesh(
                points=pieces.points[origin],
                cells=row[pieces.cells],
                cell_tags=pieces.cell_tags,
                corners=corners[corners >= 0],
                **arrays,
            )
        except ValueError as error:
            raise MeshingError(
                f"facets of the geometry are nearer to each other than doubles can tell: {error}"
            ) from error
        return cls(plc, mesh, origin, pieces)

    def tagged(self, mesh: Mesh | None = None) -> Mesh:
        """Return this mesh, or one that was made of it, with the tags and names of the complex."""
        mesh = self.mesh if mesh is None else mesh
        plc = self.plc
        facets = plc.facet_tags if mesh.dim == 3 else plc.segment_tags
        arrays: dict[str, Any] = {"facet_tags": facets[mesh.facet_tags]}
        if mesh.dim == 3:
            arrays["edge_tags"] = plc.segment_tags[mesh.edge_tags]
        return Mesh._trusted(
            points=mesh.points,
            cells=mesh.cells,
            cell_tags=mesh.cell_tags,
            facets=mesh.facets,
            edges=mesh.edges,
            corners=mesh.corners,
            names=plc.names,
            **arrays,
        )

    def smooth(self) -> Mesh:
        """Return it with the tags of the complex and the edges that were given, no others."""
        mesh = self.tagged()
        if mesh.dim == 2:
            return mesh
        given = _is_given(self.plc)[self.mesh.edge_tags]
        return Mesh._trusted(
            points=mesh.points,
            cells=mesh.cells,
            cell_tags=mesh.cell_tags,
            facets=mesh.facets,
            facet_tags=mesh.facet_tags,
            edges=mesh.edges[given],
            edge_tags=mesh.edge_tags[given],
            corners=self._rows_of(self.plc.points_kept),
            names=mesh.names,
        )

    def at_points(self, values: Floats) -> Floats:
        """Return at the points of the mesh what is known at those of the complex.

        Sizes (p,) or metrics (p, d, d) are interpolated along segments by their logarithms;
        infinite sizes stay so where an end of the segment has one.
        """
        ends, shares = self.pieces.steiner_ends, self.pieces.steiner_shares
        to_log, from_log = (log, exp) if values.ndim == 1 else (log_metric, exp_metric)
        known = to_log(values)
        n = len(known)
        known = np.concatenate([known, np.full((len(ends), *known.shape[1:]), np.nan)])
        # a Steiner point may lie between others: each round knows at least one more
        todo = np.arange(len(ends))
        while todo.size:
            ready = todo[_is_known(known[ends[todo]])]
            t = shares[ready].reshape(-1, *[1] * (known.ndim - 1))
            a, b = known[ends[ready, 0]], known[ends[ready, 1]]
            known[n + ready] = np.where(np.isinf(a) | np.isinf(b), np.inf, (1.0 - t) * a + t * b)
            todo = np.setdiff1d(todo, ready)
        return np.asarray(from_log(known)[self.origin])

    def _rows_of(self, points: Ints) -> Ints:
        """Return the rows in the mesh of points of the complex, where they are in it."""
        return np.flatnonzero(np.isin(self.origin, points)).astype(np.int32)


def _is_known(ends: Floats) -> Bools:
    """Return where all numbers of both ends are known."""
    return ~np.isnan(ends).any(axis=tuple(range(1, ends.ndim)))


def _used(simplices: Ints, owners: Ints, row: Ints) -> tuple[Ints, Ints]:
    """Return the simplices all of whose points are used, by their new numbers."""
    used = (row[simplices] >= 0).all(axis=1)
    return row[simplices[used]], owners[used]


def _is_given(plc: PLC) -> Bools:
    """Return which segments of a complex were given, and are no mere borders of facets."""
    n = plc.n_points
    given = np.sort(plc.edges.astype(np.int64), axis=1)
    segments = plc.segments.astype(np.int64)
    return np.isin(segments[:, 0] * n + segments[:, 1], given[:, 0] * n + given[:, 1])


def _corners(plc: PLC) -> Ints:
    """Return the points of a complex where segments end, turn, meet or change their tag."""
    ends = plc.segments.ravel()
    order = np.argsort(ends, kind="stable")
    count = np.bincount(ends, minlength=plc.n_points)
    at = np.flatnonzero(count == 2)
    start = (np.cumsum(count) - count)[at]
    one, two = order[start], order[start + 1]
    # position 2 s + i of `ends` is end i of segment s; its partner is the other end
    u = plc.points[ends[one ^ 1]] - plc.points[at]
    v = plc.points[ends[two ^ 1]] - plc.points[at]
    along = np.einsum("ni,ni->n", u, v)
    off_line = v - (along / np.einsum("ni,ni->n", u, u))[:, None] * u
    is_line = (along < 0.0) & (vector_lengths(off_line) <= STRAIGHT * vector_lengths(v))
    is_line &= plc.segment_tags[one // 2] == plc.segment_tags[two // 2]
    is_corner = count > 0
    is_corner[at[is_line]] = False
    is_corner[plc.points_kept] = True
    return np.flatnonzero(is_corner).astype(np.int32)
