"""What is wrong with a complex, named before it is meshed."""

from .check import check_plc
from .error import PLCError, require_valid
from .problem import PLCProblem

__all__ = ["PLCError", "PLCProblem", "check_plc", "require_valid"]
