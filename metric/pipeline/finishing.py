"""The stages that a factor on the metric goes through: bound and grade."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..base.arrays import Floats
from ..base.mesh import MeshLike, cell_volumes, diameter
from ..kernels.algebra import log_determinant
from ..kernels.gradation import wide_graph
from ..kernels.graph import VertexGraph
from ..kernels.growth import Growth
from ..laws.bounds import check_bounds, clipped
from ..laws.complexity import integral_of_exponential
from ..laws.gradation import TOLERANCE, GrowthLaw, grade_on
from ..sources.size_at import sizes_at
from ..tensors.checks import check_result
from .ledger import Stage
from .options import MetricOptions

MAX_REPEATS = 5
"""Of the gradation where the bound of anisotropy changes its result; two are usual."""


@dataclass(frozen=True, kw_only=True)
class Finishing:
    """Bounds and gradation on one mesh, with what they need at hand."""

    mesh: MeshLike
    graph: VertexGraph
    volumes: Floats
    h_min: Floats | None
    h_max: Floats
    a_max: Floats | None
    law: GrowthLaw

    def bounded(self, M: Floats) -> Floats:
        """Bound a metric."""
        return check_result(clipped(M, self.h_min, self.h_max, self.a_max), "the bounds")

    def finished(self, M: Floats) -> Growth:
        """Bound and grade a metric."""
        bounded = self.bounded(M)
        if self.law.is_off:
            return Growth(metric=bounded, rounds=0, updates=0, converged=True)
        for _ in range(MAX_REPEATS):
            growth = grade_on(self.graph, self.mesh.points, bounded, self.law)
            # An intersection of metrics within the bound of anisotropy can exceed it. Raising
            # the small eigenvalues again asks for gradation again; both only refine.
            bounded = clipped(growth.metric, None, None, self.a_max)
            if np.allclose(bounded, growth.metric, rtol=TOLERANCE, atol=0.0):
                break
        # the smallest size has the last word: what is not resolved there is not graded either
        return replace(growth, metric=clipped(bounded, self.h_min, None, self.a_max))

    def complexity(self, M: Floats) -> float:
        """Complexity of a checked metric."""
        return integral_of_exponential(self.mesh.cells, self.volumes, 0.5 * log_determinant(M))

    def stage(self, name: str, M: Floats, remark: str = "") -> Stage:
        """Return the line of the ledger for a metric."""
        return Stage(name=name, complexity=self.complexity(M), remark=remark)


def finishing_on(mesh: MeshLike, options: MetricOptions) -> Finishing:
    """Prepare the bounds and the gradation that the options ask for on a mesh."""
    n, d = mesh.points.shape
    h_max = diameter(mesh) if options.h_max is None else options.h_max
    low, high, ratio = check_bounds(
        n, h_min=options.h_min, h_max=h_max, a_max=options.a_max, points=mesh.points
    )
    assert high is not None  # h_max always has a value
    if options.size_at:
        named = sizes_at(mesh, options.size_at, options.gradation_for(d))
        high = np.minimum(high, named[:, None])
        _check_order(low, high)
    return Finishing(
        mesh=mesh,
        graph=wide_graph(mesh),
        volumes=cell_volumes(mesh),
        h_min=low,
        h_max=high,
        a_max=ratio,
        law=options.growth_law(d),
    )


def _check_order(low: Floats | None, high: Floats) -> None:
    if low is None:
        return
    bad = np.flatnonzero(np.broadcast_to(low > high, high.shape).any(axis=1))
    if bad.size:
        size, smallest = high[bad[0]].min(), np.broadcast_to(low, high.shape)[bad[0]].max()
        raise ValueError(
            f"size_at asks for {size:g} at point {bad[0]}, which is less than h_min = {smallest:g}"
        )
