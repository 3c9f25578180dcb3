"""Triangles in space that lie in a plane at one height are a mesh in two dimensions."""

from __future__ import annotations

import numpy as np

from ...base.arrays import AnyArray, Floats
from .raw import RawMesh

# Third coordinates that differ by less than this part of the mesh's extent are the same.
PLANAR = 1e-14
# Surfaces that leave their plane by less than this part of their extent are called tilted planes.
_FLAT = 1e-6


def in_dimension(raw: RawMesh, dim: int, used: AnyArray) -> tuple[Floats, float]:
    """Return points with as many coordinates as the mesh has dimensions, and their height.

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
        return points, raw.z if dim == 2 else 0.0
    if points.shape[1] < dim:
        raise ValueError(f"tetrahedra need three coordinates, the points have {points.shape[1]}")
    corners = points[used]
    heights = corners[:, 2]
    size, highest = np.ptp(corners, axis=0).max(initial=0), np.abs(heights).max(initial=0)
    spread = float(np.ptp(heights)) if len(heights) else 0.0
    if spread > PLANAR * max(size, highest):
        raise ValueError(_no_plane(corners, spread))
    z = 0.0 if highest <= PLANAR * size else float(np.median(heights))
    return points[:, :2], z


def _no_plane(corners: Floats, spread: float) -> str:
    """Return why triangles are no mesh in two dimensions."""
    lowest, highest = corners[:, 2].min(), corners[:, 2].max()
    reach = f"z goes from {lowest:.3g} to {highest:.3g}"
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
