"""anistar: certified anisotropic Delaunay mesh adaptation for any PDE code."""

from . import metric
from .adapt import Adapted, AdaptOptions, adapt
from .certificate import Certificate, SimplexOfStar, certify, explain_star
from .consistency import ConsistencyOptions
from .errors import FormatError, MeshingError
from .fields import Field
from .formats import read, write
from .keeping import KeepOptions, needs_adaptation
from .loop import Loop, LoopError, Step, adapt_loop
from .loop_options import LoopOptions
from .mesh import Mesh
from .metric import MetricError, MetricOptions
from .remesh import Remeshed, remesh
from .remesh_options import RemeshOptions
from .settling import Settled
from .study import Study, convergence_study
from .transfer import (
    TransferOptions,
    Transferred,
    transfer,
    transfer_operator,
    transfer_quadrature,
)
from .unsteady import UnsteadyOptions, unsteady_loop
from .validation import validate
from .violations import Violation

__all__ = [
    "AdaptOptions",
    "Adapted",
    "Certificate",
    "ConsistencyOptions",
    "Field",
    "FormatError",
    "KeepOptions",
    "Loop",
    "LoopError",
    "LoopOptions",
    "Mesh",
    "MeshingError",
    "MetricError",
    "MetricOptions",
    "RemeshOptions",
    "Remeshed",
    "Settled",
    "SimplexOfStar",
    "Step",
    "Study",
    "TransferOptions",
    "Transferred",
    "UnsteadyOptions",
    "Violation",
    "adapt",
    "adapt_loop",
    "certify",
    "convergence_study",
    "explain_star",
    "metric",
    "needs_adaptation",
    "read",
    "remesh",
    "transfer",
    "transfer_operator",
    "transfer_quadrature",
    "unsteady_loop",
    "validate",
    "write",
]
