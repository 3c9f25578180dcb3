"""The edges that a remesher had to leave too long, by name."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from ...base.arrays import Floats
from ...judging.quality import metric_lengths
from ...meshes.mesh import Mesh
from ...meshes.topology import unique_edges

#: Length in the metric above which an edge is named.
LONG_EDGE = 2.0
_MOST_NAMED = 10


@dataclass(frozen=True, slots=True, kw_only=True)
class LongEdge:
    """An edge, its length in the metric, and its middle.

    Attributes
    ----------
    ends : sequence of int
        Its two points in the new mesh.
    length : float
        In the metric.
    place : sequence of float
        Its middle, in mesh units.
    """

    ends: Sequence[int]
    length: float
    place: Sequence[float]

    def as_dict(self) -> dict[str, Any]:
        """Return it as JSON builtins."""
        return {**asdict(self), "ends": list(self.ends), "place": list(self.place)}


def longest_edges(mesh: Mesh, M: Floats) -> tuple[LongEdge, ...]:
    """Return the edges that are longer than 2 in the metric, the ten longest at most.

    Parameters
    ----------
    mesh : Mesh
    M : (n, d, d) float64
        Metric at the points, in 1 / length**2.
    """
    edges = unique_edges(mesh.cells, mesh.n_points)
    lengths = metric_lengths(mesh, M, edges)
    long = np.flatnonzero(lengths > LONG_EDGE)
    longest = long[np.argsort(-lengths[long], kind="stable")][:_MOST_NAMED]
    return tuple(
        LongEdge(
            ends=tuple(edges[e].tolist()),
            length=float(lengths[e]),
            place=tuple(mesh.points[edges[e]].mean(axis=0).tolist()),
        )
        for e in longest
    )
