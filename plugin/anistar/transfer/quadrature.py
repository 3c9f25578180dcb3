"""History variables at quadrature points: each takes its state from the nearest, in the metric."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..base.arrays import AnyArray, Floats, Ints, Longs
from ..meshes.mesh import Mesh
from ..metric import check_metric, interpolated
from ..objects import AnyMesh, as_mesh
from .location import Places, located_coordinates
from .options import Outside, TransferOptions
from .regions import common_regions, warn_of_unmatched


def transfer_quadrature(
    source: AnyMesh,
    values: ArrayLike,
    target: AnyMesh,
    *,
    rule: ArrayLike,
    target_rule: ArrayLike | None = None,
    metric: ArrayLike | None = None,
    outside: Outside = "raise",
) -> AnyArray:
    """Carry history variables from quadrature points to quadrature points.

    Each target point takes the whole state of the source point that is nearest to it in the
    metric, in the region of its cell, so that a state is never averaged into one that the
    material cannot have.

    Parameters
    ----------
    source, target : Mesh or other mesh object
        Two meshes of the same dimension.
    values : (m, q, ...) array
        One state, of any shape and type, for each quadrature point of each source cell.
    rule : (q, d + 1) float array
        Barycentric coordinates of the quadrature points in a cell.
    target_rule : (r, d + 1) float array, optional
        The same on the target; `rule` by default.
    metric : (n, d, d) float array, optional
        Metric at the target's points, log-Euclidean in between; distances are Euclidean by
        default.
    outside : {"raise", "nearest"}
        What to do with target points outside the source.

    Returns
    -------
    (m_target, r, ...) array
        Of the type of the values.

    Raises
    ------
    ValueError
        If shapes do not fit, the metric is not positive definite, or a point lies outside.
    """
    source, target = as_mesh(source, "source"), as_mesh(target, "target")
    if source.dim != target.dim:
        raise ValueError(f"cannot transfer from a {source.dim}D mesh to a {target.dim}D mesh")
    if outside not in ("raise", "nearest"):
        raise ValueError(f"outside must be raise or nearest for states, not {outside!r}")
    given = _as_rule("rule", rule, source.dim)
    wanted = given if target_rule is None else _as_rule("target_rule", target_rule, target.dim)
    states = np.asarray(values)
    if states.shape[:2] != (source.n_cells, len(given)):
        raise ValueError(
            f"values of shape {states.shape} do not fit {source.n_cells} cells with {len(given)} "
            "quadrature points each"
        )
    tensors = _metric_at(target, wanted, metric)
    regions = common_regions(source, target)
    warn_of_unmatched(regions)
    places = located_coordinates(source, target, regions, wanted, TransferOptions(outside=outside))
    points = np.einsum("qk,mkd->mqd", given, source.points[source.cells])
    queries = np.einsum("qk,mkd->mqd", wanted, target.points[target.cells])
    chosen = np.empty(target.n_cells * len(wanted), dtype=np.int64)
    for region in range(regions.count):
        rows = np.flatnonzero(np.repeat(regions.target == region, len(wanted))).astype(np.int64)
        cells = np.flatnonzero(regions.source == region).astype(np.int64)
        within = _nearest_in_region(
            points[cells], cells, queries.reshape(-1, source.dim)[rows], tensors[rows], places, rows
        )
        chosen[rows] = cells[within // len(given)] * len(given) + within % len(given)
    flat = states.reshape(-1, *states.shape[2:])
    return np.asarray(flat[chosen].reshape(target.n_cells, len(wanted), *states.shape[2:]))


def _as_rule(name: str, rule: ArrayLike, dim: int) -> Floats:
    points = np.asarray(rule, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != dim + 1 or len(points) == 0:
        raise ValueError(f"{name} must have shape (q, {dim + 1}), not {points.shape}")
    worst = float(np.abs(points.sum(axis=1) - 1).max())
    if worst > 1e-9 or points.min() < -1e-9:
        raise ValueError(
            f"{name} must hold barycentric coordinates, none negative and with sum 1; "
            f"smallest {points.min():.3g}, sums off by {worst:.3g}"
        )
    return points


def _metric_at(target: Mesh, rule: Floats, metric: ArrayLike | None) -> Floats:
    """Return the (m * r, d, d) metric at the target's quadrature points."""
    n = target.n_cells * len(rule)
    if metric is None:
        return np.tile(np.eye(target.dim), (n, 1, 1))
    M = check_metric(metric, n_points=target.n_points, dim=target.dim)
    corners = np.repeat(M[target.cells], len(rule), axis=0)
    return np.asarray(interpolated(corners, np.tile(rule, (target.n_cells, 1))))


def _nearest_in_region(
    points: Floats, cells: Longs, queries: Floats, tensors: Floats, places: Places, rows: Longs
) -> Ints:
    """Return the index among the flat points of the one nearest to each query."""
    number = np.searchsorted(cells, places.cells[rows])
    offset = points[number] - queries[:, None]
    distance = np.einsum("nqi,nij,nqj->nq", offset, tensors, offset)
    seeds = number * points.shape[1] + np.argmin(distance, axis=1)
    nearest = _core.nearest_in_metric2 if points.shape[2] == 2 else _core.nearest_in_metric3
    return np.asarray(
        nearest(
            np.ascontiguousarray(points.reshape(-1, points.shape[2])),
            np.ascontiguousarray(queries),
            np.ascontiguousarray(tensors),
            seeds.astype(np.int32),
        )
    )
