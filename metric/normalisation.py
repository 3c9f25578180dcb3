"""Lp normalisation: the metric of least interpolation error at a given complexity."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .algebra import compose, eigh
from .bounds import check_bounds
from .checks import check_tensors
from .complexity import integral_of_exponential
from .mesh import MeshLike, cell_volumes, diameter, point_volumes

Array = NDArray[np.float64]

FLOOR_STEPS = 8
"""Fixed-point steps for the floor; each gains about a digit, and two are enough."""

SMALLEST_FLOOR = 1e-14
"""Floor of the eigenvalues relative to the largest one: below, determinants are round-off."""


def normalised(
    mesh: MeshLike,
    H: Array,
    *,
    target_complexity: float,
    p: float = 2.0,
    h_max: float | Array | None = None,
) -> Array:
    """Scale ``|H|`` to the metric that is optimal in the Lp norm at `target_complexity` [1]_.

    ``M = C^(2/d) (int det|H|^(p/(2p+d)))^(-2/d) det|H|^(-1/(2p+d)) |H|``. A change of the
    unit of the field does not change it.

    Parameters
    ----------
    mesh : MeshLike
        The mesh that carries the Hessian.
    H : ndarray (n, d, d)
        Hessian (or any symmetric tensor); absolute values of its eigenvalues are taken.
    target_complexity : float
        Complexity C of the result.
    p : float
        Norm of the interpolation error to minimise, from 1 to infinity.
    h_max : float or ndarray (n,), optional
        Size of featureless regions: eigenvalues of ``|H|`` are floored where the result would ask
        for larger sizes in all directions. The diagonal of the mesh's bounding box if None.

    Returns
    -------
    ndarray (n, d, d)
        Metric, in 1 / length**2; uniform if `H` is zero everywhere.

    Raises
    ------
    MetricError
        If `H` is not finite or not symmetric.
    ValueError
        If `target_complexity`, `p` or `h_max` is out of range.

    References
    ----------
    .. [1] Loseille, Alauzet, Continuous mesh framework part I, SIAM Journal on Numerical
       Analysis 49, 2011, section 4. Differs from [1]_ by the floor.
    """
    check_normalisation(target_complexity, p)
    n, d = mesh.points.shape
    values, vectors = eigh(check_tensors(H, n_points=n, dim=d, name="Hessian"))
    values = np.abs(values)
    volumes = cell_volumes(mesh)
    featureless = diameter(mesh) if h_max is None else h_max
    _, size, _ = check_bounds(n, h_min=None, h_max=featureless, a_max=None)
    assert size is not None  # it was given
    values = _floored(values, point_volumes(mesh, volumes), target_complexity, p, size)
    log_det = np.log(values).sum(axis=1)
    inner, outer = _exponents(p, d)
    integral = integral_of_exponential(mesh.cells, volumes, inner * log_det)
    factor = (target_complexity / integral) ** (2.0 / d) * np.exp(-outer * log_det)
    return compose(values * factor[:, None], vectors)


def check_normalisation(target_complexity: float, p: float) -> None:
    """Raise ValueError if an argument of `normalised` is out of range."""
    if not (np.isfinite(target_complexity) and target_complexity > 0.0):
        raise ValueError(f"target_complexity must be positive, got {target_complexity}")
    if not p >= 1.0:
        raise ValueError(f"p must be at least 1, got {p}")


def _exponents(p: float, d: int) -> tuple[float, float]:
    """Return the exponents p / (2p + d) and 1 / (2p + d), also for infinite p."""
    return 1.0 / (2.0 + d / p), 1.0 / (2.0 * p + d)


def _floored(values: Array, mass: Array, C: float, p: float, h_max: Array) -> Array:
    """Floor the eigenvalues (n, d) so that regions without features get the size `h_max`.

    Where all eigenvalues equal e the metric is K e^(2p/(2p+d)), so h_max**-2 gives e; K
    depends on the floor through the integral, hence the fixed point. Without a floor, the
    factor det^(-1/(2p+d)) makes one vanishing eigenvalue refine all the other directions.
    """
    largest = float(values.max(initial=0.0))
    if largest == 0.0:
        return np.ones_like(values)
    d = values.shape[1]
    inner, _ = _exponents(p, d)
    relative = values / largest
    floor = np.full((1, 1), SMALLEST_FLOOR)
    for _ in range(FLOOR_STEPS):
        lifted = np.maximum(relative, floor)
        integral = float(np.dot(mass, np.exp(inner * np.log(lifted).sum(axis=1))))
        featureless = (C / integral) ** (-2.0 / d) * h_max**-2.0
        floor = np.clip(featureless ** (1.0 / (2.0 * inner)), SMALLEST_FLOOR, 1.0)
    return np.asarray(largest * np.maximum(relative, floor))
