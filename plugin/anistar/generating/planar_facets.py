"""The planar facets of a triangle surface."""

from __future__ import annotations

import numpy as np

from .. import _core
from ..base.arrays import Floats, Ints

FLAT_ANGLE = 0.2
"""The largest angle between a triangle and the plane of its facet, in degrees."""

FLATNESS = 1e-6
"""The largest distance of a point from the plane of its facet, in diagonals of the surface."""


def planar_facets(
    points: Floats,
    triangles: Ints,
    tags: Ints,
    *,
    flat_angle: float = FLAT_ANGLE,
    flatness: float = FLATNESS,
) -> Ints:
    """Return the facet of each triangle: neighbours of one tag that lie in one plane.

    A facet grows from its largest triangle, across edges between exactly two triangles, as long as
    these are planar with that first one. Triangles so narrow that the rounding of coordinates may
    tilt them are taken whatever their angle is; those without an area are facets of their own.

    Parameters
    ----------
    points : (n, 3) float64
    triangles : (t, 3) int32
    tags : (t,) int32
    flat_angle : float
        The largest angle to the plane of the first triangle, in degrees.
    flatness : float
        The largest distance from that plane, in diagonals of the surface.

    Returns
    -------
    (t,) int32
        Numbers from 0, in the order of the first triangles.
    """
    if len(triangles) == 0:
        return np.zeros(0, np.int32)
    for name, value in (("flat_angle", flat_angle), ("flatness", flatness)):
        if not 0 <= value < np.inf:
            raise ValueError(f"{name} is {value}, it must be zero or more")
    used = points[triangles.ravel()]
    return _core.planar_facets(
        points,
        triangles,
        tags,
        degrees=flat_angle,
        distance=flatness * diagonal(used),
        rounding=_precision(used) * float(np.abs(used).max()),
    )


def _precision(coordinates: Floats) -> float:
    """Return the relative precision of coordinates: single precision may be stored as double."""
    with np.errstate(over="ignore"):
        is_single = np.array_equal(coordinates, coordinates.astype(np.float32))
    return float(np.finfo(np.float32 if is_single else np.float64).eps)


def diagonal(points: Floats) -> float:
    """Return the diagonal of the box around points."""
    extent = np.ptp(points, axis=0) if len(points) else np.zeros(3)
    return float(np.sqrt((extent * extent).sum()))
