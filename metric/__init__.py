"""Metric fields that say which mesh is wanted.

A metric is an array (n, d, d) of symmetric positive definite tensors at the points of a mesh,
in 1 / length**2: an edge v should satisfy ``v^T M v = 1``.
"""

from .algebra import absolute, exp_metric, interpolated, log_metric, sqrt_metric
from .bounds import bounded
from .checks import MetricError, check_metric
from .combination import intersected, mean
from .complexity import ELEMENTS_PER_COMPLEXITY, complexity
from .distortion import distortion
from .goal import (
    diffusion_hessian,
    flux_hessian,
    goal_metric,
    weighted_hessian,
    weighted_hessian_metric,
)
from .gradation import graded
from .graph import mesh_edges
from .indicators import dwr_metric
from .ledger import Ledger, Stage
from .mesh import MeshLike
from .normalisation import normalised
from .options import MetricOptions
from .pipeline import from_fields
from .recovery import recover_hessian
from .sizes import from_sizes
from .tensor_orders import from_components, to_components

__all__ = [
    "ELEMENTS_PER_COMPLEXITY",
    "Ledger",
    "MeshLike",
    "MetricError",
    "MetricOptions",
    "Stage",
    "absolute",
    "bounded",
    "check_metric",
    "complexity",
    "diffusion_hessian",
    "distortion",
    "dwr_metric",
    "exp_metric",
    "flux_hessian",
    "from_components",
    "from_fields",
    "from_sizes",
    "goal_metric",
    "graded",
    "interpolated",
    "intersected",
    "log_metric",
    "mean",
    "mesh_edges",
    "normalised",
    "recover_hessian",
    "sqrt_metric",
    "to_components",
    "weighted_hessian",
    "weighted_hessian_metric",
]
