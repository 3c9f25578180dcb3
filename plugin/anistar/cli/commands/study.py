"""``anistar study``."""

from __future__ import annotations

import argparse
import importlib
import tempfile
from typing import Any

from ...loops.loop import Solve
from ...loops.study import BASELINES, Study, convergence_study
from ...meshes.mesh import Mesh
from ...runs.file_solver import FileSolver
from .. import console
from ..expression import function_of_position
from ..files import new_file
from ..inputs import read_input
from ..options import (
    adapt_options,
    add_metric_options,
    add_remesh_options,
    add_transfer_method_option,
    numbers,
)
from ..settling import add_settling_options, settling_options

SUMMARY = "measure how the error falls on adapted meshes"
EXAMPLE = (
    'anistar study in.vtu --exact "tanh(20 * (x**2 + y**2 - 0.5))" --complexities 500,1000,2000'
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("input", help="first mesh")
    parser.add_argument("--exact", required=True, metavar="EXPR", help="exact solution in x, y, z")
    parser.add_argument("--complexities", type=numbers, required=True, metavar="C,C,...")
    parser.add_argument("--repeats", type=int, default=2, help="adaptations at each complexity")
    parser.add_argument(
        "--command",
        dest="solver",
        help="solver that reads {mesh} and writes {solution}; without it the exact solution is "
        "interpolated",
    )
    parser.add_argument(
        "--baselines",
        type=lambda text: text.split(","),
        default=[],
        metavar="KIND,KIND",
        help=f"compare with other meshes: {', '.join(BASELINES)}",
    )
    parser.add_argument("--csv", metavar="FILE", help="write the table")
    parser.add_argument("--picture", metavar="FILE", help="draw the error against the points")
    parser.add_argument("--force", action="store_true", help="replace these files if they exist")
    add_metric_options(parser, without=("max_coarsening",))
    add_settling_options(parser, is_loop=False)
    add_remesh_options(parser)
    add_transfer_method_option(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    if arguments.picture:
        importlib.import_module("anistar.pictures")  # without matplotlib the work ends here
    for path in filter(None, (arguments.csv, arguments.picture)):
        new_file(path, force=arguments.force, keep=[arguments.input])
    exact = function_of_position(arguments.exact)
    given = read_input(arguments.input, beside_json=arguments.json)

    def interpolated(mesh: Mesh, fields: dict[str, Any]) -> dict[str, Any]:
        return {"u": exact(mesh.points)}

    with tempfile.TemporaryDirectory() as folder:
        solve: Solve = interpolated
        if arguments.solver:
            solve = FileSolver(arguments.solver, folder)
        study = convergence_study(
            solve,
            given.mesh,
            arguments.complexities,
            exact=exact,
            geometry=given.geometry,
            repeats=arguments.repeats,
            **settling_options(arguments),
            options=adapt_options(arguments),
            baselines=arguments.baselines,
        )
    if arguments.csv:
        study.write_csv(arguments.csv)
    if arguments.picture:
        study.write_picture(arguments.picture)
    if arguments.json:
        console.show_json(study)
    else:
        _show(study)
    return 0


def _show(study: Study) -> None:
    tables = {**study.baselines, "adapted": study.table}
    rows = [
        [kind, r.complexity, r.points, r.cells, r.error, r.order]
        for kind, table in tables.items()
        for r in table
    ]
    columns = ["meshes", "complexity", "points", "cells", "L2 error", "order"]
    console.show_table(f"order {study.order:.2f}", columns, rows)
