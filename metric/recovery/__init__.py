"""Recovery of gradients and Hessians from P1, P2 and P0 values."""

from .confidence import RecoveryConfidence
from .options import METHODS, RecoveryOptions
from .recover import (
    hessian_and_noise,
    hessians_of_fields,
    recover_gradient,
    recover_hessian,
    recovery_confidence,
)
from .samples.spaces import Samples, p2_nodes, read_fields

__all__ = [
    "METHODS",
    "RecoveryConfidence",
    "RecoveryOptions",
    "Samples",
    "hessian_and_noise",
    "hessians_of_fields",
    "p2_nodes",
    "read_fields",
    "recover_gradient",
    "recover_hessian",
    "recovery_confidence",
]
