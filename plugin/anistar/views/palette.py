"""The colours of plots, the same whichever package draws them."""

from __future__ import annotations

import numpy as np

from ..base.arrays import Floats

INK, LINE, ACCENT = "#1d2733", "#4a5a6a", "#c8402f"

# Paul Tol's "light" set, on which dark edges can be seen; what is bad is the last of two.
_CATEGORIES = (
    (0.47, 0.67, 0.87),
    (0.93, 0.53, 0.40),
    (0.93, 0.87, 0.53),
    (1.00, 0.67, 0.73),
    (0.60, 0.87, 1.00),
    (0.27, 0.73, 0.60),
    (0.73, 0.80, 0.20),
    (0.67, 0.67, 0.00),
    (0.80, 0.80, 0.80),
)


def colours_of_categories(count: int) -> Floats:
    """Return (count, 3) colours in [0, 1], again from the first after the ninth."""
    return np.array([_CATEGORIES[k % len(_CATEGORIES)] for k in range(count)])


def colours_of_numbers() -> str:
    """Return the name of the map from numbers to colours, which both packages know."""
    return "viridis"
