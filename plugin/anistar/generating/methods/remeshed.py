"""The first mesh by the mesher of `remesh`."""

from __future__ import annotations

import numpy as np

from ...base.arrays import Floats
from ...meshes.mesh import Mesh
from ...metric import bounded, from_sizes, intersected
from ...metric.base.mesh import diameter
from ...metric.kernels.elementary import power
from ...remeshing.remesh import remesh
from ...remeshing.report import RemeshReport
from ..first_mesh import FirstMesh
from ..options import GenerateOptions
from ..sizes.wishes import Wish
from .stages import FIRST_LOOK, Clock, Stage

#: A wish that is not settled is looked at on so many meshes at most.
MOST_PASSES = 10

#: Relative change of the number of points below which the last mesh has all that is wished for.
SETTLED = 0.05

#: How much smaller sizes may be from look to look: a coarse mesh, which has few points inside,
#: cannot say how sizes grow inward, and would be as fine there as on its facets.
SMALLER = 5.0


def remeshed(first: FirstMesh, wish: Wish | None, options: GenerateOptions, clock: Clock) -> Stage:
    """Return the mesh that has what is wished for, within the options."""
    if wish is None:
        raise ValueError("there is no size to remesh to")
    # in the plane, a line of segments that go straight on is one curve, which numbers would cut
    is_numbered = options.shape == "polyhedron" and first.plc.dim == 3
    mesh = geometry = first.mesh if is_numbered else first.smooth()
    reports: list[RemeshReport] = []
    for number in range(1 if wish.is_settled else MOST_PASSES):
        before = mesh.n_points
        metric, is_whole = _seen(mesh, wish, number)
        budget = options.as_remesh_options(
            max_seconds=clock.seconds_left(),
            # stars of a mesh that is remeshed again need not agree
            agreement="auto" if is_whole else False,
        )
        done = remesh(mesh, metric, budget, geometry=geometry)
        mesh = done.mesh
        reports.append(done.report)
        is_steady = is_whole and abs(mesh.n_points - before) <= SETTLED * before
        # what was to be seen closely may take less than that look
        may_be_less = number == 0 and wish.may_surprise and not clock.is_up
        if is_steady or not (done.report.converged or may_be_less):
            break
    return Stage(
        numbered=mesh if is_numbered else None,
        mesh=first.tagged(mesh) if is_numbered else mesh,
        stop_reason=reports[-1].stop_reason,
        remeshing=tuple(reports),
    )


def _seen(mesh: Mesh, wish: Wish, number: int) -> tuple[Floats, bool]:
    """Return what is wished for as far as a mesh can say it, and whether that is all."""
    metric = wish.metric_on(mesh)
    if wish.is_settled:
        return metric, True
    look = diameter(mesh) / FIRST_LOOK
    seen = bounded(metric, h_min=look * power(SMALLER, -number))
    is_whole = bool((seen == metric).all())
    if number == 0 and wish.may_surprise:
        seen = intersected(seen, from_sizes(np.full(mesh.n_points, look), mesh.dim))
    return seen, is_whole
