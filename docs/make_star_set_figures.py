"""Print the tables of certificate.md about star sets in space, and make its pictures.

Run it in the folder of the repository; it takes some minutes::

    python docs/make_star_set_figures.py docs/images
"""

from __future__ import annotations

import dataclasses
import itertools
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

import anistar
from anistar.pictures import volume_picture
from anistar.remeshing.consistency_options import ConsistencyOptions

Float = NDArray[np.float64]
Field = Callable[[Float], Float]

PIXELS, COLOURS = 640, 64
SIZED = ConsistencyOptions(rho_0=2, max_growth=9)
# the ball of Figure 8: only inconsistencies refine
UNBOUNDED = ConsistencyOptions(alpha_0=np.inf, rho_0=3, max_growth=1e4)
WIDTHS = {"slow": 1.0, "fast": 0.3}
ANGLES = (75, 60, 45, 30)


@dataclass(frozen=True, kw_only=True)
class Case:
    """A metric on a domain, and the parameters of the star set."""

    name: str
    mesh: anistar.Mesh
    field: Field
    rules: ConsistencyOptions = SIZED


def diagonal(sizes: Float) -> Float:
    """Return metrics with these sizes (n, 3) along the axes."""
    return np.asarray(np.eye(3) * sizes[:, None, :] ** -2.0)


def uniform(size: float) -> Field:
    """Return one size everywhere."""
    return lambda x: diagonal(np.full((len(x), 3), size))


def linear(x: Float) -> Float:
    """Return the metric of the case 3d-linear of the UGAWG at complexity 1000, in [0, 1]^3."""
    across = 0.001 + 0.198 * np.abs(x[:, 2] - 0.5)
    along = np.full(len(x), 0.1)
    return diagonal(4.6517 ** (1 / 3) * np.stack([along, along, across], axis=1))


def linear_in_ball(x: Float) -> Float:
    """Return the same in [-1, 1]^3."""
    return linear(0.5 * (x + 1)) / 4


def crossed(width: float) -> Field:
    """Return what is stretched four times along x on the left, along z on the right."""

    def metric(x: Float) -> Float:
        right = 0.5 * (1 + np.tanh(x[:, 0] / width))
        one = np.ones_like(right)
        return diagonal(0.5 * np.stack([4 ** (1 - right), one, 4**right], axis=1))

    return metric


def box(*axes: Float) -> anistar.Mesh:
    """Return the product of three axes, six tetrahedra to a box."""
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    rows = np.arange(points[..., 0].size).reshape(points.shape[:3])
    low = rows[:-1, :-1, :-1].ravel()
    steps = rows[1, 0, 0], rows[0, 1, 0], rows[0, 0, 1]
    cells = []
    for order in itertools.permutations(range(3)):
        corners = low[:, None] + np.cumsum([0, *(steps[axis] for axis in order)])
        is_even = order in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
        cells.append(corners if is_even else corners[:, [0, 1, 3, 2]])
    return anistar.Mesh(points=points.reshape(-1, 3), cells=np.concatenate(cells))


def cube(n: int) -> anistar.Mesh:
    """Return the unit cube."""
    return box(*3 * [np.linspace(0, 1, n + 1)])


def ball(*axes: Float) -> anistar.Mesh:
    """Return the unit ball, from a lattice of the cube [-1, 1]^3."""
    lattice = box(*axes)
    points = lattice.points
    length = np.linalg.norm(points, axis=1)
    size = np.abs(points).max(axis=1)
    factor = np.divide(size, length, out=np.ones_like(size), where=length > 0)
    return anistar.Mesh(points=points * factor[:, None], cells=lattice.cells)


def even(n: int) -> Float:
    """Return an axis of n equal steps."""
    return np.linspace(-1, 1, n + 1)


def graded_to_middle(n: int) -> Float:
    """Return an axis of n steps, finest at 0."""
    t = even(n)
    return np.asarray(np.sign(t) * np.expm1(4 * np.abs(t)) / np.expm1(4))


def fitted(mesh: anistar.Mesh, field: Field) -> anistar.Mesh:
    """Return a mesh that some passes have fitted to a metric."""
    options = anistar.RemeshOptions(agreement=False, max_refinement=None)
    for _ in range(3):
        mesh = anistar.remesh(mesh, field(mesh.points), options).mesh
    return mesh


