"""Values at the boundary, extrapolated from those inside."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from ...base.arrays import Floats
from ...kernels.graph import pair_graph
from ..patches.fit import Cloud, fit_patches
from ..samples.cells import CellGeometry, boundary_facets

EXTRAPOLATION_LEVELS = (2, 3)
"""How often patches are grown. Errors of the values inside are not smooth; lines through two
layers amplify them, on graded meshes by five times as much as lines through three."""

EXTRAPOLATION_PIVOT = 0.03
"""As `SMALLEST_PIVOT`, but for values outside the patch."""


@dataclass(frozen=True, kw_only=True)
class Boundary:
    """The points on the boundary, and the points inside that they can look at.

    Attributes
    ----------
    points : ndarray (n, d)
    rows : ndarray (b,)
        The points on the boundary.
    neighbours : csr_array (n, n)
        The edges near the boundary.
    inner : csr_array (n, n)
        Those of them that end inside.
    """

    points: Floats
    rows: NDArray[np.intp]
    neighbours: sparse.csr_array
    inner: sparse.csr_array

    def extrapolated(self, values: Floats) -> Floats:
        """Replace the values (n, ...) at the boundary by lines through those inside.

        Where the points inside a patch determine no line, their mean is taken; where there are
        none in reach, the value stays. Differs from what is common, copying the mean of the
        neighbours inside, by one order.
        """
        flat = values.reshape(len(values), -1)
        fits = fit_patches(
            self.points,
            Cloud(positions=self.points, values=flat, first=self.inner),
            self.neighbours,
            degree=1,
            rows=self.rows,
            levels=EXTRAPOLATION_LEVELS,
            pivots=(EXTRAPOLATION_PIVOT,),
        )
        result = flat.copy()
        well = fits.level >= 0
        result[self.rows[well]] = fits.value[well]
        missing, reach = self.rows[~well], self.inner
        for _ in range(len(EXTRAPOLATION_LEVELS) + 1):
            count = reach[missing].sum(axis=1)
            found = count > 0
            at = missing[found]
            result[at] = (reach[at] @ flat) / count[found, None]
            missing = missing[~found]
            if missing.size == 0:
                break
            reach = sparse.csr_array(self.neighbours @ reach)
        return result.reshape(values.shape)


def boundary_of(geometry: CellGeometry) -> Boundary:
    """Find the points on the boundary and the edges near it."""
    n = len(geometry.points)
    on_boundary = np.zeros(n, dtype=bool)
    on_boundary[boundary_facets(geometry.cells, n)] = True
    reached, cells = on_boundary.copy(), geometry.cells
    for _ in range(max(EXTRAPOLATION_LEVELS) + 1):
        touched = reached[cells].any(axis=1)
        reached[cells[touched]] = True
    neighbours = pair_graph(n, cells[touched]).matrix()
    inner = neighbours.copy()
    inner.data[on_boundary[inner.indices]] = 0
    inner.eliminate_zeros()
    return Boundary(
        points=geometry.points,
        rows=np.flatnonzero(on_boundary),
        neighbours=neighbours,
        inner=inner,
    )
