"""``anistar loop``."""

from __future__ import annotations

import argparse
from pathlib import Path

from ..file_solver import FILE_KINDS, FileSolver
from ..formats import read
from ..loop import Loop, LoopError, LoopOptions, Step, adapt_loop
from ..report import write_json
from ..series import write_series
from . import console
from .options import adapt_options, add_metric_options, add_remesh_options, numbers

SUMMARY = "solve and adapt in turn, with a solver that is a command"
EXAMPLE = (
    'anistar loop in.mesh --command "solver {mesh} {solution}" --complexities 1000,2000,4000 -o run'
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("input", help="first mesh")
    parser.add_argument(
        "--command",
        dest="solver",
        required=True,
        help="reads {mesh}, writes {solution} (.mesh and .sol, or as --files says)",
    )
    parser.add_argument("-o", "--output", required=True, help="folder for all files")
    parser.add_argument(
        "--complexities", type=numbers, metavar="C,C,...", help="target of each turn"
    )
    parser.add_argument(
        "--target-error",
        dest="stop_at_error",
        type=float,
        metavar="X",
        help="stop at this L2 error",
    )
    parser.add_argument("--max-iterations", type=int, default=20, metavar="N")
    parser.add_argument("--field", action="append", metavar="NAME", help="field for the metric")
    parser.add_argument("--files", choices=tuple(FILE_KINDS), default="mesh")
    add_metric_options(parser, without=("target_error",))
    add_remesh_options(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    options = LoopOptions(
        adapt=adapt_options(arguments, metric_fields=arguments.field),
        complexities=arguments.complexities,
        target_error=arguments.stop_at_error,
        max_iterations=arguments.max_iterations,
    )
    mesh, _ = read(arguments.input)
    folder = Path(arguments.output)
    folder.mkdir(parents=True, exist_ok=True)
    solve = FileSolver(arguments.solver, folder, arguments.files)
    steps: list[Step] = []
    total = len(options.complexities) + 1 if options.complexities else None
    with console.progress_bar(total, is_quiet=arguments.json) as advance:

        def moved(step: Step) -> None:
            steps.append(step)
            advance(f"{step.mesh.n_points} points")

        try:
            loop = adapt_loop(solve, mesh, options, callback=moved)
        except LoopError as error:
            _write(folder, error.loop)
            raise
        except KeyboardInterrupt:
            _write(folder, Loop(tuple(steps), "interrupted"))
            raise
    _write(folder, loop)
    if arguments.json:
        console.show_json(loop)
    else:
        _show(loop)
    return 0


def _write(folder: Path, loop: Loop) -> None:
    write_series(folder / "series.pvd", ((step.mesh, step.fields) for step in loop.steps))
    write_json(folder / "report.json", loop)


def _show(loop: Loop) -> None:
    rows = [
        [step.iteration, step.complexity, step.mesh.n_points, max(step.error.values())]
        for step in loop.steps
    ]
    columns = ["iteration", "complexity", "points", "estimated L2 error"]
    console.show_table(loop.stop_reason, columns, rows)
