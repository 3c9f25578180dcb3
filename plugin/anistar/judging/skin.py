"""What the facets of a mesh are taken for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

from .. import _core

Shape = Literal["smooth", "polyhedron", "faceted"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Skin:
    """Whether facets sample smooth curves and surfaces or are the domain itself.

    Parameters
    ----------
    shape : "smooth", "polyhedron" or "faceted"
        As in `RemeshOptions`.
    ridge_angle : float
        Degrees; a smooth boundary has a corner (in 3D: a ridge) where it turns by at least this.
    """

    shape: Shape = "smooth"
    ridge_angle: float = 45.0

    def __post_init__(self) -> None:
        if self.shape not in get_args(Shape):
            words = ", ".join(f'"{word}"' for word in get_args(Shape))
            raise ValueError(f"shape must be one of {words}, got {self.shape!r}")
        if not 0 < self.ridge_angle <= 180:
            raise ValueError(f"ridge_angle must be in (0, 180] degrees, got {self.ridge_angle}")

    def as_core(self) -> _core.DomainShape:
        """Return the same for the core."""
        shape = _core.DomainShape()
        shape.kind = _core.ShapeKind[self.shape]
        shape.ridge_angle = self.ridge_angle
        return shape
