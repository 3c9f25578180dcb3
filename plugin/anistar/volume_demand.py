"""What a metric may ask of a volume mesh: sizes that can be measured, cells that can be stored."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .errors import MeshingError
from .mesh import Mesh
from .metric import MetricError, complexity
from .metric.complexity import REAL_ELEMENTS_PER_COMPLEXITY

#: Edges relative to the extent of the mesh. The determinant of a metric is the sixth power of
#: a length: beyond these, products of a few of them leave the range of double precision.
SMALLEST_SIZE, LARGEST_SIZE = 1e-30, 1e40

#: The four facets of every cell are numbered by 32-bit integers.
MOST_CELLS = 2.0**29


def check_sizes(mesh: Mesh, metric: NDArray[np.float64], scale: float) -> None:
    """Raise if a metric asks for edges that are out of the range of double precision.

    Parameters
    ----------
    mesh : Mesh
    metric : (n, 3, 3) float64
        Positive definite, in scaled coordinates.
    scale : float
        That of the coordinates: the mesh itself is not scaled.

    Raises
    ------
    MetricError
        If the length of an edge along a coordinate axis is not in [1e-30, 1e40] times the
        extent of the mesh; the point is named.
    """
    extent = scale * float(np.ptp(mesh.points, axis=0).max())
    sizes = 1.0 / np.sqrt(np.einsum("nii->ni", metric)) / extent
    bad = np.flatnonzero(((sizes < SMALLEST_SIZE) | (sizes > LARGEST_SIZE)).any(axis=1))
    if bad.size:
        size = sizes[bad[0]]
        worst = size.min() if size.min() < SMALLEST_SIZE else size.max()
        raise MetricError(
            f"metric at point {bad[0]} asks for edges {worst:.1e} times as long as the mesh is "
            f"wide, outside of [{SMALLEST_SIZE:g}, {LARGEST_SIZE:g}]"
        )


def check_count(mesh: Mesh, metric: NDArray[np.float64], scale: float) -> None:
    """Raise if a metric in scaled coordinates asks for more cells than can be numbered.

    Raises
    ------
    MeshingError
        If the complexity of the metric is that of a mesh with more than 2**29 cells.
    """
    box = float((scale * np.ptp(mesh.points, axis=0)).prod())
    # the product of the diagonal bounds the determinant (Hadamard)
    densest = float(np.sqrt(np.einsum("nii->ni", metric).prod(axis=1).max()))
    per_complexity = REAL_ELEMENTS_PER_COMPLEXITY[3]
    if per_complexity * densest * box <= MOST_CELLS:
        return
    n_cells = per_complexity * complexity(mesh, metric) * scale * scale * scale
    if not n_cells <= MOST_CELLS:
        raise MeshingError(
            f"the metric asks for about {n_cells:.1e} cells, more than the {MOST_CELLS:.1e} that "
            "a mesh can have; set h_min or a smaller target, or bound the run by max_vertices"
        )
