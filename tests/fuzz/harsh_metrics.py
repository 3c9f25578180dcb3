"""Metric fields that no solver should ask for: eigenvalue ratios to 1e18, jumps, noise.

Every kind is made in 2D and in 3D alike. Sizes are powers of ten relative to the domain.
"""

import numpy as np
from volume_metrics import turned


def harsh_metric(rng, mesh, *, largest):
    """Return the kind and an (n, d, d) field, most of them of a complexity up to `largest`."""
    kind = str(rng.choice(list(KINDS)))
    size = float(np.ptp(mesh.points, axis=0).max())
    x = (mesh.points - mesh.points.mean(axis=0)) / size
    M, log_density = KINDS[kind](rng, x)
    M = 0.5 * (M + M.transpose(0, 2, 1))
    d = mesh.dim
    if rng.random() < 0.2:  # sizes that have nothing to do with the domain
        log_scale = -2 / d * float(log_density.mean()) + 2 * rng.uniform(-6, 6)
        return f"foreign {kind}", M * 10**log_scale / size**2
    wanted = rng.uniform(0, np.log10(largest))
    M = M * 10 ** (2 / d * (wanted - _log_complexity(mesh, log_density, size))) / size**2
    demand = boundary_demand(mesh, M)
    if rng.random() < 0.9 and demand > 3 * largest:
        M = M * (3 * largest / demand) ** 2
    return kind, M


def _log_complexity(mesh, log_density, size):
    """Decimal logarithm of the complexity of a field whose density overflows doubles."""
    corners = mesh.points[mesh.cells] / size
    volumes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / (2, 6)[mesh.dim - 2]
    top = log_density.max()
    density = 10 ** (log_density - top)
    return top + np.log10(max(float((volumes * density[mesh.cells].mean(axis=1)).sum()), 1e-300))


def boundary_demand(mesh, M):
    """Length, in 3D also area, of all facets in the larger metric of their corners."""
    d = mesh.dim
    corners = mesh.points[mesh.facets]
    edges = corners[:, 1:] - corners[:, :1]
    squares = [np.einsum("nkd,nde,nle->nkl", edges, M[mesh.facets[:, k]], edges) for k in range(d)]
    gram = np.max(squares, axis=0).clip(0)
    total = float(np.sqrt(np.einsum("nkk->nk", gram)).sum())
    if d == 3:
        areas = [0.5 * np.sqrt(np.linalg.det(square).clip(0)) for square in squares]
        total += float(np.max(areas, axis=0).sum())
    return total


def _composed(frames, log_sizes):
    """Tensors and decimal logarithms of their densities."""
    frames = np.broadcast_to(frames, (len(log_sizes), *frames.shape[1:]))
    return np.einsum("nik,nk,njk->nij", frames, 10 ** (-2 * log_sizes), frames), -log_sizes.sum(1)


def _frames(vectors, d):
    """Rotations by angles (n, 1) in 2D, by vectors (n, 3) in 3D."""
    if d == 3:
        return turned(vectors)
    c, s = np.cos(vectors[:, 0]), np.sin(vectors[:, 0])
    return np.stack([np.stack([c, -s], 1), np.stack([s, c], 1)], 1)


def _random_frames(rng, n, d):
    if rng.random() < 0.15:
        return np.broadcast_to(np.eye(d), (n, d, d))
    return _frames(rng.normal(size=(n, 2 * d - 3)) * 3, d)


def _orders(rng):
    """Return decades between the sizes of one tensor: 9 are an eigenvalue ratio of 1e18."""
    if rng.random() < 0.25:
        return rng.uniform(6, 8.5)  # on the brink of what doubles can hold
    return rng.uniform(0.2, 1) * rng.choice([1.5, 5, 9])


def _drawn(rng, n, d):
    """Return `n` rows of logarithms of sizes, mostly with the full ratio."""
    orders, rows = _orders(rng), rng.random((n, d))
    if rng.random() < 0.7:
        rows = (rows - rows.min(axis=1, keepdims=True)) / np.ptp(rows, axis=1, keepdims=True)
    return -orders * rows


