"""``anistar demo``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from . import console
from .options import numbers

if TYPE_CHECKING:
    from ..demo_result import Demo

SUMMARY = "adapt the flow of heat through a channel, and compare with uniform meshes"
EXAMPLE = "anistar demo -o anistar-demo"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("-o", "--output", default="anistar-demo", help="folder for all files")
    parser.add_argument(
        "--dim", type=int, choices=(2, 3), default=2, help="3: a spherical front in a cube"
    )
    parser.add_argument("--complexities", type=numbers, metavar="C,C,...", help="growing targets")


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    demo = _volume_demo(arguments) if arguments.dim == 3 else _plane_demo(arguments)
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
        f"Series and report in {arguments.output} after {demo.seconds:.0f} s."
    )
    return 0


def _plane_demo(arguments: argparse.Namespace) -> Demo:
    # Needs the extras skfem and plot, which no other command does.
    from ..demo import COMPLEXITIES, run_demo, stages

    complexities = arguments.complexities or COMPLEXITIES
    with console.progress_bar(stages(complexities), is_quiet=arguments.json) as advance:
        return run_demo(arguments.output, complexities=complexities, progress=advance)


def _volume_demo(arguments: argparse.Namespace) -> Demo:
    from ..demo_volume import COMPLEXITIES, run_volume_demo, stages

    complexities = arguments.complexities or COMPLEXITIES
    with console.progress_bar(stages(complexities), is_quiet=arguments.json) as advance:
        return run_volume_demo(arguments.output, complexities=complexities, progress=advance)
