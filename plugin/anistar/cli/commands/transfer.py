"""``anistar transfer``."""

from __future__ import annotations

import argparse
from typing import Any

from ...formats import read, write
from ...transfer import METHODS, FieldChange, TransferOptions, TransferReport, transfer
from .. import console
from ..files import replaced_inputs, writable
from ..inputs import read_fields
from ..options import add_outside_option

SUMMARY = "carry the fields of one mesh to another"
COLUMNS = ("field", "", "integral", "min", "max", "L2 difference")
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
    parser.add_argument(
        "--l2-difference",
        action="store_true",
        help="measure the L2 norm of the change, which intersects the meshes; the projections do "
        "it anyway",
    )
    add_outside_option(parser, "raise")


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    output = writable(arguments.output, is_mesh=False)
    options = TransferOptions(
        method=arguments.method,
        outside=arguments.outside,
        log_euclidean=arguments.log_euclidean,
        threads=arguments.threads,
        l2_difference=arguments.l2_difference or None,
    )
    source, fields = read_fields(arguments.source)
    target, _ = read(arguments.target)
    done = transfer(source, fields, target, options)
    replaced = replaced_inputs((arguments.source, arguments.target), output)
    write(output, target, done.fields)
    console.say_replaced(replaced, "the fields carried over", beside_json=arguments.json)
    if arguments.json:
        console.show_json(done.report)
        return 0
    rows = [row for name, change in done.report.changes.items() for row in _rows(name, change)]
    console.show_table(_title(done.report), COLUMNS, rows)
    if done.report.unmatched_tags:
        listed = ", ".join(map(str, done.report.unmatched_tags))
        console.say(f"only one of the meshes has the region tags {listed}: regions were ignored")
    return 0


def _rows(name: str, change: FieldChange) -> list[list[Any]]:
    """Return two rows for each component of a field, before and after."""
    measured = (change.integral, change.minimum, change.maximum)
    count = len(change.integral[0])
    rows = []
    for k in range(count):
        before, after = ([pair[when][k] for pair in measured] for when in (0, 1))
        difference = change.l2_difference[k] if change.l2_difference else None
        rows.append([name if count == 1 else f"{name}[{k}]", "before", *before, None])
        rows.append(["", "after", *after, difference])
    return rows


def _title(report: TransferReport) -> str:
    coverage = report.coverage
    if coverage is None:
        return f"{report.points_outside} points outside, by {report.max_distance:.3g} at most"
    return (
        f"{coverage.cells} cells not covered, {100 * coverage.volume:.3g} % of the volume, "
        f"by {coverage.max_distance:.3g} at most"
    )
