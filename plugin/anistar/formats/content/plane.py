"""Triangles in space that lie in a plane at one height are a mesh in two dimensions."""

from __future__ import annotations

import numpy as np

from ...base.arrays import AnyArray, Floats
from .raw import RawMesh

# Third coordinates that differ by less than this part of the mesh's extent are the same, for
# numbers of double and of single precision: what is left after a mesh was turned away and back.
_ROUNDING: dict[type[np.floating], float] = {np.float64: 1e-10, np.float32: 1e-6}
# A height below this part of the extent is zero.
_LEAST_HEIGHT = 1e-14
# Surfaces that leave their plane by less than this part of their extent are called tilted planes.
_FLAT = 1e-6


def in_dimension(raw: RawMesh, dim: int, used: AnyArray) -> tuple[Floats, float, list[str]]:
    """Return points with as many coordinates as the mesh has dimensions, their height, and notes.

    Parameters
    ----------
    raw : RawMesh
    dim : int
        That of its cells.
    used : (k,) int array
        Points of cells; others may be anywhere.

    Raises
    ------
    ValueError
        If the cells are no mesh in two dimensions; says in which plane they lie, if they do.
    """
    points = np.asarray(raw.points, np.float64)
    if points.shape[1] == dim:
        return points, raw.z if dim == 2 else 0.0, []
    if points.shape[1] < dim:
        raise ValueError(f"tetrahedra need three coordinates, the points have {points.shape[1]}")
    corners = points[used]
    heights = corners[:, 2]
    size, highest = np.ptp(corners, axis=0).max(initial=0), np.abs(heights).max(initial=0)
    spread = float(np.ptp(heights)) if len(heights) else 0.0
    is_zero = highest <= max(spread, _LEAST_HEIGHT * size)
    z = 0.0 if is_zero else float(np.median(heights))
    notes = []
    if spread > 0:
        scale = max(size, highest)
        if spread > (rounding := _rounding_of(corners) * scale):
            raise ValueError(_no_plane(corners, spread, rounding))
        notes.append(
            f"z varies by {spread:.3g}, {spread / scale:.2g} of the extent: z = {z:g} is taken"
        )
    return points[:, :2], z, notes


def _rounding_of(coordinates: Floats) -> float:
    """Return the part of the extent that is rounding; single precision may be stored as double."""
    with np.errstate(over="ignore"):
        is_single = np.array_equal(coordinates, coordinates.astype(np.float32))
    return _ROUNDING[np.float32 if is_single else np.float64]


def _no_plane(corners: Floats, spread: float, rounding: float) -> str:
    """Return why triangles are no mesh in two dimensions."""
    lowest, highest = corners[:, 2].min(), corners[:, 2].max()
    reach = f"z goes from {lowest:.3g} to {highest:.3g}"
    if spread <= _FLAT * np.ptp(corners, axis=0).max():
        return (
            f"it is not quite a plane of one z: z varies by {spread:.3g}, more than the "
            f"{rounding:.3g} that are rounding; give all points the same z"
        )
    centred = corners - corners.mean(axis=0)
    _, extents, axes = np.linalg.svd(centred, full_matrices=False)
    if extents[-1] <= _FLAT * extents[0]:
        normal = axes[-1] * np.sign(axes[-1][np.abs(axes[-1]).argmax()])
        listed = ", ".join(f"{x + 0.0:.3g}" for x in normal.round(6))
        return (
            f"it is a plane that is tilted: {reach}, its normal is ({listed}); turn it so that z "
            "is the same everywhere, which may be any height"
        )
    return (
        f"it is a surface mesh in 3D, which is not supported: {reach}; a mesh in 2D has one z, and "
        "a mesh in 3D has tetrahedra"
    )
