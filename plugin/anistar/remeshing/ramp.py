"""Metrics that are much finer than the mesh that carries them are approached in steps."""

from __future__ import annotations

import numpy as np

from ..base.arrays import Floats
from ..base.telling import tell
from ..meshes.fields import Field
from ..meshes.mesh import Mesh
from ..metric import MetricError, exp_metric, log_metric
from ..metric.laws.refinement import Refinement, refinement_limited
from ..transfer import TransferOptions, transfer


def approached(mesh: Mesh, metric: Floats, scale: float, ratio: float | str | None) -> Refinement:
    """Limit a metric to what one remeshing may refine, and say so where that changes it.

    Parameters
    ----------
    mesh : Mesh
    metric : (n, d, d) float64
        Positive definite, in coordinates that are `scale` times those of the mesh.
    scale : float
    ratio : float, "auto" or None
        See `RemeshOptions.max_refinement`.

    Returns
    -------
    Refinement
        Of the same metric where there is no limit, or where cells are so flat that none can be
        measured, which is said.
    """
    nothing = Refinement(metric=metric, is_limited=np.zeros(len(metric), dtype=bool), excess=1.0)
    if ratio is None:
        return nothing
    try:
        scaled = Mesh._trusted(points=mesh.points * scale, cells=mesh.cells)
        found = refinement_limited(scaled, metric, ratio)
    except MetricError as error:  # the cells, not the metric, which was checked
        tell([f"max_refinement: the cells are too flat to tell what to limit: {error}"])
        return nothing
    if found.is_limited.any():
        tell([_said(found)])
    return found


def _said(found: Refinement) -> str:
    return (
        f"max_refinement: the metric asks for edges up to {found.excess:.3g} times shorter than "
        f"the mesh that carries it can resolve, at {found.is_limited.mean():.3g} of its points; "
        "what was made is between the two: remesh it again, with the metric evaluated at its points"
    )


def carried(mesh: Mesh, metric: Floats, new: Mesh) -> Floats:
    """Interpolate a metric (n, d, d) at the points of a new mesh, as the core does."""
    logarithm = {"metric": Field(log_metric(metric))}
    options = TransferOptions(outside="nearest")
    return exp_metric(transfer(mesh, logarithm, new, options).fields["metric"].values)
