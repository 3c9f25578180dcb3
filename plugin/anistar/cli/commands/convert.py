"""``anistar convert``."""

from __future__ import annotations

import argparse

from ...formats import read_with_report, write
from .. import console
from ..files import replaced_inputs, writable

SUMMARY = "write a mesh and its fields in another format"
EXAMPLE = "anistar convert in.msh out.vtu"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("input", help="mesh; in.mesh picks up in.sol")
    parser.add_argument("output", help="the suffix chooses the format")


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    output = writable(arguments.output, is_mesh=False)
    mesh, fields, report = read_with_report(arguments.input)
    replaced = replaced_inputs([arguments.input], output)
    write(output, mesh, fields)
    console.say_replaced(replaced, "what was read from it", beside_json=arguments.json)
    if arguments.json:
        console.show_json(report)
    else:
        console.say(f"{arguments.output}: {mesh.n_points} points, {mesh.n_cells} cells")
    return 0
