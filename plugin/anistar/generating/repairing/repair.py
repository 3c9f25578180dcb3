"""A complex with what is wrong put right, as far as that is asked for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from ... import _core
from ...base.arrays import Bools
from ...base.errors import MeshingError
from ..checking import check_plc
from ..geometry.plc import PLC
from ..given import as_plc
from .report import RepairReport
from .soup import Soup
from .stitching import merged, stitched, without_flat

#: In diagonals of the complex: points that are closer are stitched together.
TOLERANCE = 1e-6

#: Cutting rounds points, after which triangles may cross again: so often at most.
MOST_ROUNDS = 5

_MEETING = ("crossing", "overlap", "touching", "point on edge", "point on facet")


def repaired(
    geometry: Any, repair: str = "none", *, tolerance: float | None = None
) -> tuple[PLC, RepairReport]:
    """Return a complex with what is wrong put right, and what that changed.

    Parameters
    ----------
    geometry : PLC, path, or surface of another package
        In 3D, unless nothing is asked for.
    repair : {"none", "orient", "stitch", "resolve"}
        "orient" turns facets to one sense, outward where they bound a volume. "stitch" makes
        points within the tolerance one, drops triangles that are repeated or lower than that, and
        joins borders that nearly meet. "resolve" cuts triangles where they cross; what is
        inside is then told by winding numbers.
    tolerance : float, optional
        For "stitch", as a length; 1e-6 of the diagonal by default.

    Returns
    -------
    plc : PLC
        Tags, names, regions and holes are kept; after "stitch" and "resolve" what is planar and of
        one tag is one facet.
    report : RepairReport

    Raises
    ------
    MeshingError
        If triangles still cross after they were cut and rounded several times.
    """
    if repair not in REPAIRS:
        raise ValueError(f"repair must be one of {', '.join(REPAIRS)}, not {repair!r}")
    plc = as_plc(geometry)
    if repair == "none":
        return plc, RepairReport()
    if plc.dim == 2:
        raise ValueError(f'repair="{repair}" is for geometry in 3D')
    length = TOLERANCE * _diagonal(plc) if tolerance is None else float(tolerance)
    if not length >= 0:
        raise ValueError(f"tolerance must be a length, not {tolerance}")
    return REPAIRS[repair](plc, length)


def _diagonal(plc: PLC) -> float:
    extent = plc.points.max(axis=0) - plc.points.min(axis=0)
    return float(np.sqrt(np.square(extent).sum()))


def _unchanged(plc: PLC, tolerance: float) -> tuple[PLC, RepairReport]:
    return plc, RepairReport()


def _oriented(plc: PLC, tolerance: float) -> tuple[PLC, RepairReport]:
    """Turn facets, which are of one sense each."""
    is_turned, _, n_one_sided = _core.turned_triangles(plc.points, plc.triangles)
    turned = np.zeros(plc.n_facets, bool)
    turned[plc.triangle_facets[is_turned.astype(bool)]] = True
    n_turned = int(np.count_nonzero(turned))
    report = RepairReport(
        repair="orient", turned_facets=n_turned, one_sided_parts=n_one_sided, rounds=1
    )
    return (_with_turned_facets(plc, turned) if n_turned else plc), report


def _with_turned_facets(plc: PLC, turned: Bools) -> PLC:
    facets = [
        tuple(loop[::-1] for loop in loops) if turn else loops
        for loops, turn in zip(plc.facets, turned, strict=True)
    ]
    try:
        return PLC(
            plc.points,
            facets=facets,
            facet_tags=plc.facet_tags,
            edges=plc.edges,
            edge_tags=plc.edge_tags,
            points_kept=plc.points_kept,
            names=plc.names,
            regions=plc.regions,
            holes=plc.holes,
        )
    except ValueError:  # grown from triangles that make no polygon: turn those
        triangles = plc.triangles.copy()
        rows = turned[plc.triangle_facets]
        triangles[rows] = triangles[rows][:, ::-1]
        soup = replace(Soup.of(plc), triangles=triangles)
        return soup.complex_like(plc)


def _stitched(plc: PLC, tolerance: float) -> tuple[PLC, RepairReport]:
    done = stitched(Soup.of(plc), tolerance)
    return done.soup.complex_like(plc), RepairReport(
        repair="stitch",
        merged_points=done.merged_points,
        dropped_triangles=done.dropped_triangles,
        split_edges=done.split_edges,
        rounds=done.rounds,
    )


def _resolved(plc: PLC, tolerance: float) -> tuple[PLC, RepairReport]:
    """Cut triangles where they meet until none do."""
    soup = Soup.of(plc)
    n_cut = n_merged = n_dropped = 0
    for rounds in range(1, MOST_ROUNDS + 1):
        points, triangles, sources = _core.cut_triangles(
            np.ascontiguousarray(soup.points), np.ascontiguousarray(soup.triangles)
        )
        n_cut += int(np.count_nonzero(np.bincount(sources, minlength=1) > 1))
        cut = Soup(points, triangles, soup.facets[sources], soup.edges, soup.points_kept)
        soup = without_flat(merged(cut, 0.0), 0.0)
        n_merged += len(points) - len(soup.points)
        n_dropped += len(triangles) - len(soup.triangles)
        made = soup.complex_like(plc)
        left = [problem for problem in check_plc(made) if problem.kind in _MEETING]
        if not left:
            return made, RepairReport(
                repair="resolve",
                cut_triangles=n_cut,
                merged_points=n_merged,
                dropped_triangles=n_dropped,
                rounds=rounds,
            )
    raise MeshingError(
        f"cut and rounded {MOST_ROUNDS} times, still {left[0].message}; "
        "wrap the surface, or simplify it there"
    )


REPAIRS: dict[str, Callable[[PLC, float], tuple[PLC, RepairReport]]] = {
    "none": _unchanged,
    "orient": _oriented,
    "stitch": _stitched,
    "resolve": _resolved,
}
"""What can be asked for."""
