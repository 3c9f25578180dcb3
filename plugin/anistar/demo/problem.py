"""The demo's problem: heat carried through a channel with a step and a round obstacle.

``-eps Laplace(u) + b . grad(u) = 0`` with eps = 1e-3 and a wind of unit speed. The fluid enters
cold, the step and the obstacle are hot, and the wind blows downwards onto a cold floor. The
solution has layers of thickness eps on the step, upstream of the obstacle, on the floor and at the
outlet, layers of thickness sqrt(eps) inside the domain behind the re-entrant corner and on both
sides of the obstacle's wake, and jumps in the boundary values at both ends of the step.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.spatial import Delaunay

from ..base.arrays import AnyArray, Bools, Floats, Ints
from ..base.extras import install_command
from ..meshes.mesh import Mesh
from ..meshes.topology import boundary_facets

try:
    from skfem import (
        Basis,
        BilinearForm,
        ElementTriP0,
        ElementTriP1,
        condense,
    )
    from skfem import (
        solve as solve_linear,
    )
except ImportError as error:
    error.add_note(f"the demo solves with scikit-fem: {install_command('skfem')}")
    raise

from ..adapters.skfem import to_skfem

EPSILON = 1e-3
ANGLE = math.radians(-12.0)
WIND = np.array([math.cos(ANGLE), math.sin(ANGLE)])

LENGTH, HEIGHT = 3.0, 1.0
STEP_LENGTH, STEP_HEIGHT = 0.6, 0.3
CENTRE, RADIUS = np.array([1.1, 0.62]), 0.15
CIRCLE_SEGMENTS = 48

#: Facet tags of the channel and their names.
SIDES = {1: "inlet", 2: "step", 3: "floor", 4: "outlet", 5: "ceiling", 6: "obstacle"}

#: Boundary values by name.
TEMPERATURE = {
    "inlet": 0.0,
    "ceiling": 0.0,
    "outlet": 0.0,
    "floor": 0.0,
    "step": 1.0,
    "obstacle": 1.0,
}


def channel(size: float = 0.08) -> Mesh:
    """Return a coarse mesh of the channel, made of triangles of about the given size.

    Parameters
    ----------
    size : float
        Length of the edges, in mesh units; the circle always has 48 segments.
    """
    outline = _outline(size)
    turns = np.linspace(0.0, 2 * np.pi, CIRCLE_SEGMENTS, endpoint=False)
    circle = CENTRE + RADIUS * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    boundary = np.concatenate([outline, circle])
    points = np.concatenate([boundary, _interior(size, boundary)])
    cells = Delaunay(points).simplices
    centroids = points[cells].mean(axis=1)
    cells = _positive(points, cells[_is_inside(centroids)])
    facets = boundary_facets(cells.astype(np.int32), len(points))
    return Mesh(
        points=points,
        cells=cells,
        facets=facets,
        facet_tags=_side_of(points[facets].mean(axis=1)),
        names={(1, tag): name for tag, name in SIDES.items()},
    )


def solve(mesh: Mesh, fields: dict[str, Any]) -> dict[str, Any]:
    """Return the temperature ``u`` on a mesh of the channel, by stabilised P1 elements (SUPG).

    Parameters
    ----------
    mesh : Mesh
        A mesh with the boundary names of `channel`.
    fields : dict
        Not used: the problem is linear and steady.
    """
    domain = to_skfem(mesh)
    basis = Basis(domain, ElementTriP1())
    tau = basis.with_element(ElementTriP0()).interpolate(upwind_times(mesh))
    A = BilinearForm(_advection_diffusion).assemble(basis, tau=tau)
    u = np.zeros(mesh.n_points)
    fixed = [basis.get_dofs(name).all() for name in TEMPERATURE]
    for dofs, value in zip(fixed, TEMPERATURE.values(), strict=True):
        u[dofs] = value
    return {"u": solve_linear(*condense(A, x=u, D=np.unique(np.concatenate(fixed))))}


def _advection_diffusion(u: Any, v: Any, w: Any) -> Any:
    along = WIND[0] * u.grad[0] + WIND[1] * u.grad[1]
    test = v + w.tau * (WIND[0] * v.grad[0] + WIND[1] * v.grad[1])
    return EPSILON * (u.grad[0] * v.grad[0] + u.grad[1] * v.grad[1]) + along * test


def upwind_times(mesh: Mesh) -> Floats:
    """Return the (m,) SUPG parameter of each cell, from its length along the wind.

    References
    ----------
    T. E. Tezduyar and Y. Osawa, Finite element stabilization parameters computed from element
    matrices and vectors, Comput. Methods Appl. Mech. Engrg. 190 (2000), for the length
    ``2 |b| / sum_i |b . grad(phi_i)|``.
    """
    corners = mesh.points[mesh.cells]
    legs = corners[:, 1:] - corners[:, :1]
    gradients = np.linalg.inv(legs).transpose(0, 2, 1) @ WIND
    first = -gradients.sum(axis=1)
    length = 2.0 / (np.abs(gradients).sum(axis=1) + np.abs(first))
    peclet = length / (2 * EPSILON)
    return np.asarray(length / 2 * (1 / np.tanh(peclet) - 1 / peclet))


def _outline(size: float) -> Floats:
    corners = np.array(
        [
            [STEP_LENGTH, 0.0],
            [LENGTH, 0.0],
            [LENGTH, HEIGHT],
            [0.0, HEIGHT],
            [0.0, STEP_HEIGHT],
            [STEP_LENGTH, STEP_HEIGHT],
        ]
    )
    sides = []
    for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        count = max(1, round(float(np.linalg.norm(end - start)) / size))
        sides.append(start + (end - start) * np.arange(count)[:, None] / count)
    return np.concatenate(sides)


def _interior(size: float, boundary: Floats) -> Floats:
    """Return a triangular lattice, kept off the boundary so that Delaunay keeps its edges."""
    rows = np.arange(0.0, HEIGHT, size * math.sqrt(3) / 2)
    lattice = [
        np.stack(
            [
                np.arange(size / 4 * (1 + 2 * (k % 2)), LENGTH, size),
                np.full_like(np.arange(size / 4 * (1 + 2 * (k % 2)), LENGTH, size), y),
            ],
            axis=1,
        )
        for k, y in enumerate(rows)
    ]
    points = np.concatenate(lattice)
    gaps = np.linalg.norm(points[:, None] - boundary[None], axis=2).min(axis=1)
    return points[_is_inside(points) & (gaps > 0.6 * size)]


def _is_inside(x: Floats) -> Bools:
    in_step = (x[:, 0] < STEP_LENGTH) & (x[:, 1] < STEP_HEIGHT)
    in_circle = np.linalg.norm(x - CENTRE, axis=1) < RADIUS
    return np.asarray(~(in_step | in_circle))


def _positive(points: Floats, cells: AnyArray) -> AnyArray:
    legs = points[cells[:, 1:]] - points[cells[:, :1]]
    return np.where((np.linalg.det(legs) < 0)[:, None], cells[:, [0, 2, 1]], cells)


def _side_of(middles: Floats) -> Ints:
    x, y = middles.T
    tags = np.full(len(middles), 2, np.int32)
    tags[x == 0] = 1
    tags[y == 0] = 3
    tags[x == LENGTH] = 4
    tags[y == HEIGHT] = 5
    tags[np.linalg.norm(middles - CENTRE, axis=1) < 1.01 * RADIUS] = 6
    return tags
