"""Meshes whose boundaries sample known surfaces."""

import numpy as np
from meshes import cube

from anistar.meshes.mesh import Mesh


def ball(n, radius=1.0):
    """A ball of n layers: a cube whose shells are blown up to spheres; one patch, tag 7."""
    base = cube(2 * n)
    x = 2 * base.points - 1
    largest = abs(x).max(axis=1, keepdims=True)
    length = np.linalg.norm(x, axis=1, keepdims=True)
    points = radius * x * largest / np.where(length > 0, length, 1)
    cells = base.cells
    legs = points[cells[:, 1:]] - points[cells[:, :1]]
    cells = np.where((np.linalg.det(legs) < 0)[:, None], cells[:, [0, 1, 3, 2]], cells)
    bare = Mesh(points=points, cells=cells)
    return Mesh(**{**bare.arrays(), "facet_tags": np.full(bare.n_facets, 7)})


def bent_block(n_around, n_along=3, inner=0.5, outer=1.0, angle=np.pi / 2):
    """A quarter of a tube along z, tags 1 inner, 2 outer, 3 the rest, ridges by angle."""
    base = cube(1)
    axes = [np.linspace(0, 1, k + 1) for k in (2, n_around, n_along)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
    at = np.arange(len(grid)).reshape([len(axis) for axis in axes])
    shape = (2, n_around, n_along)
    corner = {
        tuple(p): at[
            tuple(slice(int(s), int(s) + k) for s, k in zip(p, shape, strict=True))
        ].ravel()
        for p in base.points
    }
    cells = np.concatenate(
        [np.stack([corner[tuple(base.points[v])] for v in cell], 1) for cell in base.cells]
    )
    r, phi = inner + (outer - inner) * grid[:, 0], angle * grid[:, 1]
    points = np.stack([r * np.cos(phi), r * np.sin(phi), grid[:, 2]], 1)
    bare = Mesh(points=points, cells=cells)
    radii = np.hypot(*points[bare.facets][..., :2].transpose(2, 0, 1))
    tags = np.full(bare.n_facets, 3)
    tags[(abs(radii - inner) < 1e-12).all(axis=1)] = 1
    tags[(abs(radii - outer) < 1e-12).all(axis=1)] = 2
    return Mesh(**{**bare.arrays(), "facet_tags": tags})


def torus(n_around, n_section, thickness, turn):
    """A ring of tetrahedra of radius one, each section a regular polygon around its middle."""
    phi = 2 * np.pi * (np.arange(n_section) / n_section + turn)
    section = thickness * np.stack([np.cos(phi), np.sin(phi)], 1)
    section = np.concatenate([[[0, 0]], section])
    angle = 2 * np.pi * np.arange(n_around) / n_around
    radius = 1 + section[:, 0]
    height = np.broadcast_to(section[:, 1], (n_around, n_section + 1))
    x, y = np.cos(angle)[:, None] * radius, np.sin(angle)[:, None] * radius
    points = np.stack([x, y, height], -1).reshape(-1, 3)
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
    return Mesh(points=points, cells=cells)


def samples(mesh, tag, per_facet=3, seed=0):
    """Points on the facets with a tag."""
    weights = np.random.default_rng(seed).dirichlet(np.ones(3), per_facet)
    corners = mesh.points[mesh.facets[mesh.facet_tags == tag]]
    return np.ascontiguousarray(np.einsum("kc,fcd->fkd", weights, corners).reshape(-1, 3))
