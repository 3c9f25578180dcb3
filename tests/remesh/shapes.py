"""Domains with curved boundaries, and metrics given by formulas, for the tests of the remesher."""

import numpy as np
from elementary_inputs import cos, sin, tanh

from anistar import Mesh
from anistar.metric import complexity, graded, normalised


def angles(n):
    """Return n angles from 0 to below 2 pi."""
    return 2 * np.pi * np.arange(n) / n


def on_circle(t):
    return np.stack([cos(t), sin(t)], axis=-1)


def on_ellipse(t):
    """Half axes 1 and 1/2."""
    return on_circle(t) * [1.0, 0.5]


def on_clover(t):
    """A smooth curve that is not convex."""
    return clover_radius(t)[..., None] * on_circle(t)


def clover_radius(t):
    return 1 + 0.25 * cos(3 * t)


def fan(boundary, tags=1, **more):
    """The star-shaped polygon of the (n, 2) points around the origin, as triangles from there."""
    n = len(boundary)
    around = np.arange(n) + 1
    following = np.roll(around, -1)
    return Mesh(
        points=np.concatenate([[[0.0, 0.0]], boundary]),
        cells=np.stack([np.zeros(n, int), around, following], axis=1),
        facets=np.stack([around, following], axis=1),
        facet_tags=np.broadcast_to(tags, n),
        **more,
    )


def target(n):
    """The unit disc (region 1) with a ring (region 2) from radius 1/2; the interface has tag 5."""
    inner = np.arange(n) + 1
    outer = inner + n
    inner2, outer2 = np.roll(inner, -1), np.roll(outer, -1)
    cells = np.concatenate(
        [
            np.stack([np.zeros(n, int), inner, inner2], 1),
            np.stack([inner, outer, outer2], 1),
            np.stack([inner, outer2, inner2], 1),
        ]
    )
    circle = on_circle(angles(n))
    return Mesh(
        points=np.concatenate([[[0.0, 0.0]], circle / 2, circle]),
        cells=cells,
        cell_tags=np.repeat([1, 2, 2], n),
        facets=np.concatenate([np.stack([inner, inner2], 1), np.stack([outer, outer2], 1)]),
        facet_tags=np.repeat([5, 6], n),
        names={(1, 5): "interface", (1, 6): "rim", (2, 1): "core", (2, 2): "coat"},
    )


def refined(points, cells, tags):
    """Cut every triangle into four."""
    edges = np.sort(np.concatenate([cells[:, [0, 1]], cells[:, [1, 2]], cells[:, [2, 0]]]), axis=1)
    unique, middle = np.unique(edges, axis=0, return_inverse=True)
    ab, bc, ca = (middle.reshape(3, -1) + len(points)).astype(cells.dtype)
    a, b, c = cells.T
    parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    children = np.concatenate([np.stack(part, axis=1) for part in parts])
    return np.concatenate([points, points[unique].mean(axis=1)]), children, np.tile(tags, 4)


def sectors(angles, radii, *, gaps=(), turn=0.3):
    """Sectors around the origin, one region each; `angles` in degrees, `gaps` are left out."""
    at = turn + np.radians(np.concatenate([[0], np.cumsum(angles)]))
    n = len(angles)
    n_rays = n if np.isclose(sum(angles), 360) else n + 1
    rim = np.asarray(radii)[:n_rays, None] * np.stack([cos(at), sin(at)], axis=1)[:n_rays]
    kept = np.array([k for k in range(n) if k not in gaps])
    points = np.concatenate([[[0.0, 0.0]], rim])
    cells = np.stack([np.zeros(len(kept), int), 1 + kept, 1 + (kept + 1) % n_rays], axis=1)
    tags = 1 + kept
    for _ in range(4):
        points, cells, tags = refined(points, cells, tags)
    return Mesh(points=points, cells=cells, cell_tags=tags)


def uniform(mesh, h):
    """The metric of edges of length h."""
    return np.broadcast_to(np.eye(2) / h**2, (mesh.n_points, 2, 2)).copy()


def stretched(along, across, angle):
    """Metrics with the size `along` in the direction `angle` and `across` normal to it."""
    first = on_circle(np.asarray(angle))
    second = first[..., ::-1] * [-1.0, 1.0]
    return sum(
        direction[..., :, None] * direction[..., None, :] / np.asarray(h)[..., None, None] ** 2
        for direction, h in ((first, along), (second, across))
    )


def scaled_to(mesh, M, wanted):
    """The metric times the number that gives it the wanted complexity."""
    return M * (wanted / complexity(mesh, M))


def arc(points):
    """A layer of tanh along a circle around the origin."""
    return tanh(20 * ((points**2).sum(axis=-1) - 0.5))


def arc_hessian(points):
    value = arc(points)
    slope = 20 * (1 - value**2)
    ray = 2 * points
    bend = (-40 * value * slope)[:, None, None] * (ray[:, :, None] * ray[:, None, :])
    return bend + 2 * slope[:, None, None] * np.eye(2)


def arc_metric(mesh, wanted):
    """The graded metric for the interpolation error of `arc`."""
    M = normalised(mesh, arc_hessian(mesh.points), target_complexity=wanted)
    return scaled_to(mesh, graded(mesh, M, factor=1.5), wanted)


def linear_metric(mesh, wanted):
    """Thin cells along x = 0 that widen linearly away from it."""
    width = 0.01 + 0.1 * mesh.points[:, 0]
    return scaled_to(mesh, stretched(width, np.full(mesh.n_points, 0.1), 0 * width), wanted)


def rotating_metric(mesh, wanted):
    """Cells six times longer than wide whose direction makes more than a quarter turn."""
    angle = 0.5 * np.pi * (mesh.points[:, 0] + 0.3 * mesh.points[:, 1])
    return scaled_to(mesh, stretched(6.0, 1.0, angle), wanted)
