"""Where a harsh domain lies, how large it is, and what is tagged with which numbers."""

import numpy as np
from volume_metrics import turned

from anistar.meshes.mesh import Mesh
from anistar.meshes.topology import facet_table

FARTHEST, LARGEST = 6, 9
"""Decades: of the distance from the origin in sizes of the domain, and of the size."""


def placed_mesh(rng, points, arrays):
    """Return the mesh turned, scaled and shifted, as far as its cells stay positive there.

    A shift takes digits from the coordinates: it is made ten times smaller until a mesh is left.
    """
    d = points.shape[1]
    if rng.random() < 0.5:
        turn = turned(rng.normal(size=(1, 3)) * ([0, 0, 1] if d == 2 else 1))[0, :d, :d]
        points = np.einsum("nj,ij->ni", points, turn)
    corners = rng.choice(len(points), rng.integers(0, 4)) if rng.random() < 0.3 else []
    arrays = {**arrays, "corners": np.unique(corners).astype(int)}
    scale = 10 ** rng.uniform(-LARGEST, LARGEST) if rng.random() < 0.5 else 1.0
    if rng.random() < 0.03:
        scale = 10.0 ** rng.choice([-60, -30, 30, 60])
    direction = rng.normal(size=d) / np.sqrt(d)
    shift = 10 ** rng.uniform(0, FARTHEST) if rng.random() < 0.4 else 0.0
    for far in [shift / 10**k for k in range(FARTHEST + 1)]:
        moved = (points + far * direction * np.ptp(points, axis=0).max()) * scale
        try:
            return Mesh(points=moved, **arrays)
        except ValueError:
            continue
    return Mesh(points=points * scale, **arrays)


def with_sheets(rng, cells, n_points, facets, facet_tags):
    """Return facets and tags with inner facets at random, up to all of them, and many tags."""
    if rng.random() < 0.15:
        facet_tags = np.arange(len(facets)) % rng.integers(2, 60)
    if rng.random() < 0.85:
        return facets, facet_tags
    table = facet_table(cells, n_points)
    share = rng.choice([rng.uniform(0, 0.4), 1.0], p=[0.7, 0.3])
    inner = table.facets[(table.counts == 2) & (rng.random(len(table.counts)) < share)]
    taken = set(map(tuple, np.sort(facets, axis=1).tolist()))
    free = [facet for facet in inner.tolist() if tuple(sorted(facet)) not in taken]
    if not free:
        return facets, facet_tags
    tags = 70 + rng.integers(0, rng.choice([1, 5]), len(free))
    return np.concatenate([facets, free]), np.concatenate([facet_tags, tags])


def tags_at_random(rng, tags, *, but=()):
    """Return the tags, or other numbers for them: negative, zero, and as large as int32 holds."""
    if rng.random() < 0.6:
        return tags
    known = np.unique(tags)
    pool = np.array([*range(-20, 200), 2**31 - 1, -(2**31), 2**31 - 2, 1 - 2**31])
    pool = np.setdiff1d(pool, but)
    if len(known) > len(pool):
        return tags
    return rng.choice(pool, len(known), replace=False)[np.searchsorted(known, tags)]
