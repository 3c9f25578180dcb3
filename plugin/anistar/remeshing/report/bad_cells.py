"""The cells that a remesher had to leave worse than it should, by name."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...base.arrays import Floats
from ...judging.quality import mean_ratios
from ...meshes.mesh import Mesh

#: Mean ratio in the metric below which a cell is named in any case.
BAD_QUALITY = 1e-3
_MOST_NAMED = 10
# Cells are compared in single precision.
_KEPT_PART = 0.999


@dataclass(frozen=True, slots=True, kw_only=True)
class BadCell:
    """A cell, its mean ratio in the metric, and its centre.

    Attributes
    ----------
    cell : int
        Row in the cells of the new mesh.
    quality : float
    place : sequence of float
        Mean of its corners, in mesh units.
    """

    cell: int
    quality: float
    place: Sequence[float]


def quality_bound(kept: float) -> float:
    """Return below what cells are named where the mean ratio `kept` was to be kept."""
    return max(BAD_QUALITY, _KEPT_PART * kept)


def worst_cells(
    mesh: Mesh, M: Floats, bound: float = BAD_QUALITY
) -> tuple[int, tuple[BadCell, ...]]:
    """Return how many cells have a mean ratio below `bound`, and the ten worst of them.

    Parameters
    ----------
    mesh : Mesh
    M : (n, d, d) float64
        Metric at the points, up to a factor.
    bound : float
    """
    ratios = mean_ratios(mesh, M)
    bad = np.flatnonzero(~(ratios >= bound))
    worst = bad[np.argsort(ratios[bad], kind="stable")][:_MOST_NAMED]
    named = tuple(
        BadCell(
            cell=int(c),
            quality=float(ratios[c]),
            place=tuple(mesh.points[mesh.cells[c]].mean(axis=0).tolist()),
        )
        for c in worst
    )
    return len(bad), named
