"""Time anistar, and mmgpy where it is installed, on metrics of our own.

usage: python tests/benchmarks/run_cases.py [--complexity 16000] [--passes 4] [--case NAME]

Each tool starts from the same uniform mesh; before every pass the metric is evaluated at the
vertices of the current mesh. The figures are those of the last mesh, measured in the metric
evaluated at its vertices; the time is CPU time of the last pass, and of all passes.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from anistar.judging.interpolation_error import l2_error, simplex_rule
from anistar.judging.quality import quality
from anistar.meshes.mesh import Mesh
from anistar.meshes.topology import cell_volumes
from anistar.meshes.validation import validate
from anistar.metric import absolute
from anistar.remeshing.remesh import remesh

try:
    import mmgpy
except ImportError:
    mmgpy = None

Floats = NDArray[np.float64]
Function = Callable[[Floats], Floats]

# Step of the central differences that give the Hessian of a case: about eps**(1/4).
STEP = 1e-4


@dataclass(frozen=True)
class Case:
    """A function on the unit square; the metric is the best one for it in L2."""

    name: str
    u: Function

    def hessian(self, x: Floats) -> Floats:
        """Return the (n, 2, 2) Hessian by central differences."""
        H = np.empty((len(x), 2, 2))
        e = STEP * np.eye(2)
        for i in range(2):
            for j in range(i, 2):
                corners = [
                    self.u(x + s * e[i] + t * e[j]) * s * t for s in (1, -1) for t in (1, -1)
                ]
                H[:, i, j] = H[:, j, i] = sum(corners) / (4 * STEP**2)
        return H

    def metric(self, x: Floats, complexity: float, scale: float) -> Floats:
        """Return ``c det|H|^(-1/6) |H|`` at any points; `scale` makes its complexity one."""
        H = absolute(self.hessian(x), floor=1e-2)
        density = np.linalg.det(H) ** (-1 / 6)
        return complexity / scale * density[:, None, None] * H

    def scale(self, n: int = 150) -> float:
        """Return the complexity of ``det|H|^(-1/6) |H|``, by quadrature on a fine grid."""
        mesh = square(n)
        weights, barycentric = simplex_rule(2)
        volumes, corners = cell_volumes(mesh.points, mesh.cells), mesh.points[mesh.cells]
        total = 0.0
        for weight, b in zip(weights, barycentric, strict=True):
            H = absolute(self.hessian(np.einsum("k,ckd->cd", b, corners)), floor=1e-2)
            total += weight * float(volumes @ np.linalg.det(H) ** (1 / 3))
        return total


CASES = (
    Case("tanh arc", lambda x: np.tanh(60 * (np.hypot(x[:, 0], x[:, 1]) - 0.7))),
    Case("wave front", lambda x: np.arctan(80 * (np.hypot(x[:, 0] + 0.1, x[:, 1] + 0.1) - 0.8))),
    Case("two layers", lambda x: np.exp(-50 * x[:, 0]) + np.tanh(40 * (x[:, 1] - x[:, 0] ** 2))),
    Case("smooth", lambda x: np.sin(4 * x[:, 0]) * np.cos(7 * x[:, 1])),
)


def square(n: int) -> Mesh:
    """Return the unit square in 2 n^2 right triangles."""
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
    i, j = (index.ravel() for index in np.meshgrid(np.arange(n), np.arange(n)))
    a = j * (n + 1) + i
    cells = np.concatenate(
        [np.stack([a, a + 1, a + n + 2], 1), np.stack([a, a + n + 2, a + n + 1], 1)]
    )
    return Mesh(points=np.stack([x.ravel(), y.ravel()], axis=1), cells=cells)


def with_anistar(mesh: Mesh, M: Floats, geometry: Mesh) -> tuple[Mesh, float]:
    """Return the next mesh and the CPU seconds it took."""
    started = time.process_time()
    done = remesh(mesh, M, geometry=geometry)
    return done.mesh, time.process_time() - started


def with_mmgpy(mesh: Mesh, M: Floats, geometry: Mesh) -> tuple[Mesh, float]:
    """Return the next mesh and the CPU seconds it took; mmg's own gradation is off."""
    other = mmgpy.MmgMesh2D()
    other.set_mesh_size(vertices=mesh.n_points, triangles=mesh.n_cells, edges=mesh.n_facets)
    other.set_vertices(np.array(mesh.points), np.zeros(mesh.n_points, np.int64))
    other.set_triangles(np.array(mesh.cells), np.ones(mesh.n_cells, np.int64))
    other.set_edges(np.array(mesh.facets), mesh.facet_tags.astype(np.int64))
    other["tensor"] = np.stack([M[:, 0, 0], M[:, 0, 1], M[:, 1, 1]], axis=1)
    started = time.process_time()
    other.remesh(verbose=-1, hgrad=-1.0)
    seconds = time.process_time() - started
    return Mesh(points=other.get_vertices(), cells=other.get_triangles()), seconds


TOOLS = {"anistar": with_anistar} | ({"mmgpy": with_mmgpy} if mmgpy else {})


def run(case: Case, tool: str, complexity: float, passes: int) -> list[str]:
    """Return one row of the table."""
    scale = case.scale()
    first = mesh = square(max(20, round(math.sqrt(1.25 * complexity))))
    seconds = []
    for _ in range(passes):
        mesh, taken = TOOLS[tool](mesh, case.metric(mesh.points, complexity, scale), first)
        seconds.append(taken)
    figures = quality(mesh, case.metric(mesh.points, complexity, scale))
    problems = validate(mesh)
    error = l2_error(mesh, case.u(mesh.points), case.u)
    return [
        case.name,
        tool,
        str(mesh.n_points),
        f"{100 * figures.unit_edges:.2f}",
        f"{figures.longest_edge:.2f}",
        f"{figures.worst_quality:.3f}",
        f"{error * complexity:.3f}",
        f"{seconds[-1]:.2f}",
        f"{sum(seconds):.2f}",
        f"{mesh.n_points / seconds[-1] / 1000:.0f}",
        "yes" if not problems else problems[0].kind,
    ]


def main() -> None:
    """Run the cases and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--complexity", type=float, default=16000.0)
    parser.add_argument("--passes", type=int, default=4)
    parser.add_argument("--case", choices=[case.name for case in CASES])
    arguments = parser.parse_args()
    columns = "case,tool,points,unit %,longest,worst Q,C x L2 error,s last,s all,k points/s,valid"
    table = Table(*columns.split(","), title=f"complexity {arguments.complexity:g}")
    for case in CASES:
        if arguments.case in (None, case.name):
            for tool in TOOLS:
                table.add_row(*run(case, tool, arguments.complexity, arguments.passes))
    Console().print(table)
    if mmgpy is None:
        Console().print("mmgpy is not installed: make bench installs it")


if __name__ == "__main__":
    main()
