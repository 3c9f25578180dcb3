"""Pictures of meshes, solutions, metrics and convergence; they need matplotlib."""

from .plane import (
    bars_picture,
    certificate_picture,
    convergence_picture,
    mesh_picture,
    metric_picture,
    overview_picture,
    solution_picture,
)
from .volume import volume_overview_picture, volume_picture

__all__ = [
    "bars_picture",
    "certificate_picture",
    "convergence_picture",
    "mesh_picture",
    "metric_picture",
    "overview_picture",
    "solution_picture",
    "volume_overview_picture",
    "volume_picture",
]
