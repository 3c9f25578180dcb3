"""Metrics that do not come from fields: given ones, of the mesh, of sizes, of the boundary."""

from __future__ import annotations

import argparse
from typing import Any

from ...base.arrays import Floats
from ...formats import read_metric
from ...meshes.mesh import Mesh
from ...metric import (
    check_metric,
    curvature_metric,
    from_sizes,
    implied_metric,
    size_in_box,
    size_near_boundary,
    size_near_points,
)
from ...metric.tensors.checks import REPAIRS
from ..options import numbers


def add_source_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the flags that name a metric each; all of them are combined."""
    group = parser.add_argument_group("other metrics, intersected with that of the fields")
    group.add_argument(
        "--given", action="append", default=[], metavar="FILE", help="metric at the points of input"
    )
    group.add_argument(
        "--repair",
        choices=REPAIRS,
        default="raise",
        help="what to do where a given metric is not positive definite (default raise)",
    )
    group.add_argument("--implied", action="store_true", help="the metric that the mesh has")
    group.add_argument(
        "--points-per-circle", type=float, metavar="X", help="edges on a circle of the boundary"
    )
    group.add_argument(
        "--chord-error", type=float, metavar="X", help="distance of an edge from the boundary"
    )
    for flag, form, text in (
        ("--size-near", "X,Y[,Z],H", "size H at a point, growing from there"),
        ("--size-in-box", "LOW,HIGH,H", "size H in a box given by the coordinates of two corners"),
    ):
        group.add_argument(flag, action="append", default=[], type=numbers, metavar=form, help=text)
    group.add_argument(
        "--size-at-tag",
        action="append",
        default=[],
        type=_name_and_size,
        metavar="TAG,H",
        help="size H at the facets with a tag or a name, growing from there",
    )


def _name_and_size(text: str) -> tuple[str, float]:
    name, comma, size = text.rpartition(",")
    try:
        found = float(size)
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"{text!r} is no tag or name with a size") from error
    if not comma:
        raise argparse.ArgumentTypeError(f"{text!r} has no size: give TAG,H or NAME,H")
    return name.strip(), found


def has_sources(arguments: argparse.Namespace) -> bool:
    """Whether any of the flags was given."""
    return any(
        getattr(arguments, name)
        for name in (
            "given", "implied", "points_per_circle", "chord_error", "size_near", "size_in_box",
            "size_at_tag",
        )
    )  # fmt: skip


def sources(mesh: Mesh, arguments: argparse.Namespace) -> dict[str, Floats]:
    """Return the metrics (n, d, d) that the flags ask for, by what they are.

    Raises
    ------
    ValueError
        If a flag has the wrong count of numbers, or one out of range, or a given metric is none.
    """
    d = mesh.dim
    found: dict[str, Floats] = {
        path: check_metric(read_metric(path, mesh), name=path, repair=arguments.repair)
        for path in arguments.given
    }
    if arguments.implied:
        found["implied"] = implied_metric(mesh)
    chord: dict[str, Any] = {
        name: getattr(arguments, name)
        for name in ("points_per_circle", "chord_error")
        if getattr(arguments, name) is not None
    }
    if chord:
        found["curvature"] = curvature_metric(mesh, **chord)
    for place in arguments.size_near:
        _count("--size-near", place, d + 1)
        found[f"near {place[:-1]}"] = from_sizes(size_near_points(mesh, place[:d], place[d]), d)
    for box in arguments.size_in_box:
        _count("--size-in-box", box, 2 * d + 1)
        found[f"in box {box[:-1]}"] = from_sizes(
            size_in_box(mesh, box[:d], box[d : 2 * d], box[2 * d]), d
        )
    for called, size in arguments.size_at_tag:
        found[f"at {called}"] = from_sizes(size_near_boundary(mesh, called, size), d)
    return found


def _count(flag: str, values: tuple[float, ...], wanted: int) -> None:
    if len(values) != wanted:
        raise ValueError(f"{flag} needs {wanted} numbers, got {len(values)}")
