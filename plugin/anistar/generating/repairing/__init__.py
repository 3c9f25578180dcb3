"""Repairs of a complex, each a step that is asked for."""

from .repair import REPAIRS, repaired
from .report import RepairReport
from .wrapping import Wrapped, wrap

__all__ = ["REPAIRS", "RepairReport", "Wrapped", "repaired", "wrap"]
