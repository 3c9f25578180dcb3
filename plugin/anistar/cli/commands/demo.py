"""``anistar demo``."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from pathlib import Path

from ...base.progress import task
from ...demo.result import DEMO_FILES, Demo
from ...runs.lock import locked
from ...runs.own_files import OwnFiles
from .. import console
from ..options import numbers

SUMMARY = "adapt the flow of heat through a channel, and compare with uniform meshes"
EXAMPLE = "anistar demo -o anistar-demo"

FOLDERS = {2: "anistar-demo", 3: "anistar-demo-3d"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        "-o", "--output", help=f"folder for all files (default: {FOLDERS[2]}, in 3D {FOLDERS[3]})"
    )
    parser.add_argument(
        "--force", action="store_true", help="replace what an earlier demo left in the folder"
    )
    parser.add_argument(
        "--dim", type=int, choices=(2, 3), default=2, help="3: a spherical front in a cube"
    )
    parser.add_argument("--complexities", type=numbers, metavar="C,C,...", help="growing targets")


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    run_demo, stages, standard = _demo(arguments.dim)
    complexities = arguments.complexities or standard
    folder = Path(arguments.output or FOLDERS[arguments.dim])
    folder.mkdir(parents=True, exist_ok=True)
    with locked(folder):
        _make_room(folder, arguments)
        with task("demo", total=stages(complexities)) as line:
            demo = run_demo(folder, complexities=complexities, progress=line.advance)
    if arguments.json:
        console.show_json(demo)
        return 0
    columns = ["complexity", "adapted N", "L2 error", "uniform N", "L2 error", "gain"]
    rows = [
        [
            f"{row.complexity:g}",
            row.adapted_points,
            row.adapted_error,
            row.uniform_points,
            row.uniform_error,
            row.gain,
        ]
        for row in demo.rows
    ]
    against = "the reference solution" if arguments.dim == 2 else "the exact front"
    console.show_table(f"Errors against {against}", columns, rows)
    console.say(
        f"Observed order: {demo.adapted_order:.2f} adapted, {demo.uniform_order:.2f} uniform. "
        f"Series, pictures and report in {folder} after {demo.seconds:.0f} s."
    )
    return 0


def _demo(dim: int) -> tuple[Callable[..., Demo], Callable[..., int], Sequence[float]]:
    """Return how to run the demo, how many stages it has, and its usual targets."""
    if dim == 3:
        from ...demo.volume import COMPLEXITIES, run_volume_demo, stages

        return run_volume_demo, stages, COMPLEXITIES
    # Needs the extras skfem and plot, which no other command does.
    from ...demo import plane as demo

    return demo.run_demo, demo.stages, demo.COMPLEXITIES


def _make_room(folder: Path, arguments: argparse.Namespace) -> None:
    own = OwnFiles(folder, DEMO_FILES)
    own.remove_leftovers()
    if not arguments.force:
        own.require_none("--force replaces it")
    console.say_removed(own.remove(), folder, beside_json=arguments.json)
