"""Random small meshes and metrics, from hopeful to hopeless."""

import numpy as np
from oracle import turns
from scipy.spatial import Delaunay

from anistar.meshes.mesh import Mesh

#: What a certificate says, by name.
FIGURES = (
    *("simplex_ok", "star_ok", "exempt", "verdict", "delaunay"),
    *("surface_ok", "surface_star_ok", "in_surface_star"),
    *("distortion", "radius_edge", "sliverity"),
    *("stars_without_interfaces", "restricted_v1", "restricted_v2"),
)


def metric_of(angle, sizes):
    """The metric with the given sizes along the axes turned by `angle`."""
    c, s = np.cos(angle), np.sin(angle)
    axes = np.array([[c, -s], [s, c]])
    M = axes @ np.diag(1 / np.asarray(sizes, dtype=float) ** 2) @ axes.T
    return 0.5 * (M + M.T)


def random_metric(rng, points, kind):
    """(n, 2, 2): `constant`, `smooth` or `hopeless`, with aspect ratios up to 1e6."""
    n = len(points)
    if kind == "hopeless":
        return np.array(
            [metric_of(rng.uniform(0, 7), [1, 10 ** -rng.uniform(0, 6)]) for _ in range(n)]
        )
    angle, aspect = rng.uniform(0, 7), 10 ** rng.uniform(0, 1)
    if kind == "constant":
        return np.tile(metric_of(angle, [1, 1 / aspect]), (n, 1, 1))
    turn, growth = rng.uniform(0, 0.3, 2)
    return np.array(
        [
            metric_of(angle + turn * x, [1 + growth * y, (1 + growth * x) / aspect])
            for x, y in points
        ]
    )


def triangulated_square(rng, n, M):
    """Random points of the unit square and their Delaunay triangulation in one metric."""
    points = np.concatenate([[[0, 0], [1, 0], [1, 1], [0, 1]], rng.uniform(0.02, 0.98, (n, 2))])
    return points, oriented(points, Delaunay(points @ np.linalg.cholesky(M)).simplices)


def oriented(points, cells):
    """The cells with a positive area."""
    a, b, c = points[cells].transpose(1, 0, 2)
    sign = turns(a, b, c)
    assert (sign != 0).all()
    return np.where((sign > 0)[:, None], cells, cells[:, [0, 2, 1]])


def shuffled(rng, points, cells, flips):
    """The triangulation after random flips of edges of strictly convex quadrilaterals."""
    cells = [tuple(cell) for cell in cells.tolist()]
    for _ in range(flips):
        one = int(rng.integers(len(cells)))
        i = int(rng.integers(3))
        a, p, q = (cells[one][(i + k) % 3] for k in range(3))
        across = [k for k, cell in enumerate(cells) if p in cell and q in cell and k != one]
        if not across:
            continue
        b = next(v for v in cells[across[0]] if v not in (p, q))
        if (
            turns(points[a], points[p], points[b])[0]
            > 0
            < turns(points[a], points[b], points[q])[0]
        ):
            cells[one], cells[across[0]] = (a, p, b), (a, b, q)
    return np.array(cells, dtype=np.int32)


def convex_case(seed):
    """A mesh of the square without constraints, and a metric."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 22))
    kind = ("constant", "smooth", "hopeless")[seed % 3]
    probe = random_metric(rng, rng.uniform(size=(1, 2)), "constant" if kind != "hopeless" else kind)
    M = probe[0] if np.linalg.cond(probe[0]) < 1e4 else np.eye(2)
    points, cells = triangulated_square(rng, n, M)
    cells = shuffled(rng, points, cells, int(rng.choice([0, 0, 1, 3, 40])))
    if kind == "constant" and rng.uniform() < 0.7:
        metric = np.tile(M, (len(points), 1, 1))
    else:
        metric = random_metric(rng, points, kind)
    return Mesh(points=points, cells=cells), metric


def walled_case(seed):
    """A mesh with some of holes, notches, slits, interfaces and regions, and a metric."""
    rng = np.random.default_rng(seed)
    base, metric = convex_case(seed)
    centres = base.points[base.cells].mean(axis=1)
    kept = np.ones(base.n_cells, bool)
    if rng.uniform() < 0.6 and base.n_cells > 6:
        kept[rng.choice(base.n_cells, int(rng.integers(1, base.n_cells // 3)), replace=False)] = (
            False
        )
    tags = np.zeros(base.n_cells, np.int32)
    if rng.uniform() < 0.5:
        tags = (centres @ rng.normal(size=2) > rng.normal(0, 0.3)).astype(np.int32)
    used, inverse = np.unique(base.cells[kept], return_inverse=True)
    cells = inverse.reshape(-1, 3).astype(np.int32)
    edges = np.unique(np.sort(cells[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    slits = edges[rng.uniform(size=len(edges)) < rng.choice([0, 0.1, 0.3])]
    mesh = Mesh(points=base.points[used], cells=cells, cell_tags=tags[kept], facets=slits)
    return mesh, metric[used]


def thin_case(seed, aspect):
    """Points spread evenly in one metric of the given aspect ratio, and that metric everywhere."""
    rng = np.random.default_rng(seed)
    points, cells = triangulated_square(rng, 15, np.eye(2))
    angle = rng.uniform(0, 7)
    c, s = np.cos(angle), np.sin(angle)
    points = points @ np.diag([1, 1 / aspect]) @ np.array([[c, s], [-s, c]])
    metric = np.tile(metric_of(angle, [1, 1 / aspect]), (len(points), 1, 1))
    return Mesh(points=points, cells=oriented(points, cells)), metric


def lattice_case(seed):
    """An integer lattice, triangulated at random, with metrics of small integers: many ties."""
    rng = np.random.default_rng(seed)
    nx, ny = rng.integers(2, 5, 2)
    x, y = np.meshgrid(np.arange(nx), np.arange(ny))
    points = np.stack([x.ravel(), y.ravel()], axis=1).astype(float)
    a = (np.arange(ny - 1)[:, None] * nx + np.arange(nx - 1)).ravel()
    b, c, d = a + 1, a + nx + 1, a + nx
    cells = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    cells = shuffled(rng, points, cells, int(rng.choice([0, 10, 60])))
    metrics = [[[1, 0], [0, 1]], [[2, 1], [1, 2]], [[4, 0], [0, 1]], [[5, 2], [2, 1]]]
    chosen = rng.integers(4) if seed % 2 else rng.integers(4, size=len(points))
    metric = np.array(metrics, dtype=float)[np.broadcast_to(chosen, len(points))]
    return Mesh(points=points, cells=cells), metric
