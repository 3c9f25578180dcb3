"""``anistar check``."""

from __future__ import annotations

import argparse

from ..formats import read, read_metric, read_with_report
from ..quality import quality
from ..validation import validate
from . import console

SUMMARY = "check a mesh, and measure it in a metric"
EXAMPLE = "anistar check out.mesh --metric out.sol --reference in.mesh"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("input", help="mesh")
    parser.add_argument("--metric", metavar="FILE", help="metric at the points")
    parser.add_argument(
        "--reference", metavar="FILE", help="mesh with the same domain, tags and names"
    )
    parser.add_argument(
        "--tolerance",
        type=float,
        default=1e-10,
        help="allowed relative difference of measures from the reference (default 1e-10)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Run the command; 1 if the mesh breaks a rule."""
    mesh, _, found = read_with_report(arguments.input)
    M = read_metric(arguments.metric, mesh) if arguments.metric else None
    reference = read(arguments.reference)[0] if arguments.reference else None
    problems = validate(mesh, reference, tolerance=arguments.tolerance)
    figures = quality(mesh, M).as_dict()
    if arguments.json:
        messages = [problem.message for problem in problems]
        said = {"valid": not problems, "problems": messages, "read": found}
        console.show_json({**said, **figures})
    else:
        rows = [[name, value] for name, value in figures.items() if value is not None]
        console.show_table(arguments.input, ["", ""], rows)
        for problem in problems:
            console.say(f"{problem.kind}: {problem.message}")
        console.say("not valid" if problems else "valid")
    return 1 if problems else 0
