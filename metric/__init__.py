"""Metric fields that say which mesh is wanted.

A metric is an array (n, d, d) of symmetric positive definite tensors at the points of a mesh,
in 1 / length**2: an edge v should satisfy ``v^T M v = 1``.
"""

from .bounds import bounded
from .checks import MetricError, check_metric
from .coarsening import limited_coarsening
from .combination import intersected, limited_step, mean
from .complexity import ELEMENTS_PER_COMPLEXITY, complexity
from .curvature import curvature_metric
from .distortion import distortion
from .error_model import predicted_error
from .estimate import Estimate, estimate
from .goal import (
    diffusion_hessian,
    flux_hessian,
    goal_metric,
    weighted_hessian,
    weighted_hessian_metric,
)
from .gradation import graded
from .graph import mesh_edges
from .implied import implied_metric
from .indicators import dwr_metric
from .instants import SpaceTimeLedger, from_instants
from .ledger import Ledger, Stage
from .mesh import MeshLike
from .normalisation import normalised, normalised_space_time
from .options import MetricOptions
from .pipeline import from_fields
from .recovery import (
    METHODS,
    RecoveryConfidence,
    RecoveryOptions,
    p2_nodes,
    recover_gradient,
    recover_hessian,
    recovery_confidence,
)
from .refinement import limited_refinement
from .size_fields import size_in_box, size_near_boundary, size_near_points
from .sizes import from_sizes
from .tensor_functions import absolute, exp_metric, interpolated, log_metric, sqrt_metric
from .tensor_orders import from_components, to_components

__all__ = [
    "ELEMENTS_PER_COMPLEXITY",
    "METHODS",
    "Estimate",
    "Ledger",
    "MeshLike",
    "MetricError",
    "MetricOptions",
    "RecoveryConfidence",
    "RecoveryOptions",
    "SpaceTimeLedger",
    "Stage",
    "absolute",
    "bounded",
    "check_metric",
    "complexity",
    "curvature_metric",
    "diffusion_hessian",
    "distortion",
    "dwr_metric",
    "estimate",
    "exp_metric",
    "flux_hessian",
    "from_components",
    "from_fields",
    "from_instants",
    "from_sizes",
    "goal_metric",
    "graded",
    "implied_metric",
    "interpolated",
    "intersected",
    "limited_coarsening",
    "limited_refinement",
    "limited_step",
    "log_metric",
    "mean",
    "mesh_edges",
    "normalised",
    "normalised_space_time",
    "p2_nodes",
    "predicted_error",
    "recover_gradient",
    "recover_hessian",
    "recovery_confidence",
    "size_in_box",
    "size_near_boundary",
    "size_near_points",
    "sqrt_metric",
    "to_components",
    "weighted_hessian",
    "weighted_hessian_metric",
]
