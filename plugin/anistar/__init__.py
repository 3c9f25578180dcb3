"""anistar: certified anisotropic Delaunay mesh adaptation for any PDE code."""

from . import metric
from .errors import FormatError, MeshingError
from .fields import Field
from .mesh import Mesh
from .metric import MetricError, MetricOptions
from .remesh import Remeshed, RemeshOptions, remesh
from .validation import Violation, validate

__all__ = [
    "Field",
    "FormatError",
    "Mesh",
    "MeshingError",
    "MetricError",
    "MetricOptions",
    "RemeshOptions",
    "Remeshed",
    "Violation",
    "metric",
    "remesh",
    "validate",
]
