"""Metric fields that say which mesh is wanted.

A metric is an array (n, d, d) of symmetric positive definite tensors at the points of a mesh,
in 1 / length**2: an edge v should satisfy ``v^T M v = 1``.
"""

from .base.mesh import MeshLike
from .kernels.graph import mesh_edges
from .laws.bounds import bounded
from .laws.coarsening import limited_coarsening
from .laws.complexity import ELEMENTS_PER_COMPLEXITY, complexity
from .laws.distortion import distortion
from .laws.error_model import predicted_error
from .laws.estimate import Estimate, estimate
from .laws.gradation import graded
from .laws.implied import implied_metric
from .laws.normalisation import normalised, normalised_space_time
from .laws.refinement import limited_refinement
from .pipeline.finished import finished
from .pipeline.from_fields import from_fields
from .pipeline.from_instants import SpaceTimeLedger, from_instants
from .pipeline.ledger import Ledger, Stage
from .pipeline.options import MetricOptions
from .recovery import (
    METHODS,
    RecoveryConfidence,
    RecoveryOptions,
    p2_nodes,
    recover_gradient,
    recover_hessian,
    recovery_confidence,
)
from .sources.curvature import curvature_metric
from .sources.goal import (
    diffusion_hessian,
    flux_hessian,
    goal_metric,
    weighted_hessian,
    weighted_hessian_metric,
)
from .sources.indicators import dwr_metric
from .sources.size_fields import size_in_box, size_near_boundary, size_near_points
from .sources.sizes import from_sizes
from .tensors.checks import MetricError, check_metric
from .tensors.combination import intersected, limited_step, mean
from .tensors.functions import absolute, exp_metric, interpolated, log_metric, sqrt_metric
from .tensors.orders import from_components, to_components

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
    "finished",
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
