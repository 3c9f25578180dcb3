"""Print the tables of surface-stars.md, and draw its picture.

Run it in the folder of the repository; it takes a minute::

    python docs/make_surface_tables.py docs/images
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from make_certificate_pictures import disk
from make_certificate_tables import Float, Row, cube
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import anistar
from anistar.metric import curvature_metric, graded

Field = Callable[[anistar.Mesh], Float]

PASSES = 3
COMPLEXITY = 3500.0
ACROSS = np.array([0.6, 0.5, 0.62]) / np.linalg.norm([0.6, 0.5, 0.62])
THIN, WIDE, GROWTH = 0.012, 0.12, 0.18  # sizes of the layer, and how fast they grow

ASKED = (
    anistar.RemeshOptions(agreement=False),
    anistar.RemeshOptions(agreement=True),
    anistar.RemeshOptions(until_consistent=True),
)

# Theorem 7.1 of RR-7712 v2: global distortion, distortion bound, picking ratio.
CONSTANTS = ((1.0, 1.0, 0.1), (1.0, 1.0, 0.4), (1.5, 1.1, 0.4))


def layer(x: Float) -> Float:
    """Return a metric that is thin across a plane through the origin."""
    distance = x @ ACROSS
    thin = np.minimum(THIN + GROWTH * np.sqrt(distance**2 + 1e-4), WIDE)
    excess = 1 / thin**2 - 1 / WIDE**2
    return np.asarray(np.eye(3) / WIDE**2 + excess[:, None, None] * np.outer(ACROSS, ACROSS))


def unfolded(mesh: anistar.Mesh, points: Float, *, is_inner: Float | None = None) -> anistar.Mesh:
    """Return the cells of a mesh at other points, all of them positive."""
    legs = points[mesh.cells[:, 1:]] - points[mesh.cells[:, :1]]
    is_turned = np.linalg.det(legs) < 0
    cells = np.where(is_turned[:, None], mesh.cells[:, [0, 1, 3, 2]], mesh.cells)
    tags = np.zeros(len(cells), dtype=np.int32)
    if is_inner is not None:
        tags = is_inner[mesh.cells].all(axis=1).astype(np.int32)
    return anistar.Mesh(points=points, cells=cells, cell_tags=tags)


def blown_up(x: Float) -> Float:
    """Return the points of a cube, from -1 to 1, on the spheres or circles around its middle."""
    length = np.linalg.norm(x, axis=1, keepdims=True)
    return np.asarray(x * abs(x).max(axis=1, keepdims=True) / np.where(length > 0, length, 1))


def ball(n: int = 10) -> anistar.Mesh:
    """Return the unit ball."""
    box = cube(n)
    return unfolded(box, blown_up(2 * box.points - 1))


def ellipsoid() -> anistar.Mesh:
    """Return an ellipsoid with three different axes."""
    round_one = ball()
    return unfolded(round_one, round_one.points * [1.0, 0.7, 0.5])


def cylinder(n: int = 10) -> anistar.Mesh:
    """Return a cylinder of radius and height one."""
    box = cube(n)
    flat = blown_up(2 * box.points[:, :2] - 1)
    return unfolded(box, np.column_stack([flat, box.points[:, 2]]))


def two_regions(n: int = 12) -> anistar.Mesh:
    """Return a ball within a ball: two regions and a curved interface."""
    box = cube(n)
    is_inner = abs(2 * box.points - 1).max(axis=1) < 0.5 + 1e-9
    return unfolded(box, blown_up(2 * box.points - 1), is_inner=is_inner)


def torus(n_around: int = 40, n_section: int = 14) -> anistar.Mesh:
    """Return a torus with radii 1 and .4."""
    phi = 2 * np.pi * np.arange(n_section) / n_section
    section = np.vstack([[0, 0], 0.4 * np.stack([np.cos(phi), np.sin(phi)], axis=1)])
    angle = 2 * np.pi * np.arange(n_around) / n_around
    radius = 1 + section[:, 0]
    height = np.broadcast_to(section[:, 1], (n_around, n_section + 1))
    x, y = np.cos(angle)[:, None] * radius, np.sin(angle)[:, None] * radius
    points = np.stack([x, y, height], axis=-1).reshape(-1, 3)
    cells = []
    for i in range(n_around):
        here, there = i * (n_section + 1), (i + 1) % n_around * (n_section + 1)
        for k in range(n_section):
            a, b = sorted((1 + k, 1 + (k + 1) % n_section))
            cells += [
                [here, here + a, here + b, there + b],
                [here, here + a, there + a, there + b],
                [here, there, there + a, there + b],
            ]
    cells = np.array(cells)
    legs = points[cells[:, 1:]] - points[cells[:, :1]]
    cells = np.where((np.linalg.det(legs) < 0)[:, None], cells[:, [0, 1, 3, 2]], cells)
    return anistar.Mesh(points=points, cells=cells)


BODIES = {
    "cube": lambda: cube(6),
    "ball": ball,
    "cylinder": cylinder,
    "torus": torus,
    "ellipsoid": ellipsoid,
    "ball in a ball": two_regions,
}


CURVED = tuple(BODIES)[1:]


@dataclass(frozen=True, kw_only=True)
class Made:
    """The last of some passes, its certificate and its processor time."""

    done: anistar.Remeshed
    certificate: anistar.Certificate
    seconds: float


def layer_in(body: anistar.Mesh) -> Field:
    """Return the layer, scaled to a complexity in the body."""
    legs = body.points[body.cells[:, 1:]] - body.points[body.cells[:, :1]]
    density = np.sqrt(np.linalg.det(layer(body.points)))[body.cells].mean(axis=1)
    scale = (COMPLEXITY / (abs(np.linalg.det(legs)) / 6 * density).sum()) ** (2 / 3)
    return lambda mesh: scale * layer(mesh.points)


def curvature(mesh: anistar.Mesh) -> Float:
    """Return the metric that resolves the curvature of the surfaces of a mesh."""
    M = curvature_metric(mesh, points_per_circle=40, h_max=WIDE)
    return graded(mesh, M, factor=1.5, max_distortion=0.25)


def outcomes(body: anistar.Mesh, field: Field) -> list[Made]:
    """Return what each of `ASKED` makes of a body, all from the same mesh."""
    mesh = body
    for _ in range(PASSES - 1):
        mesh = anistar.remesh(mesh, field(mesh), ASKED[0], geometry=body).mesh
    made = []
    for options in ASKED:
        start = time.process_time()
        done = anistar.remesh(mesh, field(mesh), options, geometry=body)
        seconds = time.process_time() - start
        certificate = anistar.certify(done.mesh, done.metric)
        made.append(Made(done=done, certificate=certificate, seconds=seconds))
    return made


def row_of(name: str, made: list[Made]) -> Row:
    """Return a row of the table of bodies."""
    fractions = [one.certificate.as_dict() for one in made]
    return [
        name,
        made[1].done.mesh.n_points,
        made[1].done.mesh.n_facets,
        *(shown(f["star_ok"]) for f in fractions),
        *(shown(f["surface_star_ok"]) for f in fractions),
        *(f"{one.done.report.statistics['q_min']:.2f}" for one in made),
    ]


def shown(share: float) -> str:
    """Return a share to four digits, rounded down: 1 means all."""
    return f"{np.floor(1e4 * share) / 1e4:g}"


def largest_alpha_1(Gamma: float, gamma_0: float, delta: float, **ours: float) -> tuple[float, ...]:
    """Return what (49), (50) and (51) leave for alpha_1, given the other constants."""
    alpha_0, rho_0, beta = ours["alpha_0"], ours["rho_0"], ours["beta"]
    return (
        alpha_0 / (1 + alpha_0 / (2 * gamma_0)) / (7 * Gamma * gamma_0**7),
        Gamma**2 * gamma_0 / (8 * (1 - delta) * rho_0),
        (1 + delta) / (1 - delta) * Gamma**2 * gamma_0 / (8 * beta),
    )


def smallest_ratios(Gamma: float, gamma_0: float, delta: float) -> tuple[float, float]:
    """Return the smallest rho_0 and beta of (47) and (48)."""
    factor = 5 * Gamma**2 * gamma_0**8
    return (
        factor * (1 + delta) / (1 - delta) ** 2,
        factor * ((1 + delta) / (1 - delta)) ** 2,
    )


def theorem_row(Gamma: float, gamma_0: float, delta: float) -> Row:
    """Return a row of the table of Theorem 7.1, alpha_1 with the smallest ratios."""
    rho_0, beta = smallest_ratios(Gamma, gamma_0, delta)
    alpha_0 = anistar.ConsistencyOptions().alpha_0
    bounds = largest_alpha_1(Gamma, gamma_0, delta, alpha_0=alpha_0, rho_0=rho_0, beta=beta)
    return [Gamma, gamma_0, delta, *(f"{x:.3g}" for x in (rho_0, beta, *bounds))]


def ellipse(centre: Float, M: Float, radius: float) -> Float:
    """Return points (k, 2) at a distance from a centre in a metric."""
    angle = np.linspace(0, 2 * np.pi, 200)
    circle = radius * np.stack([np.cos(angle), np.sin(angle)])
    return np.asarray(centre + np.linalg.solve(np.linalg.cholesky(M).T, circle).T)


def turning(points: Float) -> Float:
    """Return a metric in the plane, four to one, whose axes turn."""
    along = np.stack([np.cos(4 * points[:, 0]), np.sin(4 * points[:, 0])], axis=1)
    return np.asarray(np.eye(2) + 15 * along[:, :, None] * along[:, None, :]) / 0.2**2


def draw(folder: Path) -> None:
    """Draw a facet that is in the surface star of a vertex, and the one that is least so."""
    background = disk(0.05)
    done = anistar.remesh(background, turning(background.points), ASKED[0])
    found = [
        facet
        for v in np.unique(done.mesh.facets).tolist()
        for facet in anistar.explain_surface_star(done.mesh, done.metric, v)
    ]
    failing = [it for it in found if it.violator is not None]
    worst = min(failing, key=lambda it: (it.violator_distance or 0) / it.radius)
    figure = Figure(figsize=(8, 4))
    for place, facet in enumerate((found[3], worst), start=1):
        draw_one(figure.add_subplot(1, 2, place, aspect="equal"), done, facet)
    figure.savefig(folder / "surface-star.png", dpi=120, bbox_inches="tight")


def draw_one(axes: Axes, done: anistar.Remeshed, facet: anistar.FacetOfStar) -> None:
    """Draw a facet of a surface star with its ball."""
    v, points, centre = facet.vertices[0], done.mesh.points, np.array(facet.centre)
    around = ellipse(centre, done.metric[v], facet.radius)
    axes.triplot(*points.T, done.mesh.cells, color="0.7", linewidth=0.8)
    axes.plot(*points[list(facet.vertices)].T, color="black", linewidth=2)
    axes.plot(*around.T, color="tab:blue" if facet.is_delaunay else "tab:red")
    axes.plot(*centre, "+", color="black")
    axes.plot(*points[v], "o", color="black")
    if facet.violator is not None:
        axes.plot(*points[facet.violator], "o", color="tab:red")
    reach = 1.5 * abs(around - centre).max()
    axes.set_xlim(centre[0] - reach, centre[0] + reach)
    axes.set_ylim(centre[1] - reach, centre[1] + reach)
    axes.set_axis_off()


def show(row: Row) -> None:
    """Print a row of a table in Markdown."""
    sys.stdout.write("| " + " | ".join(str(entry) for entry in row) + " |\n")


def main(folder: str) -> None:
    """Print every table and draw the picture."""
    for name, make in BODIES.items():
        body = make()
        show(row_of(f"{name}, layer", outcomes(body, layer_in(body))))
        if name in CURVED:
            show(row_of(f"{name}, curvature", outcomes(body, curvature)))
    for constants in CONSTANTS:
        show(theorem_row(*constants))
    draw(Path(folder))


if __name__ == "__main__":
    main(*sys.argv[1:])
