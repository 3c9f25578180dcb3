"""The first mesh: geometry as a piecewise linear complex, and the mesh of it."""

from .plc import PLC
from .region import Region

__all__ = ["PLC", "Region"]
