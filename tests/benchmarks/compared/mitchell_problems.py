"""Four elliptic problems of Mitchell's collection, by adaptation and by refinement.

W. F. Mitchell, A collection of 2D elliptic problems for testing adaptive grid refinement
algorithms, Applied Mathematics and Computation 220 (2013), sections 2.2, 2.7, 2.8 and 2.9. P1
elements of scikit-fem; with a wind they are stabilised along it (SUPG).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import skfem
from numpy.typing import NDArray
from skfem.helpers import dot, grad

import anistar
from anistar.adapters.skfem import from_skfem, to_skfem

Floats = NDArray[np.float64]
Function = Callable[[Floats, Floats], Floats]
Row = tuple[int, float, float]
"""Vertices, and the error in L2 and in the energy norm."""


@dataclass(frozen=True, kw_only=True)
class Problem:
    """``-div(p grad u) + b . grad u = f``; u is known and given on the boundary."""

    name: str
    first: Callable[[], skfem.MeshTri]
    u: Function
    f: Function
    diffusion: Function = lambda x, y: np.ones_like(x)
    wind: tuple[float, float] = (0.0, 0.0)

    def gradient(self, x: Floats, y: Floats, step: float = 1e-7) -> Floats:
        """Return the gradient of the solution, by central differences."""
        along_x = self.u(x + step, y) - self.u(x - step, y)
        along_y = self.u(x, y + step) - self.u(x, y - step)
        return np.stack([along_x, along_y]) / (2 * step)


def wave_front(steepness: float = 50.0, radius: float = 0.25) -> Problem:
    """Return the wave front well: an arc tangent across a circle inside the unit square."""

    def away(x: Floats, y: Floats) -> tuple[Floats, Floats]:
        r = np.hypot(x - 0.5, y - 0.5) + 1e-14
        return r, steepness * (r - radius)

    def source(x: Floats, y: Floats) -> Floats:
        r, s = away(x, y)
        slope = steepness / (1 + s**2)
        return 2 * s * slope**2 - slope / r

    return Problem(
        name="wave front well, 50",
        first=lambda: skfem.MeshTri().refined(3),
        u=lambda x, y: np.arctan(away(x, y)[1]),
        f=source,
    )


def corner() -> Problem:
    """Return the L-shaped domain with the singularity at its corner."""

    def u(x: Floats, y: Floats) -> Floats:
        from_middle = np.arctan2(x - y, -x - y)  # the domain is 3/8 of a turn to either side
        return np.hypot(x, y) ** (2 / 3) * np.sin(2 / 3 * (from_middle + 0.75 * np.pi))

    return Problem(
        name="re-entrant corner, L",
        first=lambda: skfem.MeshTri.init_lshaped().refined(2),
        u=u,
        f=lambda x, y: np.zeros_like(x),
    )


def boundary_layer(epsilon: float = 1e-3) -> Problem:
    """Return the layers along two sides of a square, with the wind (2, 1)."""

    def parts(x: Floats) -> tuple[Floats, Floats, Floats]:
        falling = np.exp(np.minimum((x - 1) / epsilon, 0.0))
        return 1 - falling, -falling / epsilon, -falling / epsilon**2

    def source(x: Floats, y: Floats) -> Floats:
        (a, da, dda), (b, db, ddb) = parts(x), parts(y)
        wave, slope = np.cos(np.pi * (x + y)), -np.pi * np.sin(np.pi * (x + y))
        bend = -(np.pi**2) * wave
        along_x, along_y = da * b * wave + a * b * slope, a * db * wave + a * b * slope
        laplacian = (dda * b + a * ddb) * wave + 2 * (da * b + a * db) * slope + 2 * a * b * bend
        return -epsilon * laplacian + 2 * along_x + along_y

    return Problem(
        name="boundary layers, 1e-3",
        first=lambda: skfem.MeshTri.init_tensor(*[np.linspace(-1, 1, 9)] * 2),
        u=lambda x, y: parts(x)[0] * parts(y)[0] * np.cos(np.pi * (x + y)),
        f=source,
        diffusion=lambda x, y: np.full_like(x, epsilon),
        wind=(2.0, 1.0),
    )


def interfaces() -> Problem:
    """Return Kellogg's intersecting interfaces: u in H^1.1, as rough as the collection has it."""
    power, ratio, rho, sigma = 0.1, 161.4476387975881, np.pi / 4, -14.92256510455152

    def u(x: Floats, y: Floats) -> Floats:
        angle = np.mod(np.arctan2(y, x), 2 * np.pi)
        quarter = np.minimum(angle // (np.pi / 2), 3).astype(int)
        scale = np.array([np.pi / 2 - sigma, rho, sigma, np.pi / 2 - rho])[quarter]
        shift = np.array([rho - np.pi / 2, sigma - np.pi, -np.pi - rho, -1.5 * np.pi - sigma])
        turned = np.cos(scale * power) * np.cos((angle + shift[quarter]) * power)
        return np.hypot(x, y) ** power * turned

    return Problem(
        name="intersecting interfaces",
        first=lambda: skfem.MeshTri.init_tensor(*[np.linspace(-1, 1, 9)] * 2),
        u=u,
        f=lambda x, y: np.zeros_like(x),
        diffusion=lambda x, y: np.where(x * y > 0, ratio, 1.0),
    )


PROBLEMS = (wave_front, corner, boundary_layer, interfaces)


def solved(problem: Problem, mesh: skfem.MeshTri) -> tuple[skfem.Basis, Floats]:
    """Return the P1 solution with its basis."""
    basis = skfem.Basis(mesh, skfem.ElementTriP1(), intorder=6)
    wind = np.array(problem.wind)

    @skfem.BilinearForm
    def operator(u, v, w):
        along = dot(wind[:, None, None], grad(v))
        carried = dot(wind[:, None, None], grad(u))
        return w.p * dot(grad(u), grad(v)) + carried * (v + w.tau * along)

    @skfem.LinearForm
    def load(v, w):
        f = problem.f(*w.x)
        return f * (v + w.tau * dot(wind[:, None, None], grad(v)))

    middles = mesh.p[:, mesh.t].mean(axis=1)
    p = problem.diffusion(*middles)
    data = {
        "p": basis.with_element(skfem.ElementTriP0()).interpolate(p),
        "tau": basis.with_element(skfem.ElementTriP0()).interpolate(upwind_times(mesh, wind, p)),
    }
    target = problem.u(*mesh.p)
    sides = basis.get_dofs().all()
    system = operator.assemble(basis, **data), load.assemble(basis, **data)
    return basis, skfem.solve(*skfem.condense(*system, x=target, D=sides))


def upwind_times(mesh: skfem.MeshTri, wind: Floats, p: Floats) -> Floats:
    """Return the weight of the stabilisation in each triangle, by its extent along the wind."""
    speed = np.linalg.norm(wind)
    if speed == 0:
        return np.zeros(mesh.nelements)
    gradients = skfem.Basis(mesh, skfem.ElementTriP1(), intorder=1)
    slopes = sum(
        abs(np.tensordot(wind, gradients.basis[k][0].grad[:, :, 0], axes=1)) for k in range(3)
    )
    extent = 2 * speed / slopes
    peclet = speed * extent / (2 * p)
    return np.asarray(extent / (2 * speed) * np.minimum(peclet / 3, 1.0))


def errors(problem: Problem, basis: skfem.Basis, u: Floats) -> tuple[float, float]:
    """Return the error in L2 and in the energy norm."""

    @skfem.Functional
    def in_value(w):
        return (w.u - problem.u(*w.x)) ** 2

    @skfem.Functional
    def in_energy(w):
        away = w.u.grad - problem.gradient(*w.x)
        return problem.diffusion(*w.x) * dot(away, away)

    found = basis.interpolate(u)
    l2, energy = (np.sqrt(form.assemble(basis, u=found)) for form in (in_value, in_energy))
    return float(l2), float(energy)


def adapted(problem: Problem, complexities: tuple[float, ...]) -> list[Row]:
    """Return vertices and errors of the meshes of a loop with the default options."""
    mesh = problem.first()
    p = problem.diffusion(*mesh.p[:, mesh.t].mean(axis=1))
    if len(np.unique(p)) > 1:
        mesh = mesh.with_subdomains({"high": np.flatnonzero(p > p.min())})
    rows: list[Row] = []

    def solve(mesh: anistar.Mesh, fields: dict[str, Floats]) -> dict[str, Floats]:
        basis, u = solved(problem, to_skfem(mesh))
        rows.append((mesh.n_points, *errors(problem, basis, u)))
        return {"u": u}

    options = anistar.LoopOptions(complexities=complexities, settled=None)
    anistar.adapt_loop(solve, from_skfem(mesh), options)
    return rows


def refined(problem: Problem, most: int, *, uniformly: bool = False) -> list[Row]:
    """Return those of refining the triangles with the largest residuals, or all, by scikit-fem."""
    mesh, rows = problem.first(), []
    while not rows or rows[-1][0] < most:
        basis, u = solved(problem, mesh)
        rows.append((mesh.p.shape[1], *errors(problem, basis, u)))
        split = () if uniformly else (worst(residuals(problem, basis, u)),)
        mesh = mesh.refined(*split)
    return rows


def worst(eta: Floats, share: float = 0.5) -> NDArray[np.int64]:
    """Return the fewest triangles that carry a share of the squared residual (Doerfler)."""
    order = np.argsort(eta)[::-1]
    return order[: 1 + int(np.searchsorted(np.cumsum(eta[order]), share * eta.sum()))]


def residuals(problem: Problem, basis: skfem.Basis, u: Floats) -> Floats:
    """Return the squared residual of each triangle, those of its edges included."""
    mesh = basis.mesh
    p = problem.diffusion(*mesh.p[:, mesh.t].mean(axis=1))
    constant = basis.with_element(skfem.ElementTriP0())
    wind = np.array(problem.wind)

    @skfem.Functional
    def inside(w):
        return w.h**2 / w.p * (problem.f(*w.x) - dot(wind[:, None, None], w.u.grad)) ** 2

    @skfem.Functional
    def across(w):
        jump = dot(w.p1 * w.u1.grad - w.p2 * w.u2.grad, w.n)
        return w.h * jump**2 / (w.p1 + w.p2)

    data = {"u": basis.interpolate(u), "p": constant.interpolate(p)}
    eta = inside.elemental(basis, **data)
    sides = [skfem.InteriorFacetBasis(mesh, basis.elem, side=side) for side in (0, 1)]
    two = {f"u{k + 1}": side.interpolate(u) for k, side in enumerate(sides)}
    two |= {
        f"p{k + 1}": side.with_element(skfem.ElementTriP0()).interpolate(p)
        for k, side in enumerate(sides)
    }
    edges = across.elemental(sides[0], **two)
    for side in (0, 1):
        np.add.at(eta, mesh.f2t[side, sides[0].find], edges / 2)
    return np.asarray(eta)
