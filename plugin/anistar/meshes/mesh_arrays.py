"""A mesh as the compiled core takes it."""

from __future__ import annotations

import numpy as np

from .. import _core
from .mesh import Mesh


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
