"""``anistar generate``."""

from __future__ import annotations

import argparse
from typing import Any

from ...base.errors import FormatError
from ...formats import read as read_mesh
from ...formats import read_metric, write
from ...formats.suffixes import suffix_of
from ...generating.generate import generate
from ...generating.report import GenerateReport
from .. import console
from ..files import replaced_inputs, writable
from ..options import add_generate_options, generate_options

#: Formats of surfaces alone.
OF_SURFACES = (".stl", ".obj", ".off", ".ply")

SUMMARY = "make the first mesh of a geometry: an STL, a surface mesh, a PLC or an outline"
EXAMPLE = "anistar generate part.stl --size 0.05 -o part.msh"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        "input", help="stl, obj, off, ply, poly, smesh, or a surface in a format of meshes"
    )
    parser.add_argument("-o", "--output", required=True, help="the mesh")
    parser.add_argument(
        "--size",
        type=float,
        metavar="X",
        help="length of the edges; without it sizes follow the widths of the facets",
    )
    parser.add_argument(
        "--background",
        metavar="FILE",
        help="mesh that carries the metric of --metric, in place of a size",
    )
    parser.add_argument(
        "--metric", metavar="FILE", help="tensors, or sizes, at the points of the background"
    )
    add_generate_options(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    output = writable(arguments.output)
    if suffix_of(output) in OF_SURFACES:
        raise FormatError(f"cannot write {output}: {output.suffix} has no place for cells")
    given = _wished(arguments)
    done = generate(arguments.input, **given, **generate_options(arguments))
    inputs = (arguments.input, arguments.background, arguments.metric)
    replaced = replaced_inputs(inputs, output)
    write(output, done.mesh)
    console.say_replaced(replaced, "the new mesh", beside_json=arguments.json)
    if arguments.json:
        console.show_json(done.report)
    else:
        _show(arguments, done.report)
    return 0


def _wished(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the size or the metric that was asked for."""
    if (arguments.background is None) != (arguments.metric is None):
        raise FormatError("--metric and --background go together: a metric lives on a mesh")
    if arguments.background is None:
        return {"size": arguments.size}
    if arguments.size is not None:
        raise FormatError("give --size or --metric, not both")
    background, _ = read_mesh(arguments.background)
    return {"metric": (background, read_metric(arguments.metric, background))}


def _show(arguments: argparse.Namespace, report: GenerateReport) -> None:
    rows = [
        ("points", report.n_points),
        ("cells", report.n_cells),
        ("least angle (degrees)", report.shapes.angle_min),
        ("largest radius-edge ratio", report.shapes.radius_edge_max),
        ("points added for the facets", report.constrained.get("steiner_points")),
        ("largest error of a facet's area", report.measures.facet_error),
        ("largest error of a region's volume", report.measures.region_error),
        ("volume between given and new facets", report.measures.volume_between),
    ]
    title = f"generated in {sum(report.seconds.values()):.2f} s"
    console.show_table(title, ("", arguments.output), rows)
    for remark in report.reading:
        console.say(remark)
    if not report.converged:
        console.say(f"not converged: stopped at {report.stop_reason}, the mesh is valid")
