"""``anistar transfer``."""

from __future__ import annotations

import argparse

from ..formats import read, write
from ..transfer import METHODS, TransferOptions, TransferReport, transfer
from . import console
from .files import writable
from .options import add_outside_option

SUMMARY = "carry the fields of one mesh to another"
EXAMPLE = "anistar transfer old.vtu new.vtu -o out.vtu --method conservative"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("source", help="mesh with fields; in.mesh picks up in.sol")
    parser.add_argument("target", help="mesh that gets the fields")
    parser.add_argument("-o", "--output", required=True, help="target mesh with the fields")
    parser.add_argument(
        "--method", default=METHODS[0], help=f"one of {', '.join(METHODS)} (default {METHODS[0]})"
    )
    parser.add_argument(
        "--threads", type=int, default=1, help="for the intersection of the meshes (default 1)"
    )
    parser.add_argument("--log-euclidean", action="store_true", help="carry logarithms of tensors")
    add_outside_option(parser, "raise")


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    output = writable(arguments.output, is_mesh=False)
    options = TransferOptions(
        method=arguments.method,
        outside=arguments.outside,
        log_euclidean=arguments.log_euclidean,
        threads=arguments.threads,
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
    console.show_table(_title(done.report), ["field", "integral before", "integral after"], rows)
    return 0


def _title(report: TransferReport) -> str:
    coverage = report.coverage
    if coverage is None:
        return f"{report.points_outside} points outside, by {report.max_distance:.3g} at most"
    return (
        f"{coverage.cells} cells not covered, {100 * coverage.volume:.3g} % of the volume, "
        f"by {coverage.max_distance:.3g} at most"
    )
