"""The constrained Delaunay mesh of a complex, to whose facets and segments it conforms."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ... import _core
from ...base.arrays import Floats
from ...base.core_errors import meshing_errors
from ...base.progress import task
from ..geometry.plc import PLC
from ..options import GenerateOptions
from ..pieces import Pieces

#: Rules of the core, by what the options call them.
RULES = {"regions": "parity", "winding": "winding", "nonzero": "nonzero"}

#: Products of five such lengths stay far from the ends of the range of doubles.
LARGEST, SMALLEST = 1e30, 1e-30


@dataclass(frozen=True, kw_only=True, eq=False)
class Constrained(Pieces):
    """Tetrahedra that conform to a complex, and how they came about.

    The tag of a cell is that of a region with a seed, its winding number, or else a number from one
    on; walls are turned as the facets are. Some Steiner points are of no cell: they are ends
    between which others in the volume were placed.

    Attributes
    ----------
    counts : dict of str to int
        What was missing, placed, flipped and removed on the way.
    warnings : tuple of str
    """

    counts: dict[str, int]
    warnings: tuple[str, ...] = ()


def constrained(
    plc: PLC, options: GenerateOptions | None = None, *, facets_may_flip: bool = True
) -> Constrained:
    """Return the constrained Delaunay tetrahedra of a complex.

    Parameters
    ----------
    plc : PLC
        In 3D.
    options : GenerateOptions, optional
        Of which `inside` and `callback` matter.
    facets_may_flip : bool
        Whether facets that are planar within their flatness may be cut into other triangles than
        those of the complex, which spares most Steiner points. The surface moves within the
        flatness then; else it stays as it is.

    Raises
    ------
    ValueError
        If coordinates are out of range.
    MeshingError
        If facets cross, an edge passes through a point, a facet encloses nothing and the like;
        names the culprit and the place.
    """
    options = GenerateOptions() if options is None else options
    points, scale = _scaled(plc.points)
    seeds = np.array([region.seed for region in plc.regions]).reshape(-1, 3)
    with task("constrained mesh") as line, meshing_errors(scale):
        made = _core.constrained_tetrahedra(
            points=points,
            triangles=plc.triangles,
            triangle_facets=plc.triangle_facets,
            segments=plc.segments,
            kept_points=plc.points_kept,
            seeds=seeds * scale,
            seed_tags=np.array([region.tag for region in plc.regions], np.int32),
            holes=plc.holes * scale,
            rule=RULES[options.inside],
            facets_may_flip=facets_may_flip,
            max_seconds=math.inf,
            callback=line.callback(options.callback),
        )
    return _unscaled(made, plc, scale)


def _unscaled(made: dict[str, Any], plc: PLC, scale: float) -> Constrained:
    points = made["points"]
    points /= scale
    points[: plc.n_points] = plc.points
    counts = made["counts"]
    return Constrained(
        points=points,
        cells=made["cells"],
        cell_tags=made["cell_regions"],
        walls=made["walls"],
        wall_facets=made["wall_facets"],
        edges=made["edges"],
        edge_segments=made["edge_segments"],
        steiner_ends=made["steiner_ends"],
        steiner_shares=made["steiner_fractions"],
        counts=counts,
        warnings=_warnings(counts),
    )


def _warnings(counts: dict[str, int]) -> tuple[str, ...]:
    on_flat_walls = counts["flat_on_flat_walls"]
    near_planes = counts["flat_left"] - on_flat_walls
    warnings = []
    if near_planes:
        warnings.append(
            f"{near_planes} cells of the constrained mesh are flat: points are too near to a plane"
        )
    if on_flat_walls:
        warnings.append(
            f"{on_flat_walls} cells of the constrained mesh are flat, as they are on triangles of "
            "facets that have no area to speak of"
        )
    return tuple(warnings)


def _scaled(points: Floats) -> tuple[Floats, float]:
    """Return points among which products do not leave the range of doubles, and their scale.

    It is a power of two, which changes no digits.
    """
    largest = float(np.abs(points).max(initial=0.0))
    extent = float(np.ptp(points, axis=0).max(initial=0.0))
    if largest <= LARGEST and extent >= SMALLEST:
        return points, 1.0
    scale = math.ldexp(1.0, -math.frexp(largest)[1])
    scaled = points * scale
    lost = np.flatnonzero((scaled / scale != points).any(axis=1))
    if lost.size:
        raise ValueError(
            f"point {lost[0]} is at {points[lost[0]]}, out of range beside others at {largest:g}"
        )
    return scaled, scale
