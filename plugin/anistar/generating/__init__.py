"""The first mesh: geometry as a piecewise linear complex, and the mesh of it."""

from .checking import PLCError, PLCProblem, check_plc
from .generate import generate
from .given import as_plc
from .options import GenerateOptions
from .plc import PLC
from .region import Region
from .repairing import RepairReport, Wrapped, repaired, wrap
from .result import Generated
from .surface_files import SurfaceReport, read_plc, read_plc_with_report, write_plc

__all__ = [
    "PLC",
    "GenerateOptions",
    "Generated",
    "PLCError",
    "PLCProblem",
    "Region",
    "RepairReport",
    "SurfaceReport",
    "Wrapped",
    "as_plc",
    "check_plc",
    "generate",
    "read_plc",
    "read_plc_with_report",
    "repaired",
    "wrap",
    "write_plc",
]
