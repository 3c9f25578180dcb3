"""``anistar transfer``."""

from __future__ import annotations

import argparse

from ..formats import read, write
from ..transfer import TransferOptions, transfer
from . import console
from .files import writable
from .options import add_outside_option

SUMMARY = "carry the fields of one mesh to another"
EXAMPLE = "anistar transfer old.vtu new.vtu -o out.vtu --outside nearest"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("source", help="mesh with fields; in.mesh picks up in.sol")
    parser.add_argument("target", help="mesh that gets the fields")
    parser.add_argument("-o", "--output", required=True, help="target mesh with the fields")
    parser.add_argument("--method", default="interpolate", help="interpolate (default)")
    parser.add_argument(
        "--log-euclidean", action="store_true", help="interpolate logarithms of tensors"
    )
    add_outside_option(parser, "raise")


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    output = writable(arguments.output, is_mesh=False)
    options = TransferOptions(
        method=arguments.method,
        outside=arguments.outside,
        log_euclidean=arguments.log_euclidean,
    )
    source, fields = read(arguments.source)
    target, _ = read(arguments.target)
    done = transfer(source, fields, target, options)
    write(output, target, done.fields)
    if arguments.json:
        console.show_json(done.report)
        return 0
    rows = [
        [name if len(change.integral[0]) == 1 else f"{name}[{index}]", before, after]
        for name, change in done.report.changes.items()
        for index, (before, after) in enumerate(zip(*change.integral, strict=True))
    ]
    title = (
        f"{done.report.points_outside} points outside, by {done.report.max_distance:.3g} at most"
    )
    console.show_table(title, ["field", "integral before", "integral after"], rows)
    return 0
