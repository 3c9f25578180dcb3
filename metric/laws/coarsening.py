"""How much coarser than the mesh at hand the next one may be."""

from __future__ import annotations

import numpy as np

from ..base.arrays import Floats
from ..base.mesh import AnyMesh, MeshLike, as_mesh
from ..kernels.elementary import power
from ..kernels.intersection import intersect
from ..tensors.checks import check_metric_on, check_result
from ..tensors.combination import check_step
from .complexity import complexity
from .implied import implied_metric


def limited_coarsening(mesh: AnyMesh, M: Floats, ratio: float = 2.0) -> Floats:
    """Refine a metric where it asks for sizes much larger than those of the mesh.

    A recovered Hessian that is too small somewhere makes huge cells there, on which nothing can
    be recovered any more: the error jumps, until a later pass mends it. Sizes may grow by `ratio`
    at most, also in any one direction, so that a region loses its points in several passes,
    each of which still sees what is in it. Refinement is not limited. Where the mesh has a
    larger complexity than the metric, its sizes are first stretched by what that explains.

    Parameters
    ----------
    mesh : MeshLike or other mesh object
        The mesh that carries the metric.
    M : ndarray (n, d, d)
        Metric, in 1 / length**2.
    ratio : float
        Largest factor between a size that is asked for and that of the mesh, above 1.

    Returns
    -------
    ndarray (n, d, d)
        The intersection of `M` and ``limited_step(implied_metric(mesh), M, ratio)``. Its
        complexity is larger than that of `M` where the limit acts.

    Raises
    ------
    MetricError
        If `M` is no metric.
    ValueError
        If `ratio` is out of range, or the mesh has no metric, see `implied_metric`.
    """
    mesh = as_mesh(mesh)
    check_step("ratio", ratio)
    metric = check_metric_on(mesh, M)
    return check_result(coarsening_limited(mesh, metric, ratio), "the limit of coarsening")


def coarsening_limited(mesh: MeshLike, M: Floats, ratio: float) -> Floats:
    """Limit the coarsening of a checked metric by a checked ratio."""
    d = M.shape[-1]
    own = implied_metric(mesh)
    stretch = power(min(1.0, complexity(mesh, M) / complexity(mesh, own)), 2.0 / d)
    # in the common basis of both this holds the eigenvalues from below, as limited_step does
    return intersect(M, own * (stretch / np.square(ratio)))
