"""Metrics from error indicators of the cells, as goal-oriented estimators give them."""

from __future__ import annotations

import numpy as np
import scipy  # loads scipy.optimize, 9 MB, when it is first used
from numpy.typing import ArrayLike

from ..base.arrays import Floats
from ..base.mesh import AnyMesh, MeshLike, as_mesh, cell_volumes, diameter
from ..kernels.algebra import absolute, eigh
from ..kernels.elementary import exp, log, power
from ..kernels.spectra import compose
from ..laws.bounds import bounded
from ..laws.complexity import complexity
from ..laws.normalisation import SMALLEST_FLOOR, check_target
from ..tensors.checks import check_tensors

LARGEST_STEP = 60.0
"""Largest logarithm of the factor on the density that is tried, in either direction."""


def dwr_metric(
    mesh: AnyMesh,
    indicators: ArrayLike,
    *,
    target_complexity: float,
    H: Floats | None = None,
    order: float = 2.0,
    h_max: float | Floats | None = None,
) -> Floats:
    """Metric whose density equidistributes error indicators, and whose shape is a Hessian's.

    Let the indicator e of a cell of volume V belong to an error that falls like h^order, so like
    V^a with a = order / d. The sum of the indicators for a given number of cells is smallest when
    cells have the density ``e^(1 / (a + 1)) / V`` [1]_. Sizes follow from it where no Hessian is
    given; else the ratios of the sizes, and their directions, are those of ``|H|`` [1]_.

    Parameters
    ----------
    mesh : MeshLike or other mesh object
        The mesh whose cells were estimated.
    indicators : array_like (m,)
        Share of each cell in the error, for instance of a dual weighted residual. Absolute
        values are taken, and the unit has no influence.
    target_complexity : float
        Complexity of the result.
    H : ndarray (n, d, d), optional
        Hessian for the shape: of the solution, or a `weighted_hessian`. None is isotropic.
    order : float
        Order in h of the error in the output. It is 2 for linear elements.
    h_max : float or ndarray (n,), optional
        Largest size. The diagonal of the mesh's bounding box if None.

    Returns
    -------
    ndarray (n, d, d)
        Metric at the points, in 1 / length**2; uniform if all indicators are zero.

    Raises
    ------
    MetricError
        If `H` is not finite or not symmetric.
    ValueError
        If an indicator is not finite, an argument is out of range, or `h_max` alone makes the
        complexity larger than the target.

    References
    ----------
    .. [1] Carpio, Prieto, Bermejo, Anisotropic "goal-oriented" mesh adaptivity for elliptic
       problems, SIAM Journal on Scientific Computing 35, 2013, section 4.
    """
    mesh = as_mesh(mesh)
    check_target("target_complexity", target_complexity)
    if not (np.isfinite(order) and order > 0.0):
        raise ValueError(f"order must be positive, got {order}")
    d = mesh.points.shape[1]
    errors = _checked(indicators, len(mesh.cells))
    density = _density(mesh, power(errors, 1.0 / (order / d + 1.0)))
    base = power(density, 2.0 / d)[:, None, None] * _shapes(mesh, H)
    largest = diameter(mesh) if h_max is None else h_max

    def scaled(log_factor: float) -> Floats:
        return bounded(exp(2.0 * log_factor / d) * base, h_max=largest)

    def excess(log_factor: float) -> float:
        return log(complexity(mesh, scaled(log_factor)) / target_complexity)

    start = log(target_complexity / complexity(mesh, base))
    if excess(start - LARGEST_STEP) >= 0.0:
        raise ValueError(
            f"target_complexity {target_complexity:g} is out of reach: h_max alone makes "
            f"{complexity(mesh, scaled(start - LARGEST_STEP)):g}"
        )
    # h_max can only add to the complexity: up to round-off, the factor is at most that of `base`
    found: float = scipy.optimize.brentq(excess, start - LARGEST_STEP, start + 1.0, xtol=1e-10)
    return scaled(found)


def _checked(indicators: ArrayLike, n_cells: int) -> Floats:
    """Absolute indicators relative to the largest; ones where all are zero."""
    errors = np.abs(np.asarray(indicators, dtype=np.float64))
    if errors.shape != (n_cells,):
        raise ValueError(f"indicators have shape {errors.shape}, but the mesh has {n_cells} cells")
    bad = np.flatnonzero(~np.isfinite(errors))
    if bad.size:
        raise ValueError(f"indicator of cell {bad[0]} is not finite: {errors[bad[0]]}")
    largest = float(errors.max(initial=0.0))
    return errors / largest if largest > 0.0 else np.ones_like(errors)


def _density(mesh: MeshLike, counts: Floats) -> Floats:
    """Cells per volume at the points, from the number that each cell should become."""
    n, corners = len(mesh.points), mesh.cells.shape[1]
    around = mesh.cells.ravel()
    wanted = np.bincount(around, np.repeat(counts, corners), minlength=n)
    volumes = np.bincount(around, np.repeat(cell_volumes(mesh), corners), minlength=n)
    density = wanted / volumes
    return np.asarray(np.maximum(density, SMALLEST_FLOOR * density.max()))


def _shapes(mesh: MeshLike, H: Floats | None) -> Floats:
    """Tensors (n, d, d) of determinant one."""
    n, d = mesh.points.shape
    if H is None:
        return np.broadcast_to(np.eye(d), (n, d, d))
    values, vectors = eigh(absolute(check_tensors(H, n_points=n, dim=d, name="Hessian")))
    largest = values.max(axis=1, keepdims=True)
    values = np.where(largest > 0.0, values / np.where(largest > 0.0, largest, 1.0), 1.0)
    values = np.maximum(values, SMALLEST_FLOOR)
    return compose(values / power(np.prod(values, axis=1, keepdims=True), 1.0 / d), vectors)
