"""The user's own geometry, as the compiled core asks for it: point by point."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

Project = Callable[[NDArray[np.float64], int], ArrayLike]
"""``project(points, facet_tag)``: the (k, d) points moved onto the user's geometry."""


def pointwise(project: Project, scale: float) -> Callable[..., tuple[float, ...]]:
    """Return a function of the coordinates of one scaled point and a tag.

    It calls the user's vectorised projection, and raises ValueError if that does not return
    finite points of the same shape.
    """

    def at(*coordinates_and_tag: float) -> tuple[float, ...]:
        *x, tag = coordinates_and_tag
        moved = np.asarray(project(np.array([x]) / scale, int(tag)), dtype=np.float64)
        if moved.shape != (1, len(x)) or not np.isfinite(moved).all():
            shape = (1, len(x))
            raise ValueError(f"project must return finite points of shape {shape}, got {moved!r}")
        return tuple(float(coordinate) * scale for coordinate in moved[0])

    return at
