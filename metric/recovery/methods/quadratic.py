"""Weighted least squares fits of quadratics through point values or cell means.

References
----------
.. [1] Vallet, Manole, Dompierre, Dufour, Guibault, Numerical comparison of some Hessian
   recovery techniques, International Journal for Numerical Methods in Engineering 72, 2007,
   section 3.3: quadratic fitting.
"""

from __future__ import annotations

import numpy as np
from scipy import sparse

from ...base.arrays import Ints
from ...kernels.graph import VertexGraph
from ..patches.fit import Cloud
from ..samples.cells import CellGeometry
from ..samples.spaces import Samples, cell_nodes


def quadratic_cloud(geometry: CellGeometry, graph: VertexGraph, samples: Samples) -> Cloud:
    """Return what the quadratics are fitted to, by the space of the samples.

    P1: the values at the neighbours in `graph`, through the value at the vertex. P2: those at
    all nodes of the cells around the vertex, through its own. P0: the means over the cells
    around the vertex; the quadratics then have these means.
    """
    n = len(geometry.points)
    if samples.space == "P1":
        return Cloud(
            positions=geometry.points,
            values=samples.columns,
            first=graph.matrix(),
            at_vertices=samples.columns,
        )
    if samples.space == "P2":
        assert samples.edges is not None  # P2 samples have them
        middles = geometry.points[samples.edges].mean(axis=1)
        nodes = np.concatenate(
            [geometry.cells, cell_nodes(geometry.cells, samples.edges, n)], axis=1
        )
        return Cloud(
            positions=np.concatenate([geometry.points, middles]),
            values=samples.columns,
            first=sparse.csr_array(geometry.incidence @ _table(nodes, n + len(middles))),
            at_vertices=samples.columns[:n],
        )
    centroids = geometry.centroids
    corners = geometry.points[geometry.cells] - centroids[:, None]
    count = geometry.cells.shape[1]
    spread = np.einsum("mci,mcj->mij", corners, corners) / (count * (count + 1))
    return Cloud(
        positions=centroids, values=samples.columns, first=geometry.incidence, spread=spread
    )


def _table(members: Ints, n_columns: int) -> sparse.csr_array:
    """Matrix with a one for each entry of `members` (m, c) in its row."""
    m, count = members.shape
    ones = np.ones(m * count, dtype=np.int32)
    offsets = np.arange(0, m * count + 1, count)
    return sparse.csr_array((ones, members.ravel(), offsets), shape=(m, n_columns))
