"""The first mesh: geometry as a piecewise linear complex, and the mesh of it."""

from .given import as_plc
from .plc import PLC
from .region import Region
from .surface_files import SurfaceReport, read_plc, read_plc_with_report, write_plc

__all__ = [
    "PLC",
    "Region",
    "SurfaceReport",
    "as_plc",
    "read_plc",
    "read_plc_with_report",
    "write_plc",
]
