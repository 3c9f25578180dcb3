"""``anistar demo``."""

from __future__ import annotations

import argparse

from . import console
from .options import numbers

SUMMARY = "adapt the flow of heat through a channel, and compare with uniform meshes"
EXAMPLE = "anistar demo -o anistar-demo"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("-o", "--output", default="anistar-demo", help="folder for all files")
    parser.add_argument("--complexities", type=numbers, metavar="C,C,...", help="growing targets")


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    # Needs the extras skfem and plot, which no other command does.
    from ..demo import COMPLEXITIES, run_demo, stages

    complexities = arguments.complexities or COMPLEXITIES
    with console.progress_bar(stages(complexities), is_quiet=arguments.json) as advance:
        demo = run_demo(arguments.output, complexities=complexities, progress=advance)
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
    console.show_table("Errors against the reference solution", columns, rows)
    console.say(
        f"Observed order: {demo.adapted_order:.2f} adapted, {demo.uniform_order:.2f} uniform. "
        f"Pictures, series and report in {arguments.output} after {demo.seconds:.0f} s."
    )
    return 0
