"""anistar: certified anisotropic Delaunay mesh adaptation for any PDE code."""

import importlib
from types import ModuleType

from . import metric
from .base.errors import FormatError, MeshingError
from .base.progress import progress
from .formats import read, write
from .generating import (
    PLC,
    Generated,
    GenerateOptions,
    PLCError,
    PLCProblem,
    Region,
    RepairReport,
    Wrapped,
    check_plc,
    generate,
    read_plc,
    repaired,
    wrap,
    write_plc,
)
from .judging.certificate import Certificate, certify
from .judging.explanation import FacetOfStar, SimplexOfStar, explain_star, explain_surface_star
from .loops.adapt import Adapted, adapt
from .loops.adapt_options import AdaptOptions
from .loops.keeping import KeepOptions, needs_adaptation
from .loops.loop import Loop, LoopError, Step, adapt_loop
from .loops.loop_options import LoopOptions
from .loops.settling import Settled
from .loops.study import Study, convergence_study
from .loops.unsteady import unsteady_loop
from .loops.unsteady_options import UnsteadyOptions
from .meshes.fields import Field
from .meshes.mesh import Mesh
from .meshes.validation import validate
from .meshes.violations import Violation
from .metric import MetricError, MetricOptions
from .objects.after_import import follow_imports
from .remeshing.consistency_options import ConsistencyOptions
from .remeshing.options import RemeshOptions
from .remeshing.remesh import Remeshed, remesh
from .transfer import (
    TransferOptions,
    Transferred,
    transfer,
    transfer_operator,
    transfer_quadrature,
)

__version__ = "0.1.0"

__all__ = [
    "PLC",
    "AdaptOptions",
    "Adapted",
    "Certificate",
    "ConsistencyOptions",
    "FacetOfStar",
    "Field",
    "FormatError",
    "GenerateOptions",
    "Generated",
    "KeepOptions",
    "Loop",
    "LoopError",
    "LoopOptions",
    "Mesh",
    "MeshingError",
    "MetricError",
    "MetricOptions",
    "PLCError",
    "PLCProblem",
    "Region",
    "RemeshOptions",
    "Remeshed",
    "RepairReport",
    "Settled",
    "SimplexOfStar",
    "Step",
    "Study",
    "TransferOptions",
    "Transferred",
    "UnsteadyOptions",
    "Violation",
    "Wrapped",
    "__version__",
    "adapt",
    "adapt_loop",
    "certify",
    "check_plc",
    "convergence_study",
    "explain_star",
    "explain_surface_star",
    "generate",
    "metric",
    "needs_adaptation",
    "progress",
    "read",
    "read_plc",
    "remesh",
    "repaired",
    "transfer",
    "transfer_operator",
    "transfer_quadrature",
    "unsteady_loop",
    "validate",
    "wrap",
    "write",
    "write_plc",
]

follow_imports()

# Rooms that need an optional package, or are seldom needed: imported where they are asked for.
_ROOMS = {"pictures": ".pictures", "series": ".runs.series"}


def __getattr__(name: str) -> ModuleType:
    if name not in _ROOMS:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return importlib.import_module(_ROOMS[name], __name__)


def __dir__() -> list[str]:
    return sorted([*globals(), *_ROOMS])
