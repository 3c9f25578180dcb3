"""Compare the laws of gradation: what they add, what error they leave, which stars agree.

usage: python tests/benchmarks/compare_gradation.py [--dim 2] [--complexity 1600] [--case NAME]
       python tests/benchmarks/compare_gradation.py --million

Each metric is graded by each law and scaled until its complexity is the same after the
gradation, so that the rows of a case have equal numbers of vertices. In 2D the mesh is adapted
four times, with the metric evaluated at the vertices of the current mesh, and certified; in 3D
the metric alone is compared, on a grid, and the error is that of the continuous model.
`--million` times the gradation of a metric on a million vertices in 3D instead.
"""

from __future__ import annotations

import argparse
import math
import resource
import time
from dataclasses import dataclass

import numpy as np
from analytic_cases import CASES, Case, Floats, Function, grid
from rich.console import Console
from rich.table import Table

from anistar import Mesh, certify, metric, remesh
from anistar.judging.interpolation_error import l2_error
from anistar.judging.quality import quality
from anistar.metric.kernels.gradation import wide_graph
from anistar.metric.laws.gradation import GrowthLaw, grade_on
from anistar.metric.pipeline.rootfind import rescaling

PASSES = 4
GRID_3D = 26**3

LAWS = {
    "none": GrowthLaw(factor=None, model="physical"),
    "physical 1.3": GrowthLaw(factor=1.3, model="physical"),
    "physical 1.5": GrowthLaw(factor=1.5, model="physical"),
    "physical 2": GrowthLaw(factor=2.0, model="physical"),
    "mixed 1.5": GrowthLaw(factor=1.5, model="mixed"),
    "mixed 2": GrowthLaw(factor=2.0, model="mixed"),
    "metric 1.5": GrowthLaw(factor=1.5, model="metric"),
    "metric 2": GrowthLaw(factor=2.0, model="metric"),
    "physical 1.5, distortion .4": GrowthLaw(factor=1.5, model="physical", max_distortion=0.4),
    "distortion .5": GrowthLaw(factor=None, model="physical", max_distortion=0.5),
}


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """A graded metric of the wanted complexity, and how much of it the gradation added."""

    metric: Floats
    added: float


def graded_to(mesh: Mesh, M: Floats, law: GrowthLaw, complexity: float) -> Outcome:
    """Scale `M` such that its complexity is as wanted after the gradation."""
    graph = wide_graph(mesh)
    first = complexity / metric.complexity(mesh, M)
    base = first ** (2 / mesh.dim) * M

    def attempt(factor: float) -> tuple[float, Floats]:
        graded = factor * base
        if not law.is_off:
            graded = grade_on(graph, mesh.points, graded, law).metric
        return metric.complexity(mesh, graded), graded

    graded, best, _ = rescaling(attempt, complexity, mesh.dim)
    before = metric.complexity(mesh, best.factor * base)
    return Outcome(metric=graded, added=best.complexity / before - 1)


def adapted(case: Case, law: GrowthLaw, complexity: float) -> list[str]:
    """Return the row of a 2D case: the mesh after four passes."""
    first = mesh = case.start(complexity)
    for _ in range(PASSES):
        outcome = graded_to(mesh, case.metric(mesh.points), law, complexity)
        done = remesh(mesh, outcome.metric, geometry=first)
        mesh = done.mesh
    figures = quality(mesh, done.metric)
    stars = certify(mesh, done.metric).star_ok.mean()
    error = (
        ""
        if case.u is None
        else f"{mesh.n_points * l2_error(mesh, case.u(mesh.points), case.u):.3f}"
    )
    return [
        f"{100 * outcome.added:.0f}",
        *spread(mesh, done.metric),
        str(mesh.n_points),
        error,
        f"{100 * stars:.1f}",
        f"{100 * (figures.unit_edges or 0):.1f}",
    ]


def on_a_grid(case: Case, law: GrowthLaw, complexity: float) -> list[str]:
    """Return the row of a 3D case: the metric alone."""
    mesh = grid(GRID_3D, 3, case.has_hole)
    outcome = graded_to(mesh, case.metric(mesh.points), law, complexity)
    error = ""
    if case.u is not None:
        error = f"{complexity ** (2 / 3) * model_error(mesh, outcome.metric, case.tensor):.3f}"
    return [f"{100 * outcome.added:.0f}", *spread(mesh, outcome.metric), "", error, "", ""]


def model_error(mesh: Mesh, M: Floats, tensor: Function) -> float:
    """Return the L2 norm of ``trace(M^-1/2 |H| M^-1/2)``, by the values at the points."""
    local = np.trace(np.linalg.solve(M, tensor(mesh.points)), axis1=1, axis2=2)
    corners = mesh.points[mesh.cells]
    volumes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / math.factorial(mesh.dim)
    return math.sqrt(float((volumes[:, None] * local[mesh.cells] ** 2).sum()) / (mesh.dim + 1))


def spread(mesh: Mesh, M: Floats) -> list[str]:
    """Return the median and the 99th percentile of ln gamma over a unit edge."""
    return [f"{value:.2f}" for value in np.percentile(metric.distortion(mesh, M), [50, 99])]


def time_a_million() -> None:
    """Print time and memory of the gradation of a metric on a million vertices in 3D."""
    mesh = grid(10**6, 3, False)
    M = CASES[-1].metric(mesh.points)
    M *= (60_000 / metric.complexity(mesh, M)) ** (2 / 3)
    console = Console(width=120)
    for name, law in LAWS.items():
        started = time.process_time()
        graph = wide_graph(mesh)
        prepared = time.process_time()
        done = grade_on(graph, mesh.points, M, law)
        ended = time.process_time()
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
        console.print(
            f"{name}: {mesh.n_points} vertices, graph {prepared - started:.1f} s, gradation "
            f"{ended - prepared:.1f} s, {done.updates} raises, peak {peak:.1f} GB"
        )


def main() -> None:
    """Run the cases and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--dim", type=int, choices=[2, 3], default=2)
    parser.add_argument("--complexity", type=float)
    parser.add_argument("--case", choices=sorted({case.name for case in CASES}))
    parser.add_argument("--million", action="store_true", help="time a million vertices in 3D")
    arguments = parser.parse_args()
    if arguments.million:
        time_a_million()
        return
    complexity = arguments.complexity or {2: 1600.0, 3: 1000.0}[arguments.dim]
    columns = "case,law,added %,p50,p99,vertices,vertices x error,stars %,unit %"
    table = Table(*columns.split(","), title=f"{arguments.dim}D, complexity {complexity:g}")
    for case in CASES:
        if case.dim == arguments.dim and arguments.case in (None, case.name):
            for name, law in LAWS.items():
                row = (adapted if case.dim == 2 else on_a_grid)(case, law, complexity)
                table.add_row(case.name, name, *row)
    Console(width=130).print(table)


if __name__ == "__main__":
    main()