def made(case: Case, options: anistar.RemeshOptions) -> tuple[anistar.Remeshed, list[object]]:
    """Return the mesh of a case, and figures of it."""
    M = case.field(case.mesh.points)
    begin = time.process_time()
    done = anistar.remesh(case.mesh, M, options)
    seconds = time.process_time() - begin
    report = done.report
    return done, [
        done.mesh.n_points,
        f"{seconds:.1f}",
        report.consistency["stop_reason"],
        f"{np.floor(1e4 * (report.star_ok or 0)) / 1e4:g}",
        f"{report.statistics['q_min']:.2f}",
    ]


def row(case: Case) -> tuple[anistar.Remeshed, list[object]]:
    """Return the mesh by the star set, and figures of it beside those of the ordinary mesh."""
    pure = anistar.RemeshOptions(
        until_consistent="pure", consistency=case.rules, max_refinement=None
    )
    ordinary = anistar.RemeshOptions(until_consistent=True, max_refinement=None)
    done, figures = made(case, pure)
    inserted = done.report.consistency
    on_surfaces = sum(inserted[rule] for rule in inserted if rule.startswith("facet_"))
    by_rules = [
        inserted["boundary"] + on_surfaces,
        *(inserted[rule] for rule in ("size", "radius_edge", "sliver", "inconsistency")),
    ]
    return done, [case.name, *by_rules, *figures, *made(case, ordinary)[1]]


def wedge(degrees: float) -> anistar.Mesh:
    """Return the half of the unit cube below y = x, squeezed to this angle about the axis z."""
    lattice = cube(4)
    centres = lattice.points[lattice.cells].mean(axis=1)
    kept = lattice.cells[centres[:, 1] < centres[:, 0]]
    used, cells = np.unique(kept, return_inverse=True)
    points = lattice.points[used]
    points[:, 1] *= np.tan(np.radians(degrees))
    return anistar.Mesh(points=points, cells=cells.reshape(kept.shape))


def ridges_of_wedge(degrees: float) -> list[object]:
    """Return how a wedge ends with split ridges, and with protecting balls."""
    figures: list[object] = [f"{degrees}°"]
    for has_balls in (False, True):
        rules = dataclasses.replace(SIZED, protecting_balls=has_balls)
        options = anistar.RemeshOptions(until_consistent="pure", consistency=rules)
        mesh = wedge(degrees)
        report = anistar.remesh(mesh, uniform(0.2)(mesh.points), options).report
        figures += [report.consistency["stop_reason"], f"{report.counts['star_set_sites']:.0f}"]
    return figures


def picture(path: Path, done: anistar.Remeshed) -> None:
    """Draw the half of a ball behind y = 0, coloured by the size along x over that along z."""
    mesh = done.mesh
    ratio = np.sqrt(done.metric[:, 2, 2] / done.metric[:, 0, 0])
    keep = mesh.points[mesh.cells].mean(axis=1)[:, 1] > 0
    volume_picture(
        path, mesh, np.log2(ratio), view=(0, -1, 0.05), keep=keep, label="log2 of h_x / h_z"
    )
    with Image.open(path) as drawn:
        height = PIXELS * drawn.height // drawn.width
        small = drawn.convert("RGB").resize((PIXELS, height), Image.Resampling.LANCZOS)
    small.quantize(COLOURS, Image.Quantize.FASTOCTREE).save(path, optimize=True)


def show(figures: list[object]) -> None:
    """Print a row of a table in Markdown."""
    sys.stdout.write("| " + " | ".join(map(str, figures)) + " |\n")
    sys.stdout.flush()


def main(folder: str) -> None:
    """Print the rows of the tables, and make the pictures of Figure 8."""
    cases = (
        Case(name="cube, one size .25", mesh=cube(4), field=uniform(0.25)),
        Case(name="ball, one size .4", mesh=ball(*3 * [even(8)]), field=uniform(0.4)),
        Case(name="cube, 3d-linear", mesh=fitted(cube(8), linear), field=linear),
        Case(
            name="ball, 3d-linear",
            mesh=ball(even(10), even(10), graded_to_middle(28)),
            field=linear_in_ball,
        ),
    )
    for case in cases:
        show(row(case)[1])
    for degrees in ANGLES:
        show(ridges_of_wedge(degrees))
    for speed, width in WIDTHS.items():
        case = Case(
            name=f"Figure 8, {speed}",
            mesh=ball(*3 * [even(16)]),
            field=crossed(width),
            rules=UNBOUNDED,
        )
        done, figures = row(case)
        show(figures)
        picture(Path(folder) / f"star-set-{speed}.png", done)


if __name__ == "__main__":
    main(*sys.argv[1:])
