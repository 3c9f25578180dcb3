"""Gradation: a bound on how fast a metric may change over the mesh."""

from __future__ import annotations

import logging
from math import log

import numpy as np
from numpy.typing import NDArray

from . import kernels
from .checks import check_metric
from .graph import VertexGraph, wide_graph
from .growth import Growth
from .mesh import MeshLike

Array = NDArray[np.float64]

logger = logging.getLogger(__name__)

MODELS = ("physical", "metric", "mixed")
DEFAULT_FACTORS = {2: 1.5, 3: 1.3}

TOLERANCE = 1e-5
"""A metric is raised only where more than this share of it is missing."""

MAX_ROUNDS = 100_000
"""Information travels one edge per round, and raises are finite: a bound, not a budget."""


def graded(
    mesh: MeshLike,
    M: Array,
    *,
    factor: float | None = 1.5,
    model: str = "physical",
    tolerance: float = TOLERANCE,
) -> Array:
    """Limit the growth of sizes to `factor`, by making the metric finer where it must be.

    For every edge pq of the mesh, and every pair of vertices opposite across a facet (a
    regular grid knows too few directions without them), M_q is intersected with M_p grown
    over the distance, in both directions, until nothing changes by more than `tolerance`.

    Parameters
    ----------
    mesh : MeshLike
        The mesh that carries the metric.
    M : ndarray (n, d, d)
        Metric at the points, in 1 / length**2.
    factor : float or None
        Ratio b > 1 of the sizes of neighbouring unit edges. None means off.
    model : {"physical", "metric", "mixed"}
        ``physical``: each eigenvalue l relaxes by itself, ``l / (1 + sqrt(l) |pq| ln b)**2``,
        so the metric turns isotropic with the distance. ``metric``: the whole tensor,
        ``M_p / (1 + |pq|_p ln b)**2``, keeps its shape. ``mixed``: their geometric mean with
        weights 1/8 and 7/8.
    tolerance : float
        Relative excess of the metric that is let pass.

    Returns
    -------
    ndarray (n, d, d)
        A metric nowhere coarser than `M`; grading it again changes nothing.

    Raises
    ------
    MetricError
        If `M` is no metric on the points of `mesh`.
    ValueError
        If `factor`, `model` or `tolerance` is out of range.

    References
    ----------
    .. [1] Alauzet, Size gradation control of anisotropic meshes, Finite Elements in Analysis
       and Design 46, 2010, sections 6.1 and 6.2. Differs from [1]_: the edges are completed by
       the opposite vertices, and visited in rounds until the tolerance holds.
    """
    n, d = mesh.points.shape
    M = check_metric(M, n_points=n, dim=d)
    check_gradation(factor, model, tolerance)
    if factor is None:
        return M
    return grade_on(wide_graph(mesh), mesh.points, M, factor, model, tolerance).metric


def check_gradation(factor: float | None, model: str, tolerance: float = TOLERANCE) -> None:
    """Raise ValueError if an argument of `graded` is out of range."""
    if factor is not None and not (np.isfinite(factor) and factor > 1.0):
        raise ValueError(f"gradation factor must be above 1 (or None for off), got {factor}")
    if model not in MODELS:
        raise ValueError(f"gradation model must be one of {', '.join(MODELS)}, got {model!r}")
    if not 0.0 < tolerance < 1.0:
        raise ValueError(f"gradation tolerance must be between 0 and 1, got {tolerance}")


def grade_on(
    graph: VertexGraph,
    points: Array,
    M: Array,
    factor: float,
    model: str,
    tolerance: float = TOLERANCE,
) -> Growth:
    """Grade a checked metric along a graph that is at hand."""
    result = kernels.grade(
        points,
        M,
        graph,
        model=model,
        log_factor=log(factor),
        tolerance=tolerance,
        max_rounds=MAX_ROUNDS,
    )
    if not result.converged:
        logger.warning("gradation stopped after %d rounds", result.rounds)
    return result
