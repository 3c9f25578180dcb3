"""``anistar check``."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, get_args

from ...base.arrays import Floats
from ...formats import ReadReport, read, read_metric, read_with_report, write
from ...generating.surface_files import holds_geometry
from ...judging.cell_arrays import cell_arrays
from ...judging.certificate import Certificate, certify
from ...judging.quality import quality
from ...judging.skin import Shape, Skin
from ...meshes.mesh import Mesh
from ...meshes.validation import validate
from ...meshes.violations import Violation
from ...metric import check_metric
from .. import console, geometry_check
from ..files import replaced_inputs, writable, writable_file

SUMMARY = "check a mesh, measure and certify it in a metric; or check a geometry"
EXAMPLE = "anistar check out.mesh --metric out.sol --reference in.mesh -o figures.vtu"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        "input", help="mesh; or geometry to be meshed: stl, obj, off, ply, poly, a surface mesh"
    )
    parser.add_argument(
        "--metric",
        metavar="FILE",
        help="metric at the points; the stars are certified for it",
    )
    parser.add_argument(
        "--reference", metavar="FILE", help="mesh with the same domain, tags and names"
    )
    parser.add_argument(
        "--tolerance",
        type=float,
        default=1e-10,
        help="allowed relative difference of measures from the reference (default 1e-10)",
    )
    parser.add_argument(
        "--shape",
        choices=get_args(Shape),
        default=Skin().shape,
        help="what the facets mean to surface stars: samples of smooth curves and surfaces, or "
        "the domain itself (default smooth)",
    )
    parser.add_argument(
        "--ridge-angle",
        type=float,
        default=Skin().ridge_angle,
        help="degrees from which facets meet in a corner or ridge (default 45)",
    )
    parser.add_argument(
        "-o",
        "--output",
        metavar="FILE",
        help="write the mesh with figures of every cell: longest edge, quality, distortion, "
        "inconsistent (.vtu)",
    )
    parser.add_argument(
        "--picture", metavar="FILE", help="draw the mesh, triangles that are not certified in red"
    )
    parser.add_argument(
        "--mark",
        metavar="FILE",
        help="of a geometry: write the triangles, edges and points that are wrong (.vtu)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Run the command; 1 if the mesh breaks a rule or a star is neither certified nor exempt.

    Surface stars are told, and change nothing of that.
    """
    if holds_geometry(Path(arguments.input)):
        return geometry_check.run(arguments)
    if arguments.mark:
        raise ValueError(f"--mark is for geometry; {arguments.input} is a mesh")
    _check_targets(arguments)
    mesh, _, found = read_with_report(arguments.input)
    reference = read(arguments.reference)[0] if arguments.reference else None
    problems = validate(mesh, reference, tolerance=arguments.tolerance)
    M = certificate = None
    if arguments.metric:
        M = check_metric(read_metric(arguments.metric, mesh), dim=mesh.dim)
        certificate = certify(mesh, M, shape=arguments.shape, ridge_angle=arguments.ridge_angle)
        _write(arguments, mesh, M, certificate)
    _show(arguments, found, problems, quality(mesh, M).as_dict(), certificate)
    is_good = certificate is None or certificate.is_certified
    return 0 if is_good and not problems else 1


def _check_targets(arguments: argparse.Namespace) -> None:
    for flag, check in (("output", writable), ("picture", writable_file)):
        path = getattr(arguments, flag)
        if path and not arguments.metric:
            raise ValueError(f"--{flag} needs --metric")
        if path:
            check(path)


def _write(arguments: argparse.Namespace, mesh: Mesh, M: Floats, certificate: Certificate) -> None:
    if arguments.output:
        inputs = (arguments.input, arguments.reference, arguments.metric)
        replaced = replaced_inputs(inputs, Path(arguments.output))
        write(arguments.output, mesh, cell_arrays(mesh, M, certificate))
        console.say_replaced(replaced, "the figures", beside_json=arguments.json)
    if arguments.picture:
        if mesh.dim != 2:
            raise ValueError(f"--picture is for 2D meshes; this one has dimension {mesh.dim}")
        # matplotlib is an extra, needed for pictures only
        from ...pictures import certificate_picture

        certificate_picture(arguments.picture, mesh, certificate)


def _show(
    arguments: argparse.Namespace,
    found: ReadReport,
    problems: list[Violation],
    figures: dict[str, Any],
    certificate: Certificate | None,
) -> None:
    if arguments.json:
        said = {"valid": not problems, "problems": [p.message for p in problems], "read": found}
        if certificate is not None:
            said["certificate"] = certificate.as_dict()
        console.show_json({**said, **figures})
        return
    rows = [[name, value] for name, value in figures.items() if value is not None]
    console.show_table(arguments.input, ["", ""], rows)
    for problem in problems:
        console.say(f"{problem.kind}: {problem.message}")
    console.say("not valid" if problems else "valid")
    if certificate is not None:
        console.say(certificate.verdict)
