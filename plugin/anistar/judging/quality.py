"""Edge lengths and element quality in a metric."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..base.arrays import Floats, Ints
from ..base.report import attributes
from ..meshes.mesh import Mesh
from ..meshes.topology import cell_volumes, unique_edges
from ..metric import check_metric
from ..metric.kernels.algebra import lower_factor
from ..metric.kernels.elementary import log, power

#: Bounds of the length of a unit edge.
UNIT = (1 / math.sqrt(2), math.sqrt(2))

# Area and volume of the equilateral simplex with unit edges.
_EQUILATERAL = {2: math.sqrt(3) / 4, 3: math.sqrt(2) / 12}

# Below this relative difference of the end lengths the logarithmic mean loses digits.
_NEARLY_EQUAL = 1e-6


@dataclass(frozen=True, slots=True)
class Quality:
    """How well a mesh fits a metric.

    Attributes
    ----------
    points, cells, edges : int
        Counts.
    unit_edges : float or None
        Fraction of edges with a length in [1/sqrt(2), sqrt(2)]; None without a metric.
    shortest_edge, mean_edge, longest_edge : float
        Lengths in the metric; without one, in mesh units.
    worst_quality, mean_quality : float
        Mean ratio, 1 for the equilateral simplex in the metric.
    """

    points: int
    cells: int
    edges: int
    unit_edges: float | None
    shortest_edge: float
    mean_edge: float
    longest_edge: float
    worst_quality: float
    mean_quality: float

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only; the keys are those of the attributes."""
        return attributes(self)


def quality(mesh: Mesh, M: Floats | None = None) -> Quality:
    """Return the figures of a mesh in a metric.

    Parameters
    ----------
    mesh : Mesh
    M : (n, d, d) float64, optional
        Metric at the points; the identity by default.

    Raises
    ------
    MetricError
        If a tensor is not symmetric positive definite; the point is named.
    """
    is_given = M is not None
    if M is not None:
        M = check_metric(M, n_points=mesh.n_points, dim=mesh.dim)
    else:
        M = np.broadcast_to(np.eye(mesh.dim), (mesh.n_points, mesh.dim, mesh.dim))
    edges = unique_edges(mesh.cells, mesh.n_points)
    lengths, ratios = metric_lengths(mesh, M, edges), mean_ratios(mesh, M)
    unit = (lengths >= UNIT[0]) & (lengths <= UNIT[1])
    return Quality(
        points=mesh.n_points,
        cells=mesh.n_cells,
        edges=len(edges),
        unit_edges=float(unit.mean()) if is_given else None,
        shortest_edge=float(lengths.min()),
        mean_edge=float(lengths.mean()),
        longest_edge=float(lengths.max()),
        worst_quality=float(ratios.min()),
        mean_quality=float(ratios.mean()),
    )


def metric_lengths(mesh: Mesh, M: Floats, edges: Ints) -> Floats:
    """Return the (e,) lengths of edges in a metric that varies geometrically along them.

    The length is ``(l_a - l_b) / ln(l_a / l_b)`` for the lengths in the metrics of the ends [1].

    References
    ----------
    [1] F. Alauzet, Size gradation control of anisotropic meshes, Finite Elements in Analysis and
        Design 46 (2010), section 3.1.
    """
    vectors = mesh.points[edges[:, 1]] - mesh.points[edges[:, 0]]
    a, b = (
        np.sqrt(np.einsum("ei,eij,ej->e", vectors, M[edges[:, end]], vectors)) for end in (0, 1)
    )
    close = np.abs(a - b) <= _NEARLY_EQUAL * (a + b)
    ratio = np.where(close, math.e, a / b)
    return np.asarray(np.where(close, (a + b) / 2, (a - b) / log(ratio)))


def mean_ratios(mesh: Mesh, M: Floats) -> Floats:
    """Return the (m,) mean ratio of each cell, negative where it is inverted.

    ``Q = (V_M / V_unit)^(2/d) / mean(l^2)``, with the metric of the corner whose determinant is
    the largest.
    """
    # Factored: the determinant itself is round-off where a metric is nearly singular.
    densities = np.diagonal(lower_factor(M), axis1=1, axis2=2).prod(axis=1)
    largest = np.argmax(densities[mesh.cells], axis=1)
    densest = mesh.cells[np.arange(mesh.n_cells), largest]
    metric = M[densest]
    volumes = cell_volumes(mesh.points, mesh.cells)
    squares = np.zeros(mesh.n_cells)
    pairs = list(itertools.combinations(range(mesh.dim + 1), 2))
    for i, j in pairs:
        vectors = mesh.points[mesh.cells[:, j]] - mesh.points[mesh.cells[:, i]]
        squares += np.einsum("ci,cij,cj->c", vectors, metric, vectors)
    size = np.abs(volumes) * densities[densest] / _EQUILATERAL[mesh.dim]
    return np.asarray(np.sign(volumes) * power(size, 2 / mesh.dim) * len(pairs) / squares)
