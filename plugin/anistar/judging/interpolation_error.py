"""L2 errors of P1 fields: estimated from the Hessian and the noise, or by an exact function."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats
from ..meshes.fields import Field
from ..meshes.mesh import Mesh
from ..meshes.topology import cell_volumes
from ..metric.recovery import hessian_and_noise

ExactFunction = Callable[[Floats], ArrayLike]

# The four Gauss-Legendre points of (-1, 1) and their weights, for each direction of the collapsed
# cube: exact to degree 5.
_INNER, _OUTER = (math.sqrt(3 / 7 + sign * 2 / 7 * math.sqrt(6 / 5)) for sign in (-1, 1))
_GAUSS_POINTS = np.array([-_OUTER, -_INNER, _INNER, _OUTER])
_GAUSS_WEIGHTS = (18 + np.array([-1, 1, 1, -1]) * math.sqrt(30)) / 36


def interpolation_error(mesh: Mesh, u: ArrayLike, *, on: str = "points") -> float:
    """Estimate the L2 norm of the P1 interpolation error of the function behind `u`.

    The Hessian H is recovered at the vertices and taken constant, at its mean, in each cell K.
    For a quadratic function the interpolation error is ``-1/2 sum_{i<j} b_i b_j q_ij`` with
    ``q_ij = e_ij^T H e_ij`` for the edge vectors and barycentric coordinates b, so its L2 norm
    over K follows from the moments of b, with no constant to choose. In cells of unit size in a
    metric M aligned with H this is the continuous model ``c trace(M^{-1/2} |H| M^{-1/2})`` [1].
    What noise can explain is damped out of H, so that the error that it makes is added.

    Parameters
    ----------
    mesh : Mesh
        The mesh that carries the field.
    u : (n,) or (m,) float array
        Values at the points, or means over the cells, in units U.
    on : {"points", "cells"}
        Which of them. The error of cell means is that of the P1 function with the same vertices
        as the function that they are means of, which is what the metric makes small; the means
        themselves are a first-order approximation of it.

    Returns
    -------
    float
        In U times the square root of the mesh's area or volume unit.

    Notes
    -----
    Independent noise of standard deviation s at the points is ``sum_i b_i n_i`` in a cell, whose
    expected square has the mean ``s^2 (d + 1) E[b_0^2] = 2 s^2 / (d + 2)``. The noise of the
    values is taken from what quadratics leave unexplained, see `recovery_confidence`, and its
    square over the domain is added to that of the interpolation error. So no estimate falls below
    what the noise of the solver allows, however fine the mesh; that of a clean field has none.
    For cell means it is the noise of a P1 function with that of the means at its points.

    References
    ----------
    [1] A. Loseille and F. Alauzet, Continuous mesh framework part I: well-posed continuous
        interpolation error, SIAM J. Numer. Anal. 49 (2011), section 3.
    """
    values = np.asarray(u, dtype=np.float64)
    # A power of two keeps squares of huge and tiny values in range, and changes no digit.
    scale = math.ldexp(1.0, math.frexp(float(np.abs(values).max()))[1])
    space = "P0" if on == "cells" else "P1"
    hessian, noise = hessian_and_noise(mesh, values / scale, space=space)
    in_cells = hessian[mesh.cells].mean(axis=1)
    pairs = list(itertools.combinations(range(mesh.dim + 1), 2))
    corners = mesh.points[mesh.cells]
    edges = np.stack([corners[:, j] - corners[:, i] for i, j in pairs], axis=1)
    stretch = np.einsum("cei,cij,cej->ce", edges, in_cells, edges)
    mean_square = 0.25 * np.einsum("ce,ef,cf->c", stretch, _pair_moments(pairs), stretch)
    of_noise = 2.0 * noise * noise / (mesh.dim + 2)
    return scale * math.sqrt(_integral(mesh, mean_square + of_noise))


def field_error(mesh: Mesh, field: Field) -> float:
    """Estimate the L2 norm of the interpolation error of a scalar or vector field.

    Parameters
    ----------
    mesh : Mesh
        The mesh that carries the field.
    field : Field
        On points or cells; the squares of the components are added.
    """
    columns = field.values.reshape(len(field.values), -1).T
    errors = np.array([interpolation_error(mesh, column, on=field.on) for column in columns])
    largest = float(errors.max())
    # Relative to the largest, whose square may be out of range.
    return largest * math.sqrt(float(np.square(errors / largest).sum())) if largest > 0 else largest


def _integral(mesh: Mesh, means: Floats) -> float:
    """Return the integral of a function with the given (m,) means over the cells."""
    return float((means * cell_volumes(mesh.points, mesh.cells)).sum())


def _pair_moments(pairs: list[tuple[int, int]]) -> Floats:
    """Return the means over a simplex of ``b_i b_j b_k b_l`` for all pairs (i, j), (k, l)."""
    dim = max(j for _, j in pairs)
    moments = np.empty((len(pairs), len(pairs)))
    for row, first in enumerate(pairs):
        for column, second in enumerate(pairs):
            powers = np.bincount([*first, *second])
            numerator = math.factorial(dim) * math.prod(math.factorial(p) for p in powers)
            moments[row, column] = numerator / math.factorial(dim + 4)
    return moments


def l2_error(mesh: Mesh, u: ArrayLike, exact: ExactFunction) -> float:
    """Return the L2 norm of the P1 field `u` minus an exact function, by quadrature.

    Parameters
    ----------
    mesh : Mesh
        The mesh that carries the field.
    u : (n,) float array
        Values at the points.
    exact : callable
        Takes (q, d) points, returns (q,) values.
    """
    values = np.asarray(u, dtype=np.float64)
    weights, barycentric = simplex_rule(mesh.dim)
    corners, nodal = mesh.points[mesh.cells], values[mesh.cells]
    mean_square = np.zeros(mesh.n_cells)
    for weight, b in zip(weights, barycentric, strict=True):
        x = np.einsum("k,ckd->cd", b, corners)
        error = np.einsum("ck,k->c", nodal, b) - np.asarray(exact(x), dtype=np.float64)
        mean_square += weight * np.square(error)
    return math.sqrt(_integral(mesh, mean_square))


def simplex_rule(dim: int) -> tuple[Floats, Floats]:
    """Return a quadrature rule on the simplex: a Gauss rule on the cube, collapsed.

    Returns
    -------
    weights : (q,) float64
        They sum to 1.
    barycentric : (q, d + 1) float64
        All inside, none on the boundary.
    """
    grids = np.meshgrid(*[(_GAUSS_POINTS + 1) / 2] * dim, indexing="ij")
    scales = np.meshgrid(*[_GAUSS_WEIGHTS / 2] * dim, indexing="ij")
    t = np.stack([grid.ravel() for grid in grids], axis=1)
    mass = np.prod([scale.ravel() for scale in scales], axis=0)
    barycentric, rest = np.empty((len(t), dim + 1)), np.ones(len(t))
    for axis in range(dim):
        barycentric[:, axis] = rest * t[:, axis]
        mass = mass * rest  # the cross-section that this direction collapses
        rest = rest * (1 - t[:, axis])
    barycentric[:, dim] = rest
    return mass / mass.sum(), barycentric


def l2_norm(mesh: Mesh, u: ArrayLike) -> float:
    """Return the L2 norm of a P1 field, exactly.

    Parameters
    ----------
    mesh : Mesh
        The mesh that carries the field.
    u : (n,) float array
        Values at the points.
    """
    nodal = np.asarray(u, dtype=np.float64)[mesh.cells]
    # The mean of b_i b_j over a simplex is (1 + delta_ij) / ((d + 1) (d + 2)).
    squares = np.square(nodal).sum(axis=1) + np.square(nodal.sum(axis=1))
    scale = (mesh.dim + 1) * (mesh.dim + 2)
    return math.sqrt(_integral(mesh, squares) / scale)
