"""A closed surface around triangles that bound nothing."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ... import _core
from ..geometry.plc import PLC
from ..given import as_plc

#: Openings that are smaller than so many offsets are closed, unless alpha is given.
ALPHA_PER_OFFSET = 20.0


class Wrapped(NamedTuple):
    """A wrap, and how far it is from what is in it.

    Attributes
    ----------
    plc : PLC
        Closed, outward, without crossings.
    distance : float
        The largest distance of its points from the surface.
    """

    plc: PLC
    distance: float


def wrap(surface: Any, offset: float, alpha: float | None = None) -> Wrapped:
    """Wrap a surface that is open, crosses itself or is a mere soup of triangles.

    The wrap is another surface, at the offset from the given one: corners are rounded, tags and
    openings smaller than alpha are lost.

    Parameters
    ----------
    surface : PLC, path, or surface of another package
        In 3D.
    offset : float
        Distance of the wrap from the surface, a length.
    alpha : float, optional
        The wrap enters openings that are wider, and its triangles are about as large. 20 offsets
        by default.

    Returns
    -------
    Wrapped

    References
    ----------
    .. [1] Portaneri, Rouxel-Labbe, Hemmer, Cohen-Steiner, Alliez, Alpha wrapping with an offset,
       2022.
    """
    alpha = ALPHA_PER_OFFSET * offset if alpha is None else alpha
    for name, length in (("offset", offset), ("alpha", alpha)):
        if not (length > 0 and np.isfinite(length)):
            raise ValueError(f"{name} must be a positive length, not {length}")
    given = as_plc(surface)
    if given.dim == 2 or len(given.triangles) == 0:
        raise ValueError("only surfaces in 3D can be wrapped")
    points, triangles, _ = _core.wrap_triangles(
        given.points, given.triangles, float(alpha), float(offset)
    )
    _, distances = _core.nearest_facets3(given.points, given.triangles, points)
    return Wrapped(PLC.from_surface(points, triangles), float(distances.max()))
