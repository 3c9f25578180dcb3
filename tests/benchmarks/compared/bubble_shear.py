"""A bubble that a shear flow draws out and back: Animate's demonstration, with anistar's windows.

The problem, the scheme and its parameters are those of that page (published as bubble_shear in its
demos): a disk of tracer in a flow that turns back after half a period, P1 elements stabilised
along the flow, 300 steps by Crank and Nicolson. The exact solution at the end is the beginning.
"""

from __future__ import annotations

import numpy as np
import skfem
from mitchell_problems import Floats
from skfem.helpers import dot, grad
from skfem.models.poisson import mass

import anistar
from anistar.adapters.skfem import from_skfem, to_skfem
from anistar.metric import mesh_edges

PERIOD, STEP, N_STEPS = 6.0, 0.01, 300
DIFFUSIVITY = 0.1  # of the stabilisation alone
COMPLEXITY, WINDOWS = 1500, 15


def disk(points: Floats) -> Floats:
    """Return the tracer at the beginning."""
    return (np.hypot(points[:, 0] - 0.5, points[:, 1] - 0.65) < 0.15).astype(float)


def velocity(x: Floats, y: Floats, time: float) -> Floats:
    """Return the flow at a time."""
    along_x = 2 * np.sin(np.pi * x) ** 2 * np.sin(2 * np.pi * y)
    along_y = -np.sin(2 * np.pi * x) * np.sin(np.pi * y) ** 2
    return np.stack([along_x, along_y]) * np.cos(2 * np.pi * time / PERIOD)


@skfem.BilinearForm
def implicit(c, v, w):
    """Integrate the unknown half of a step."""
    carried = dot(w.new, grad(c))
    return (c + 0.5 * STEP * carried) * (v + w.tau * dot(w.new, grad(v)))


@skfem.LinearForm
def explicit(v, w):
    """Integrate the known half of a step."""
    carried = dot(w.old, w.c.grad)
    return (w.c - 0.5 * STEP * carried) * (v + w.tau * dot(w.new, grad(v)))


def advance(
    mesh: anistar.Mesh, fields: dict[str, Floats], begin: float, end: float
) -> dict[str, Floats]:
    """Return the tracer after a step."""
    basis = skfem.Basis(to_skfem(mesh), skfem.ElementTriP1())
    x, y = basis.global_coordinates()
    old, new = velocity(x, y, begin), velocity(x, y, end)
    speed = np.maximum(np.linalg.norm(new, axis=0), 1e-12)
    h = np.asarray(basis.interpolate(edge_lengths(mesh)))
    data = {"old": old, "new": new, "c": basis.interpolate(fields["c"])}
    data["tau"] = np.minimum(0.5 * h / speed, speed * h / (6 * DIFFUSIVITY))
    system = implicit.assemble(basis, **data), explicit.assemble(basis, **data)
    return {"c": skfem.solve(*skfem.condense(*system, D=basis.get_dofs().all()))}


def edge_lengths(mesh: anistar.Mesh) -> Floats:
    """Return the mean length of the edges at each point."""
    ends = mesh_edges(mesh)
    lengths = np.linalg.norm(mesh.points[ends[:, 0]] - mesh.points[ends[:, 1]], axis=1)
    total, count = np.zeros((2, mesh.n_points))
    for end in ends.T:
        np.add.at(total, end, lengths)
        np.add.at(count, end, 1.0)
    return total / count


def run(windows: int = WINDOWS, n_steps: int = N_STEPS) -> tuple[float, float]:
    """Return the mean number of vertices, and the relative error in L2 at the end."""
    first = from_skfem(skfem.MeshTri.init_tensor(*[np.linspace(0, 1, 33)] * 2))
    options = anistar.UnsteadyOptions(
        adapt=anistar.AdaptOptions.from_dict(
            {"target_complexity": COMPLEXITY, "h_min": 1e-4, "h_max": 1.0}
        ),
        window=n_steps // windows,
        passes=1,
        keep=None,
    )
    times = STEP * np.arange(n_steps + 1)
    done = anistar.unsteady_loop(advance, first, lambda m: {"c": disk(m.points)}, times, options)
    points = [window.points for window in done.windows]
    return float(np.mean(points)), relative_error(done.last.mesh, done.last.fields["c"])


def relative_error(mesh: anistar.Mesh, c: Floats) -> float:
    """Return the L2 norm of the difference to the disk at the points, over that of the disk."""
    basis = skfem.Basis(to_skfem(mesh), skfem.ElementTriP1())
    exact = disk(mesh.points)
    M = mass.assemble(basis)
    away = c - exact
    return float(np.sqrt((away @ (M @ away)) / (exact @ (M @ exact))))
