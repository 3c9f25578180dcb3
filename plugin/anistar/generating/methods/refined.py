"""The first mesh by Delaunay refinement of the constrained one."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...base.arrays import Floats
from ...base.progress import task
from ...metric import from_sizes, graded
from ...metric.base.mesh import diameter
from ..first_mesh import FirstMesh
from ..options import GenerateOptions
from ..pieces import Pieces
from ..sizes.wishes import Carried, Together, Wish
from .plane import BOUND, PlaneBudget, PlanePieces, refined_plane
from .refinement import BOUND as DEFAULT_BOUND
from .refinement import RefinementParameters, refined_tetrahedra
from .stages import FIRST_LOOK, Clock, Stage

#: A wish that is not uniform is looked at on so many meshes at most.
MOST_ROUNDS = 8

#: A metric is isotropic if it differs from that of a size by no larger a share.
ISOTROPIC = 1e-6


def refined(first: FirstMesh, wish: Wish | None, options: GenerateOptions, clock: Clock) -> Stage:
    """Return the refined mesh, none of whose edges is much longer than what is wished for.

    Sizes are linear between the points where a wish is looked at; where refinement has added
    points, it is looked at again.
    """
    if wish is not None and wish.may_surprise:
        wish = _seen_closely(first, wish, options, clock)
    mesh, reason = first, "finished"
    record: dict[str, Any] = {}
    for _ in range(MOST_ROUNDS):
        sizes = None if wish is None else _sizes(mesh, wish)
        made, record, reason = _refined(first, mesh.pieces, sizes, options, clock)
        has_grown = len(made.points) > len(mesh.pieces.points)
        mesh = FirstMesh.of(first.plc, made)
        if wish is None or wish.is_settled or not has_grown or reason != "finished":
            break
    return Stage(mesh=mesh.tagged(), numbered=mesh.mesh, stop_reason=reason, refinement=record)


def _seen_closely(first: FirstMesh, wish: Wish, options: GenerateOptions, clock: Clock) -> Together:
    """Return a wish that leads from coarse meshes to what is wished for between their points.

    Refinement never coarsens: what is seen on a finer mesh asks for no smaller cells than it takes
    to see it again.
    """
    look = diameter(first.mesh) / FIRST_LOOK
    everywhere = np.full(len(first.pieces.points), look)
    pieces, _, _ = _refined(first, first.pieces, everywhere, options, clock)
    mesh = FirstMesh.of(first.plc, pieces).mesh
    seen = np.maximum(_lengths(wish.metric_on(mesh)), look / 2.0)
    led = graded(mesh, from_sizes(seen, mesh.dim), factor=options.growth)
    return Together([wish, Carried(mesh, led)])


def _sizes(mesh: FirstMesh, wish: Wish) -> Floats:
    """Return an isotropic wish as sizes at all points of the pieces; unused ones have no wish."""
    sizes = np.full(len(mesh.pieces.points), np.inf)
    sizes[mesh.origin] = _lengths(wish.metric_on(mesh.mesh))
    return sizes


def _lengths(metric: Floats) -> Floats:
    """Return the (n,) sizes of an isotropic metric (n, d, d).

    Raises
    ------
    ValueError
        If it is not isotropic, with the point.
    """
    squares = metric[:, 0, 0]
    off = np.abs(metric - squares[:, None, None] * np.eye(metric.shape[1])).max(axis=(1, 2))
    bad = np.flatnonzero(off > ISOTROPIC * squares)
    if bad.size:
        raise ValueError(
            f'method="refine" makes isotropic meshes, but the size at point {bad[0]} is a metric '
            'that is not: give it as metric to "remesh"'
        )
    return np.asarray(1.0 / np.sqrt(squares))


def _refined(
    first: FirstMesh, pieces: Pieces, sizes: Floats | None, options: GenerateOptions, clock: Clock
) -> tuple[Pieces, dict[str, Any], str]:
    """Return what refinement makes of pieces, what it counted, and why it ended."""
    seconds = clock.seconds_left()
    with task("refinement") as line:
        callback = line.callback(options.callback)
        if isinstance(pieces, PlanePieces):
            budget = PlaneBudget(
                max_vertices=options.max_vertices, max_seconds=seconds, callback=callback
            )
            bound = BOUND if options.bound is None else options.bound
            plane = refined_plane(first.plc, pieces, sizes, bound, budget)
            return plane, dict(plane.counts), plane.stop_reason
        parameters = RefinementParameters(
            bound=DEFAULT_BOUND if options.bound is None else options.bound,
            sliver_dihedral=options.sliver_dihedral,
            max_vertices=options.max_vertices,
            max_seconds=seconds,
            seed=options.seed,
        )
        made = refined_tetrahedra(pieces, sizes, parameters, callback)
        return made, made.record, made.stop_reason
