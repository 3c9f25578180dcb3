"""Compare anistar with what others do and have published, and write the tables of the page.

usage: PYTHONPATH=tests/benchmarks python tests/benchmarks/compared/write_tables.py docs/tables

Takes a few minutes on one core. Without mmgpy (`make compare` installs it) its rows are missing.
"""

from __future__ import annotations

import argparse
import itertools
import logging
import math
from collections.abc import Iterable, Sequence
from pathlib import Path

import bubble_shear
import given_metrics
import mitchell_problems
import numpy as np
import published
import run_cases
from mitchell_problems import Problem, Row

COMPLEXITIES = (250, 500, 500, 1000, 1000, 2000, 2000, 2000)
MOST = 5000  # vertices that the competitors of the loop are refined to
PASSES = {"anistar": 8, "Mmg": 4}
TITLES = {"anistar": "anistar", "mmgpy": "Mmg"}
IN_THE_PLANE = 4000.0  # complexity
Rows = Iterable[Sequence[str]]


def table(head: Sequence[str], rows: Rows) -> str:
    """Return a table in Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def metrics_table(passes: dict[str, int]) -> str:
    """Return the table of meshes for given metrics, beside the published ones."""
    head = ("case", "tool", "vertices", "unit edges, %", "longest edge", "worst quality", "CPU, s")
    rows = []
    for case in given_metrics.CASES:
        ours = [given_metrics.run(case, tool, passes[tool]) for tool in given_metrics.TOOLS]
        made = [[f"**{done.tool}**", *mesh_cells(done), f"{done.seconds:.1f}"] for done in ours]
        made += [[row.tool, *mesh_cells(row), ""] for row in published.UGAWG[case.name]]
        names = [case.name] + [""] * (len(made) - 1)
        rows += [[name, *cells] for name, cells in zip(names, made, strict=True)]
    return table(head, rows)


def mesh_cells(mesh: given_metrics.Result | published.MeshFigures) -> list[str]:
    """Return what the table says of a mesh."""
    return [
        str(mesh.points),
        f"{mesh.unit_edges:.1f}",
        f"{mesh.longest_edge:.2f}",
        f"{mesh.worst_quality:.2g}",
    ]


def plane_table(complexity: float, passes: int) -> str:
    """Return the table of meshes of a square, each the best one for a function in L2."""
    head = ("case", "tool", "vertices", "unit edges, %", "longest edge", "worst quality")
    rows = []
    for case in run_cases.CASES:
        for tool in run_cases.TOOLS:
            name, _, *figures, error, _, seconds, _, _ = run_cases.run(
                case, tool, complexity, passes
            )
            shown = name if tool == "anistar" else ""
            rows.append([shown, f"**{TITLES[tool]}**", *figures, error, seconds])
    return table((*head, "complexity x L2 error", "CPU, s"), rows)


def at(points: float, rows: list[Row], column: int) -> float:
    """Return an error at a number of vertices, by a power law between two meshes."""
    known = np.log([[row[0], row[column]] for row in rows])
    return float(np.exp(np.interp(np.log(points), known[:, 0], known[:, 1])))


def problem_rows(
    problem: Problem, complexities: tuple[float, ...], most: int
) -> Iterable[Sequence[str]]:
    """Yield the rows of a problem: both norms at the size of the last two meshes of the loop."""
    ours = mitchell_problems.adapted(problem, complexities)[-2:]
    others = [
        mitchell_problems.refined(problem, most),
        mitchell_problems.refined(problem, most, uniformly=True),
    ]
    points = math.sqrt(ours[0][0] * ours[1][0])
    for column, norm in ((1, "L2"), (2, "energy")):
        error = math.sqrt(ours[0][column] * ours[1][column])
        refined, uniform = (at(points, rows, column) for rows in others)
        errors = [f"{value:.1e}" for value in (error, refined, uniform)]
        gains = [f"{refined / error:.2f}", f"{uniform / error:.1f}"]
        name = problem.name if norm == "L2" else ""
        yield [name, norm, f"{points:.0f}", *errors, *gains]


def problems_table(complexities: tuple[float, ...], most: int) -> str:
    """Return the table of elliptic problems."""
    head = (
        "problem", "norm", "vertices", "anistar", "refined triangles", "uniform",
        "gain over refined", "over uniform",
    )  # fmt: skip
    made = [make() for make in mitchell_problems.PROBLEMS]
    rows = (problem_rows(problem, complexities, most) for problem in made)
    return table(head, itertools.chain.from_iterable(rows))


def bubble_table(windows: Sequence[int]) -> str:
    """Return the table of the bubble in a shear flow."""
    rows = [[name, str(points), f"{error:.1f}"] for name, points, error in published.BUBBLE_SHEAR]
    for number in windows:
        points, error = bubble_shear.run(number)
        name = f"**anistar, `unsteady_loop`, {number} windows**"
        rows.append([name, f"{points:.0f}", f"{100 * error:.1f}"])
    return table(("run", "vertices, mean", "relative error in L2, %"), rows)


def main() -> None:
    """Write the tables."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    logging.disable()  # a start mesh cannot resolve these layers, as every first pass would say
    (folder / "compared-plane.txt").write_text(plane_table(IN_THE_PLANE, 4))
    (folder / "compared-metrics.txt").write_text(metrics_table(PASSES))
    (folder / "compared-problems.txt").write_text(problems_table(COMPLEXITIES, MOST))
    (folder / "compared-bubble.txt").write_text(bubble_table((5, 15)))


if __name__ == "__main__":
    main()
