"""Sizes that a metric may ask of a mesh: those that can be measured."""

from __future__ import annotations

import numpy as np

from ..base.arrays import Floats
from ..meshes.mesh import Mesh
from ..metric import MetricError

#: Edges relative to the extent of the mesh. The determinant of a metric is the sixth power of
#: a length: beyond these, products of a few of them leave the range of double precision.
SMALLEST_SIZE, LARGEST_SIZE = 1e-30, 1e30


def check_sizes(mesh: Mesh, metric: Floats, scale: float) -> None:
    """Raise if a metric asks for edges that are out of the range of double precision.

    Parameters
    ----------
    mesh : Mesh
    metric : (n, d, d) float64
        Positive definite, in scaled coordinates.
    scale : float
        That of the coordinates: the mesh itself is not scaled.

    Raises
    ------
    MetricError
        If the length of an edge along a coordinate axis is not in [1e-30, 1e30] times the
        extent of the mesh; the point is named.
    """
    extent = scale * float(np.ptp(mesh.points, axis=0).max())
    with np.errstate(divide="ignore"):  # a metric may have left the range when it was scaled
        sizes = 1.0 / np.sqrt(np.einsum("nii->ni", metric)) / extent
    bad = np.flatnonzero(((sizes < SMALLEST_SIZE) | (sizes > LARGEST_SIZE)).any(axis=1))
    if bad.size:
        size = sizes[bad[0]]
        worst = size.min() if size.min() < SMALLEST_SIZE else size.max()
        raise MetricError(
            f"metric at point {bad[0]} asks for edges {worst:.1e} times as long as the mesh is "
            f"wide, outside of [{SMALLEST_SIZE:g}, {LARGEST_SIZE:g}]"
        )
