"""``anistar loop``."""

from __future__ import annotations

import argparse
from contextlib import suppress
from typing import Any

from ...base.errors import FormatError
from ...base.report import as_builtin
from ...judging.certificate import rounded_down
from ...loops.forecast import forecast_of_targets
from ...loops.loop import Loop, LoopError, Step, adapt_loop
from ...loops.loop_options import LoopOptions
from ...meshes.mesh import Mesh
from ...remeshing.demand import check_targets
from ...runs.file_solver import FILE_KINDS, FileSolver
from ...runs.folder import RunFolder
from .. import console
from ..inputs import read_input
from ..options import (
    adapt_options,
    add_metric_options,
    add_remesh_options,
    add_transfer_method_option,
    numbers,
)
from ..settling import add_settling_options, settling_options

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
        help="reads {mesh}, writes {solution} (.mesh and .sol, or as --format says)",
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
    parser.add_argument("--format", "--files", choices=tuple(FILE_KINDS), default="mesh")
    earlier = parser.add_mutually_exclusive_group()
    earlier.add_argument(
        "--resume",
        action="store_true",
        help="go on after the steps that the folder holds, as after a crash",
    )
    earlier.add_argument(
        "--force", action="store_true", help="replace the run that the folder holds"
    )
    add_metric_options(parser, without=("target_error", "max_coarsening"))
    add_settling_options(parser, is_loop=True)
    add_remesh_options(parser)
    add_transfer_method_option(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    options = LoopOptions(
        adapt=adapt_options(arguments, metric_fields=arguments.field),
        complexities=arguments.complexities,
        target_error=arguments.stop_at_error,
        max_iterations=arguments.max_iterations,
        **settling_options(arguments),
    )
    given = read_input(arguments.input, beside_json=arguments.json)
    mesh = given.mesh
    folder = RunFolder(arguments.output, _settings(arguments, options))
    solve = FileSolver(arguments.solver, folder.folder, arguments.format)
    # Here as well, so that no earlier run is removed for one that is refused.
    check_targets(
        mesh, options.adapt.metric, options.sure_complexities(mesh.dim), options.adapt.remesh
    )
    solve.require_command()
    with folder.locked():
        finished = folder.load() if arguments.resume else _begun(arguments, folder)
        _foretell(options, mesh.dim, arguments)
        solve.count = len(finished)
        first = finished[0].mesh if finished else mesh
        loop = _looped(solve, first, options, given.geometry, folder=folder)
    if arguments.json:
        console.show_json(loop)
    else:
        _show(loop)
    return 0


def _begun(arguments: argparse.Namespace, folder: RunFolder) -> list[Step]:
    """Make room for a new run, which has no finished step."""
    removed = folder.begin(force=arguments.force, keep=[arguments.input])
    console.say_removed(removed, folder.folder, beside_json=arguments.json)
    return []


def _foretell(options: LoopOptions, dim: int, arguments: argparse.Namespace) -> None:
    """Tell what the meshes that are sure to be made will take."""
    targets = options.sure_complexities(dim)
    if targets and not arguments.quiet:
        expected = forecast_of_targets(targets, dim, options.adapt.remesh)
        of = "largest mesh, and time of all"
        console.say_forecast(expected, beside_json=arguments.json, of=of)


def _looped(
    solve: FileSolver,
    first: Mesh,
    options: LoopOptions,
    geometry: Mesh | None,
    *,
    folder: RunFolder,
) -> Loop:
    """Run the loop after the steps that the folder holds, and save every further one."""
    finished = list(folder.steps)

    try:
        loop = adapt_loop(
            solve, first, options, geometry=geometry, callback=folder.save, finished=finished
        )
    except LoopError as error:
        with suppress(FormatError):  # the disk that is full, say, is in the first error
            folder.close(error.loop)
        raise
    except KeyboardInterrupt:
        folder.close(Loop(tuple(folder.steps), "interrupted"))
        raise
    folder.close(loop)
    return loop


def _settings(arguments: argparse.Namespace, options: LoopOptions) -> dict[str, Any]:
    """Return what every step depends on; the targets still to come may change on the way."""
    adapt = as_builtin(options.adapt)
    return {
        "command": arguments.solver,
        "format": arguments.format,
        "options": adapt,
        "max_coarsening": options.max_coarsening,
    }


def _show(loop: Loop) -> None:
    rows = [
        [
            *(step.iteration, step.complexity, step.mesh.n_points, max(step.error.values())),
            _stars(step),
        ]
        for step in loop.steps
    ]
    columns = ["iteration", "complexity", "points", "estimated L2 error", "star_ok"]
    console.show_table(loop.stop_reason, columns, rows)
    verdict = _said(loop.steps[-1]).get("verdict")
    if verdict is not None:
        console.say(f"last mesh {verdict}")


def _stars(step: Step) -> float | None:
    share = _said(step).get("star_ok")
    return None if share is None else rounded_down(share)


def _said(step: Step) -> dict[str, Any]:
    """Return what was reported about the mesh of a step, nothing about the first."""
    return {} if step.report is None else step.report.as_dict()
