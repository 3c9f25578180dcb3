"""``anistar adapt``."""

from __future__ import annotations

import argparse

from ...formats import write, write_metric
from ...loops.adapt import Adapted, adapt_to
from ...loops.element_counts import Wanted
from ...loops.forecast import Forecast
from .. import console
from ..before_after import MeshBefore, errors_of, show_before_and_after
from ..certificate_files import arrays_for
from ..files import metric_target, replaced_inputs, writable
from ..inputs import read_input
from ..options import (
    adapt_options,
    add_metric_options,
    add_outside_option,
    add_remesh_options,
    add_transfer_method_option,
)

SUMMARY = "adapt a mesh to the fields in its file, and carry the fields over"
EXAMPLE = "anistar adapt in.vtu --field u --target-complexity 10000 -o out.vtu"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("input", help="mesh with fields; in.mesh picks up in.sol")
    parser.add_argument("-o", "--output", required=True, help="adapted mesh with the fields")
    parser.add_argument(
        "--field",
        action="append",
        metavar="NAME",
        help="field that makes the metric; may be repeated; all scalars and vectors by default",
    )
    parser.add_argument(
        "--geometry",
        metavar="FILE",
        help="mesh whose boundary is the geometry; default: the input, with its curved edges",
    )
    parser.add_argument("--metric-output", metavar="FILE", help="also write the metric")
    add_metric_options(parser)
    add_remesh_options(parser)
    add_transfer_method_option(parser)
    add_outside_option(parser, "nearest")


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    output = writable(arguments.output)
    metric_output = metric_target(arguments.metric_output, output)
    options = adapt_options(arguments, metric_fields=arguments.field)
    given = read_input(arguments.input, arguments.geometry, beside_json=arguments.json)
    before: list[MeshBefore] = []

    def foretold(wanted: Wanted, expected: Forecast) -> None:
        if not arguments.quiet:
            console.say_forecast(expected, beside_json=arguments.json)
        if not arguments.json:
            names = tuple(wanted.ledger.predicted_error)
            measured = MeshBefore.of(
                arguments.input, given.mesh, wanted.metric, given.fields, names
            )
            before.append(measured)

    done = adapt_to(given.mesh, given.fields, options, geometry=given.geometry, foretell=foretold)
    done = done.after_reading(given.remarks)
    inputs = (arguments.input, arguments.geometry)
    replaced = replaced_inputs(inputs, output, metric_output)
    write(output, done.mesh, done.fields | arrays_for(output, done.mesh, done.metric))
    if metric_output is not None:
        write_metric(metric_output, done.mesh, done.metric)
    console.say_replaced(replaced, "the adapted mesh", beside_json=arguments.json)
    if arguments.json:
        console.show_json(done.report)
    else:
        _show(before[0], arguments.output, done)
    return 0


def _show(before: MeshBefore, target: str, done: Adapted) -> None:
    report = done.report
    errors = errors_of(done.mesh, done.fields, report.metric_fields)
    title = f"adapted in {report.seconds:.2f} s"
    show_before_and_after(title, before, target, report.remesh, errors, report.star_ok)
    console.say_stop_and_verdict(report.remesh, report.verdict)