def _constant(rng, x):
    d = x.shape[1]
    return _composed(_random_frames(rng, 1, d), np.tile(_drawn(rng, 1, d), (len(x), 1)))


def _waves(rng, x, n, height):
    k = rng.normal(size=(n, x.shape[1])) * 10 ** rng.uniform(-0.5, 2)
    return height * np.sin(np.einsum("ni,ki->nk", x, k) + rng.uniform(0, 6, n))


def _rotating(rng, x):
    """Turns by up to many times between neighbours."""
    d = x.shape[1]
    sizes = _drawn(rng, 1, d) + _waves(rng, x, 1, rng.choice([0, 0.3, 2]))
    return _composed(_frames(_waves(rng, x, 2 * d - 3, 10 ** rng.uniform(-1, 2)), d), sizes)


def _jumping(rng, x):
    """Constant metrics next to each other that differ by many orders."""
    n, d = int(rng.integers(2, 5)), x.shape[1]
    seeds = x[rng.integers(len(x), size=n)]
    nearest = np.argmin(((x[:, None] - seeds) ** 2).sum(axis=2), axis=1)
    label = rng.integers(n, size=len(x)) if rng.random() < 0.3 else nearest
    level = rng.uniform(-1, 1, (n, 1)) * rng.choice([0, 2, 6])
    return _composed(_random_frames(rng, n, d)[label], (level + _drawn(rng, n, d))[label])


def _noise(rng, x):
    n, d = x.shape
    return _composed(_random_frames(rng, n, d), _drawn(rng, n, d) + rng.normal(size=(n, 1)))


def _gram(rng, x):
    """A A^T of random matrices whose columns differ in size."""
    n, d = x.shape
    A = rng.normal(size=(n, d, d)) * 10 ** -_drawn(rng, n, d)[:, None, :]
    tensors = np.einsum("nik,njk->nij", A, A)
    return tensors, np.linalg.slogdet(A)[1] / np.log(10)


def _spikes(rng, x):
    """Isotropic but for a few points."""
    n, d = x.shape
    hit = rng.random(n) < rng.choice([1 / n, 0.1])
    return _composed(_random_frames(rng, n, d), np.where(hit[:, None], _drawn(rng, n, d), 0))


def _flat(rng, x):
    """One steep direction at some points, hardly any size at the others."""
    n, d = x.shape
    v = rng.normal(size=(n if rng.random() < 0.5 else 1, d))
    v = np.broadcast_to(v / np.linalg.norm(v, axis=1)[:, None], (n, d))
    rest = -rng.uniform(*((0, 12) if rng.random() < 0.5 else (12, 17)))
    steep = (rng.random(n) < rng.choice([0.3, 1])).astype(float)
    tensors = steep[:, None, None] * v[:, :, None] * v[:, None, :] + 10**rest * np.eye(d)
    return tensors, 0.5 * (d * rest - np.where(steep > 0, rest, 0))


def _exponential(rng, x):
    """Sizes that change by orders of magnitude across the domain."""
    d = x.shape[1]
    along = rng.normal(size=d)
    slope = _orders(rng) * np.einsum("ni,i->n", x, along / np.linalg.norm(along))
    return _composed(_random_frames(rng, 1, d), slope[:, None] * rng.choice([0, 1], d) + 0 * x)


def _layer(rng, x):
    """A layer along a plane, thinner than any cell."""
    d = x.shape[1]
    frames = _random_frames(rng, 1, d)
    far = np.einsum("ni,i->n", x, frames[0, :, 0]) + rng.uniform(-0.3, 0.3)
    near = np.exp(-((far / 10 ** rng.uniform(-4, -0.3)) ** 2))
    return _composed(frames, np.concatenate([-_orders(rng) * near[:, None], 0 * x[:, 1:]], axis=1))


KINDS = {
    "constant": _constant,
    "rotating": _rotating,
    "jumping": _jumping,
    "noise": _noise,
    "gram": _gram,
    "spikes": _spikes,
    "flat": _flat,
    "exponential": _exponential,
    "layer": _layer,
}
