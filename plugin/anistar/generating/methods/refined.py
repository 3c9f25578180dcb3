"""The first mesh by Delaunay refinement of the constrained one."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...base.arrays import Floats
from ...base.progress import task
from ..first_mesh import FirstMesh, Pieces
from ..options import GenerateOptions
from ..plane import BOUND, PlaneBudget, PlanePieces, refined_plane
from ..refinement import RefinementParameters, refined_tetrahedra
from ..sizes.wishes import Wish
from .stages import Clock, Stage

#: A wish that is not uniform is looked at on so many meshes at most.
MOST_ROUNDS = 8


def refined(first: FirstMesh, wish: Wish | None, options: GenerateOptions, clock: Clock) -> Stage:
    """Return the refined mesh, none of whose edges is much longer than what is wished for.

    Sizes are linear between the points where a wish is looked at; where refinement has added
    points, it is looked at again.
    """
    mesh, record, reason = first, {}, "finished"
    for _ in range(MOST_ROUNDS):
        sizes = None if wish is None else _sizes(mesh, wish)
        made, record, reason = _refined(first, mesh.pieces, sizes, options, clock)
        has_grown = len(made.points) > len(mesh.pieces.points)
        mesh = FirstMesh.of(first.plc, made)
        if wish is None or wish.is_settled or not has_grown or reason != "finished":
            break
    return Stage(mesh=mesh.tagged(), numbered=mesh.mesh, stop_reason=reason, refinement=record)


def _sizes(mesh: FirstMesh, wish: Wish) -> Floats:
    """Return an isotropic wish as sizes at all points of the pieces; unused ones have no wish."""
    sizes = np.full(len(mesh.pieces.points), np.inf)
    sizes[mesh.origin] = 1.0 / np.sqrt(wish.metric_on(mesh.mesh)[:, 0, 0])
    return sizes


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
            sliver_dihedral=options.sliver_dihedral,
            max_vertices=options.max_vertices,
            max_seconds=seconds,
            seed=options.seed,
            **({} if options.bound is None else {"bound": options.bound}),
        )
        made = refined_tetrahedra(pieces, sizes, parameters, callback)
        return made, made.record, made.stop_reason
