"""What a repair has changed."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, kw_only=True)
class RepairReport:
    """What a repair has changed.

    Attributes
    ----------
    repair : str
        Which one it was.
    turned_facets : int
        Facets whose sense was turned.
    one_sided_parts : int
        Parts without two sides, such as Moebius strips: they have no outer side.
    merged_points : int
    dropped_triangles : int
        Without area, thinner than the tolerance, or repeated.
    split_edges : int
        Edges on a border that a point of the border lay on.
    cut_triangles : int
        Triangles that were cut where they met others.
    rounds : int
        Passes over the surface.
    """

    repair: str = "none"
    turned_facets: int = 0
    one_sided_parts: int = 0
    merged_points: int = 0
    dropped_triangles: int = 0
    split_edges: int = 0
    cut_triangles: int = 0
    rounds: int = 0

    def as_dict(self) -> dict[str, Any]:
        """Return the figures by name."""
        return dataclasses.asdict(self)
