"""``anistar convert``."""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Sequence
from pathlib import Path

from ...formats import holdable, instants, losses, put, read, read_with_report
from ...formats.suffixes import suffix_of
from ...formats.vtk.pvd import require_own
from ...runs.series import SeriesWriter
from .. import console
from ..files import replaced_inputs, require_apart, writable

SUMMARY = "write a mesh and its fields in another format"
EXAMPLE = "anistar convert in.msh out.vtu"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("input", help="mesh; in.mesh picks up in.sol")
    parser.add_argument("output", help="the suffix chooses the format")
    parser.add_argument(
        "--dry-run", action="store_true", help="say what would be lost, and write nothing"
    )


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    output = writable(arguments.output, is_mesh=False)
    times = instants(arguments.input)
    if suffix_of(output) == ".pvd" and len(times) > 1 and Path(arguments.input).is_file():
        return _convert_series(arguments, output, times)
    replaced = replaced_inputs([arguments.input], output)
    mesh, fields, report = read_with_report(arguments.input)
    lost = losses(mesh, fields, output)
    kept = holdable(mesh, fields, output)
    if suffix_of(output) == ".pvd":
        require_own(output, 1)
    if arguments.dry_run:
        with tempfile.TemporaryDirectory() as folder:
            lost += put(
                Path(folder) / output.name, mesh, kept
            )  # what cannot be written is an error
    else:
        lost += put(output, mesh, kept)
        console.say_replaced(replaced, "what was read from it", beside_json=arguments.json)
    if arguments.json:
        console.show_json({**report.as_dict(), "lost": lost})
        return 0
    verb = "would have" if arguments.dry_run else "has"
    console.say(f"{output} {verb} {mesh.n_points} points, {mesh.n_cells} cells")
    _show(lost, "would be lost" if arguments.dry_run else "lost")
    return 0


def _convert_series(arguments: argparse.Namespace, output: Path, times: Sequence[float]) -> int:
    """Write every instant of a series; VTU has a place for everything in them."""
    require_apart([Path(arguments.input)], output, len(times))
    require_own(output, len(times))
    if not arguments.dry_run:
        writer = SeriesWriter(output)
        for number, time in enumerate(times):
            writer.add(time, *read(arguments.input, instant=number))
    verb = "would have" if arguments.dry_run else "has"
    if arguments.json:
        console.show_json({"path": str(output), "times": list(times), "lost": []})
    else:
        console.say(f"{output} {verb} {len(times)} instants")
        _show([], "would be lost" if arguments.dry_run else "lost")
    return 0


def _show(lost: Sequence[str], verb: str) -> None:
    for text in lost:
        console.say(f"  {verb}: {text}")
    if not lost:
        console.say(f"  nothing {verb}")
