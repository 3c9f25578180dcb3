"""What in the figures of a new mesh should make its reader look again."""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Literal, NamedTuple

from .fidelity import WORTH_A_WARNING
from .long_edges import LONG_EDGE

Level = Literal["", "look", "bad"]


class _Bounds(NamedTuple):
    """Beyond which values a figure is worth a look, and beyond which it is bad."""

    is_beyond: Callable[[float, float], bool]
    look: float
    bad: float


#: By the name of the figure. A curve that keeps to the default Hausdorff number loses less than
#: 0.1 % of its length; nine in ten edges are unit edges in all but the coarsest meshes.
BOUNDS = {
    "change": _Bounds(operator.gt, 1e-3, WORTH_A_WARNING),
    "edge_unit": _Bounds(operator.lt, 0.9, 0.7),
    "edge_max": _Bounds(operator.gt, LONG_EDGE, 2 * LONG_EDGE),
    "q_min": _Bounds(operator.lt, 0.1, 0.01),
    "star_ok": _Bounds(operator.lt, 1.0, 0.9),
}


def level_of(figure: str, value: float | None) -> Level:
    """Return whether a figure is worth a look, bad, or neither.

    Parameters
    ----------
    figure : {"change", "edge_unit", "edge_max", "q_min", "star_ok"}
        Relative change of the measure of a tag, or a figure of `RemeshReport`.
    value : float or None
        None, for what is not known, is neither.
    """
    if value is None:
        return ""
    bounds = BOUNDS[figure]
    size = abs(value) if figure == "change" else value
    if bounds.is_beyond(size, bounds.bad):
        return "bad"
    return "look" if bounds.is_beyond(size, bounds.look) else ""
