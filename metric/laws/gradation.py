"""Gradation: a bound on how fast a metric may change over the mesh."""

from __future__ import annotations

import logging
from dataclasses import dataclass
from math import inf

import numpy as np

from ..base.arrays import Floats
from ..base.mesh import AnyMesh, as_mesh
from ..kernels.elementary import log
from ..kernels.gradation import grade, wide_graph
from ..kernels.graph import VertexGraph
from ..kernels.growth import Growth
from ..tensors.checks import check_metric_on, check_result

logger = logging.getLogger(__name__)

MODELS = ("physical", "metric", "mixed")
DEFAULT_FACTORS = {2: 1.5, 3: 2.0}
"""With the model "mixed"; chosen from the comparison in the documentation."""

TOLERANCE = 1e-5
"""A metric is raised only where more than this share of it is missing."""

MAX_ROUNDS = 100_000_000
"""Raises are finite, and a round may raise a single vertex: a bound, not a budget."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GrowthLaw:
    """How fast a metric may change, see `graded`; None means off.

    Attributes
    ----------
    factor : float or None
        Ratio of the sizes of neighbouring unit edges, above 1.
    model : {"physical", "metric", "mixed"}
        Law of the growth of the sizes.
    max_distortion : float or None
        Bound on ln gamma over one unit edge.
    """

    factor: float | None
    model: str
    max_distortion: float | None = None

    def __post_init__(self) -> None:
        b = self.factor
        if b is not None and not (np.isfinite(b) and b > 1.0):
            raise ValueError(f"gradation factor must be above 1 (or None for off), got {b}")
        if self.model not in MODELS:
            raise ValueError(
                f"gradation model must be one of {', '.join(MODELS)}, got {self.model!r}"
            )
        bound = self.max_distortion
        if bound is not None and not (np.isfinite(bound) and bound > 0.0):
            raise ValueError(f"max_distortion must be above 0 (or None for off), got {bound}")

    @property
    def is_off(self) -> bool:
        """Whether nothing is bounded."""
        return self.factor is None and self.max_distortion is None


def graded(
    mesh: AnyMesh,
    M: Floats,
    *,
    factor: float | None = 1.5,
    model: str = "physical",
    max_distortion: float | None = None,
    tolerance: float = TOLERANCE,
) -> Floats:
    """Limit how fast a metric changes, by making it finer where it must be.

    For every edge pq of the mesh, and every pair of vertices opposite across a facet (a
    regular grid knows too few directions without them), M_q is intersected with M_p grown
    over the distance, in both directions, until nothing changes by more than `tolerance`.

    Parameters
    ----------
    mesh : MeshLike or other mesh object
        The mesh that carries the metric.
    M : ndarray (n, d, d)
        Metric at the points, in 1 / length**2.
    factor : float or None
        Ratio b > 1 of the sizes of neighbouring unit edges. None means no bound on sizes.
    model : {"physical", "metric", "mixed"}
        ``physical``: each eigenvalue l relaxes by itself, ``l / (1 + sqrt(l) |pq| ln b)**2``,
        so the metric turns isotropic with the distance. ``metric``: the whole tensor,
        ``M_p / (1 + |pq|_p ln b)**2``, keeps its shape. ``mixed``: their geometric mean with
        weights 1/8 and 7/8.
    max_distortion : float, optional
        Bound on `distortion`, that is on ln gamma of every edge over its length in the metric:
        whatever the model asks, M_q is at least ``M_p / (1 + |pq|_p max_distortion)**2`` as a
        tensor. That bounds how fast the metric turns as well, which ``physical`` does not.
    tolerance : float
        Relative excess of the metric that is let pass.

    Returns
    -------
    ndarray (n, d, d)
        A metric nowhere coarser than `M`; grading it again changes nothing.

    Raises
    ------
    MetricError
        If `M` is no metric on the points of `mesh`, or the result is none.
    ValueError
        If `factor`, `model`, `max_distortion` or `tolerance` is out of range.

    Notes
    -----
    Let a and b be the lengths of an edge in the metrics at its ends, and a <= b. With the bound
    in force ``b / a`` and gamma are at most ``1 + b max_distortion = 1 + x``. The logarithmic mean
    of a and b is at least ``b x / ((1 + x) ln(1 + x))``, and as ``ln(1 + x) <= x / sqrt(1 + x)``,
    ln gamma is at most `max_distortion` times that mean length.

    References
    ----------
    .. [1] Alauzet, Size gradation control of anisotropic meshes, Finite Elements in Analysis
       and Design 46, 2010, sections 6.1 and 6.2. Differs from [1]_: the edges are completed by
       the opposite vertices, and visited in rounds until the tolerance holds, the densest
       vertices first, so that the numbering of the points has no influence.
    """
    mesh = as_mesh(mesh)
    M = check_metric_on(mesh, M)
    law = GrowthLaw(factor=factor, model=model, max_distortion=max_distortion)
    check_tolerance(tolerance)
    if law.is_off:
        return M
    growth = grade_on(wide_graph(mesh), mesh.points, M, law, tolerance)
    return check_result(growth.metric, "the gradation")


def check_tolerance(tolerance: float) -> None:
    """Raise ValueError if the tolerance of `graded` is out of range."""
    if not 0.0 < tolerance < 1.0:
        raise ValueError(f"gradation tolerance must be between 0 and 1, got {tolerance}")


def grade_on(
    graph: VertexGraph, points: Floats, M: Floats, law: GrowthLaw, tolerance: float = TOLERANCE
) -> Growth:
    """Grade a checked metric along a graph that is at hand."""
    result = grade(
        points,
        M,
        graph,
        model="none" if law.factor is None else law.model,
        log_factor=0.0 if law.factor is None else log(law.factor),
        max_distortion=inf if law.max_distortion is None else law.max_distortion,
        tolerance=tolerance,
        max_rounds=MAX_ROUNDS,
    )
    if not result.converged:
        logger.warning("gradation stopped after %d rounds", result.rounds)
    return result
