"""Bounds, gradation and target for a metric that comes from somewhere else than fields."""

from __future__ import annotations

import logging
from typing import Any

from numpy.typing import ArrayLike

from ..base.arrays import Floats
from ..base.mesh import AnyMesh, as_mesh
from ..tensors.checks import check_metric
from .finishing import finishing_on
from .options import MetricOptions
from .target import aimed_at

logger = logging.getLogger(__name__)


def finished(
    mesh: AnyMesh, M: ArrayLike, options: MetricOptions | None = None, **settings: Any
) -> Floats:
    """Bound and grade a metric so that it meets its target after all of that.

    This is how `from_fields` ends: gradation alone raises the complexity of a metric, so one
    factor on `M` is looked for with which the bounded and graded metric has the complexity, or
    the expected number of elements, that is asked for. Without a target `M` is bounded and graded.

    Parameters
    ----------
    mesh : MeshLike or other mesh object
    M : array_like (n, d, d)
        Metric at its points, such as a `goal_metric`.
    options : MetricOptions, optional
        Target, bounds and gradation; a target error needs fields.
    **settings
        Single options by name, in place of those of `options`.

    Returns
    -------
    ndarray (n, d, d)
        Where the target is out of reach a warning is logged, and this is the nearest.

    Raises
    ------
    MetricError
        If a tensor is not symmetric positive definite; the point is named.
    ValueError
        If an option is wrong, or the target is an error.
    """
    background = as_mesh(mesh)
    options = MetricOptions.chosen(options, settings)
    if options.target_error is not None:
        raise ValueError("a target_error needs fields, of which from_fields makes the metric")
    n, d = background.points.shape
    base = check_metric(M, n_points=n, dim=d)
    finishing = finishing_on(background, options)
    if not options.has_count:
        return finishing.finished(base).metric
    aimed = aimed_at(finishing, base, {}, options)
    if not aimed.reached:
        logger.warning(aimed.message)
    return aimed.growth.metric
