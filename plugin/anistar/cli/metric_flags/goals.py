"""Metrics for the error in one output, from fields that a solver writes beside the solution."""

from __future__ import annotations

import argparse
from collections.abc import Mapping

import numpy as np

from ...base.arrays import Floats
from ...meshes.fields import Field
from ...meshes.mesh import Mesh
from ...metric import MetricOptions, dwr_metric, goal_metric, recover_hessian
from ...metric.pipeline.finishing import finishing_on
from ...metric.pipeline.target import aimed_at


def add_goal_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the flags that name the fields of a goal."""
    group = parser.add_argument_group("metrics for the error in one output, instead of the fields'")
    group.add_argument(
        "--adjoint",
        action="append",
        default=[],
        metavar="NAME",
        help="adjoint state of a diffusion problem, one for each --field",
    )
    group.add_argument(
        "--indicators",
        metavar="NAME",
        help="error indicators of the cells; the shape of the cells is that of --field, if given",
    )


def has_goals(arguments: argparse.Namespace) -> bool:
    """Whether any of the flags was given."""
    return bool(arguments.adjoint or arguments.indicators)


def goal_metrics(
    mesh: Mesh,
    fields: Mapping[str, Field],
    arguments: argparse.Namespace,
    options: MetricOptions,
) -> dict[str, Floats]:
    """Return the metrics (n, d, d) at the target, bounded and graded, by what they are.

    Raises
    ------
    ValueError
        If a field does not exist, lives elsewhere or does not fit, or no target is given.
    """
    if options.target_error is not None:
        raise ValueError("target_error is of fields: a goal needs a complexity or elements")
    states = arguments.field or []
    target = options.complexity_for(mesh.dim)
    found = {}
    if arguments.adjoint:
        if len(states) != len(arguments.adjoint):
            raise ValueError(
                f"--adjoint is given {len(arguments.adjoint)} times, --field {len(states)} times: "
                "each adjoint state belongs to a field"
            )
        found["goal"] = goal_metric(
            mesh,
            _columns(fields, states),
            _columns(fields, arguments.adjoint),
            target_complexity=target,
        )
    if arguments.indicators:
        H = recover_hessian(mesh, _values(fields, states[0], "points")) if states else None
        found["indicators"] = dwr_metric(
            mesh, _values(fields, arguments.indicators, "cells"), target_complexity=target, H=H
        )
    finishing = finishing_on(mesh, options)
    return {name: aimed_at(finishing, M, {}, options).growth.metric for name, M in found.items()}


def _columns(fields: Mapping[str, Field], names: list[str]) -> Floats:
    """Return the components of fields at the points as columns."""
    return np.column_stack([_values(fields, name, "points") for name in names])


def _values(fields: Mapping[str, Field], name: str, on: str) -> Floats:
    if name not in fields:
        raise ValueError(f"no field {name!r}; the fields are {', '.join(sorted(fields))}")
    if fields[name].on != on:
        raise ValueError(f"field {name!r} lives on {fields[name].on}, not on {on}")
    return np.asarray(fields[name].values, dtype=np.float64)
