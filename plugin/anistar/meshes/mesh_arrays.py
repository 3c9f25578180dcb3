"""A mesh as the compiled core takes it."""

from __future__ import annotations

import numpy as np

from .. import _core
from ..base.arrays import Floats
from .mesh import Mesh


def unit_scale(points: Floats) -> float:
    """Return the power of two that brings the extent of the points to about one.

    The core then computes with the same numbers whatever the unit of length, as long as units
    differ by powers of two. One, where all points are one.
    """
    extent = float(np.ptp(points, axis=0).max())
    return float(np.ldexp(1.0, -int(np.frexp(extent)[1]))) if extent > 0.0 else 1.0


def mesh_arrays(mesh: Mesh, *, scale: float = 1.0) -> _core.MeshArrays:
    """Return the arrays of a mesh, the points times `scale`.

    The core knows regions by the rank of their tag, so that every tag is one, and -1 the outside.
    """
    ranks = np.unique(mesh.cell_tags, return_inverse=True)[1]
    return _core.MeshArrays(
        points=mesh.points * scale,
        cells=mesh.cells,
        cell_tags=ranks.astype(np.int32),
        facets=mesh.facets,
        facet_tags=mesh.facet_tags,
        edges=mesh.edges,
        edge_tags=mesh.edge_tags,
        corners=mesh.corners,
    )
