"""``anistar remesh``."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...base.errors import FormatError
from ...formats import METRIC, read_metric, write, write_metric
from ...formats.suffixes import SOLUTION_OF, solution_beside, suffix_of
from ...loops.forecast import forecast
from ...meshes.fields import Field
from ...metric import estimate
from ...remeshing.remesh import remesh
from ...transfer import transfer
from .. import console
from ..before_after import MeshBefore, show_before_and_after
from ..certificate_files import arrays_for
from ..files import metric_target, replaced_inputs, writable
from ..inputs import read_input
from ..options import adapt_options, add_remesh_options

SUMMARY = "remesh to a given metric, and carry the fields over"
EXAMPLE = "anistar remesh in.mesh --metric metric.sol -o out.mesh"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("input", help="mesh, with fields or without")
    parser.add_argument("-o", "--output", required=True, help="new mesh")
    parser.add_argument(
        "--metric",
        metavar="FILE",
        help="tensors, or sizes, at the points; for in.mesh the default is in.sol",
    )
    parser.add_argument(
        "--metric-output",
        metavar="FILE",
        help="metric at the new points; for out.mesh without fields it goes to out.sol anyway",
    )
    parser.add_argument(
        "--geometry",
        metavar="FILE",
        help="mesh whose boundary is the geometry; default: the input, with its curved edges",
    )
    add_remesh_options(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    output = writable(arguments.output)
    metric_output = metric_target(arguments.metric_output, output)
    options = adapt_options(arguments)
    beside = solution_beside(Path(arguments.input))
    source = Path(arguments.metric) if arguments.metric else beside
    if source is None:
        raise FormatError(f"no metric: give --metric, there is no .sol beside {arguments.input}")
    given = read_input(arguments.input, arguments.geometry, beside_json=arguments.json)
    mesh = given.mesh
    M = read_metric(source, mesh)
    if not arguments.quiet:
        expected = forecast(estimate(mesh, M), mesh.dim, options.remesh)
        console.say_forecast(expected, beside_json=arguments.json)
    done = remesh(mesh, M, options.remesh, geometry=given.geometry)
    done = done.after_reading(given.remarks)
    # The solution beside a medit mesh is the metric itself, not a field to carry.
    carried = {} if source == beside else given.fields
    fields = transfer(mesh, carried, done.mesh, options.transfer).fields
    if metric_output is None and not fields and suffix_of(output) in SOLUTION_OF:
        fields = {METRIC: Field(done.metric)}
    inputs = (arguments.input, str(source), arguments.geometry)
    replaced = replaced_inputs(inputs, output, metric_output)
    write(output, done.mesh, fields | arrays_for(output, done.mesh, done.metric))
    if metric_output is not None:
        write_metric(metric_output, done.mesh, done.metric)
    console.say_replaced(replaced, "the new mesh", beside_json=arguments.json)
    if arguments.json:
        console.show_json(done.report)
    else:
        before = MeshBefore.of(arguments.input, mesh, M, {})
        title = f"remeshed in {sum(done.report.seconds.values()):.2f} s"
        report = done.report
        show_before_and_after(title, before, arguments.output, report, {}, report.star_ok)
        console.say_stop_and_verdict(report, report.verdict)
    return 0
