"""Fields from one mesh to another: interpolation, projection, and projection within bounds."""

from .location import locator
from .operators import transfer_operator
from .options import METHODS, OUTSIDE, Outside, TransferOptions
from .projection.intersection import Supermesh, supermesh
from .quadrature import transfer_quadrature
from .report import Coverage, FieldChange, TransferReport
from .transfer import Transferred, transfer
from .values.measure import integral
from .values.nodes import node_positions

__all__ = [
    "METHODS",
    "OUTSIDE",
    "Coverage",
    "FieldChange",
    "Outside",
    "Supermesh",
    "TransferOptions",
    "TransferReport",
    "Transferred",
    "integral",
    "locator",
    "node_positions",
    "supermesh",
    "transfer",
    "transfer_operator",
    "transfer_quadrature",
]
