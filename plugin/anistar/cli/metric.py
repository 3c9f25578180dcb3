"""``anistar metric``."""

from __future__ import annotations

import argparse

from ..adapt import metric_field_names
from ..formats import read, write_metric
from ..metric import from_fields
from . import console
from .files import writable
from .options import adapt_options, add_metric_options

SUMMARY = "make a metric of fields and write it, without remeshing"
EXAMPLE = "anistar metric in.vtu --field u --target-complexity 10000 -o metric.sol"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("input", help="mesh with fields; in.mesh picks up in.sol")
    parser.add_argument("-o", "--output", required=True, help="metric, a .sol or a mesh file")
    parser.add_argument(
        "--field", action="append", metavar="NAME", help="field that makes the metric"
    )
    add_metric_options(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    output = writable(arguments.output, is_mesh=False)
    options = adapt_options(arguments, metric_fields=arguments.field)
    mesh, fields = read(arguments.input)
    names = metric_field_names(fields, options.metric_fields)
    M, ledger = from_fields(mesh, {name: fields[name] for name in names}, options.metric)
    write_metric(output, mesh, M)
    if arguments.json:
        console.show_json(ledger)
        return 0
    rows = [[stage.name, stage.complexity, stage.remark] for stage in ledger.stages]
    console.show_table(f"complexity {ledger.complexity:.1f}", ["stage", "complexity", ""], rows)
    return 0
