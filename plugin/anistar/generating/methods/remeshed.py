"""The first mesh by the mesher of `remesh`."""

from __future__ import annotations

import numpy as np

from ...base.arrays import Floats
from ...meshes.mesh import Mesh
from ...metric import from_sizes, intersected
from ...metric.base.mesh import diameter
from ...remeshing.remesh import remesh
from ...remeshing.report import RemeshReport
from ..first_mesh import FirstMesh
from ..options import GenerateOptions
from ..sizes.wishes import Wish
from .stages import FIRST_LOOK, Clock, Stage

#: A wish that is not uniform is looked at on so many meshes at most.
MOST_PASSES = 6

#: Relative change of the number of points below which the last mesh has all that is wished for.
SETTLED = 0.05


def remeshed(first: FirstMesh, wish: Wish, options: GenerateOptions, clock: Clock) -> Stage:
    """Return the mesh that has what is wished for, within the options."""
    # in the plane, a line of segments that go straight on is one curve, which numbers would cut
    is_numbered = options.shape == "polyhedron" and first.plc.dim == 3
    mesh = geometry = first.mesh if is_numbered else first.smooth()
    reports: list[RemeshReport] = []
    for number in range(MOST_PASSES):
        before = mesh.n_points
        metric = wish.metric_on(mesh)
        if number == 0 and wish.may_surprise:
            metric = _looked_at_closely(mesh, metric)
        budget = options.as_remesh_options(
            max_seconds=clock.seconds_left(),
            # stars of a mesh that is remeshed again need not agree
            agreement="auto" if wish.is_settled or number > 0 else False,
        )
        done = remesh(mesh, metric, budget, geometry=geometry)
        mesh = done.mesh
        reports.append(done.report)
        if _is_last(wish, done.report, before, mesh, number):
            break
    last = reports[-1]
    return Stage(
        numbered=mesh if is_numbered else None,
        mesh=first.tagged(mesh) if is_numbered else mesh,
        stop_reason=last.stop_reason,
        remeshing=tuple(reports),
    )


def _is_last(wish: Wish, report: RemeshReport, before: int, mesh: Mesh, number: int) -> bool:
    if number == 0 and wish.may_surprise and report.stop_reason == "max_vertices":
        return False  # what was to be seen closely may be less than that look
    if wish.is_settled or not report.converged:
        return True
    return number > 0 and abs(mesh.n_points - before) <= SETTLED * before


def _looked_at_closely(mesh: Mesh, metric: Floats) -> Floats:
    """Return a metric that is fine enough everywhere to see what a wish is between the points."""
    look = from_sizes(np.full(mesh.n_points, diameter(mesh) / FIRST_LOOK), mesh.dim)
    return intersected(metric, look)
