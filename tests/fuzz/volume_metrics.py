"""Random 3D metric fields."""

import numpy as np

from anistar.metric import complexity, graded


def volume_metric(rng, mesh, *, largest=1000.0):
    """Return the kind and an (n, 3, 3) field of random complexity up to `largest`."""
    kind = str(rng.choice(list(KINDS)))
    size = float(np.ptp(mesh.points, axis=0).max())
    x = (mesh.points - mesh.points.mean(axis=0)) / size
    frames, log_sizes = KINDS[kind](rng, x)
    values = np.exp(-2 * log_sizes)
    M = np.einsum("nik,nk,njk->nij", frames, values, frames) / size**2
    M *= (10 ** rng.uniform(0, np.log10(largest)) / complexity(mesh, M)) ** (2 / 3)
    if kind == "graded":
        M = graded(mesh, M, factor=rng.uniform(1.2, 2))
    excess = complexity(mesh, M) / largest
    M = M / max(1.0, excess) ** (2 / 3)
    return kind, 0.5 * (M + M.transpose(0, 2, 1))


def turned(vectors):
    """Rotations by the vectors (Rodrigues' formula), (n, 3) -> (n, 3, 3)."""
    angle = np.linalg.norm(vectors, axis=1)
    k = vectors / np.maximum(angle, 1e-300)[:, None]
    K = np.zeros((len(k), 3, 3))
    K[:, [2, 0, 1], [1, 2, 0]] = k
    K[:, [1, 2, 0], [2, 0, 1]] = -k
    s, c = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return np.eye(3) + s * K + (1 - c) * (K @ K)


def _ratio(rng):
    """Return the logarithm of an aspect ratio, up to 1e4 now and then."""
    return np.log(10) * (rng.uniform(0, 4) if rng.random() < 0.3 else rng.uniform(0, 1.5))


def _waves(rng, x, n, height):
    k = rng.normal(size=(n, 3)) * rng.uniform(0.5, 4)
    return height * np.sin(x @ k.T + rng.uniform(0, 6, n))


def _constant(rng, x):
    frame = turned(rng.normal(size=(1, 3)))
    sizes = -_ratio(rng) * rng.random(3)
    return np.repeat(frame, len(x), 0), np.tile(sizes, (len(x), 1))


def _rotating(rng, x):
    sizes = np.tile([0, 0, -_ratio(rng)], (len(x), 1))
    return turned(_waves(rng, x, 3, rng.uniform(0, 4))), sizes


def _exchanging(rng, x):
    ratio = _ratio(rng)
    wave = 0.5 + 0.5 * _waves(rng, x, 1, 1.0)
    sizes = -ratio * np.concatenate([wave, 1 - wave, 0 * wave], axis=1)
    return np.repeat(turned(rng.normal(size=(1, 3))), len(x), 0), sizes


def _smooth(rng, x):
    sizes = _waves(rng, x, 3, rng.uniform(0, 0.5 * _ratio(rng) + 0.1))
    return turned(_waves(rng, x, 3, rng.uniform(0, 3))), sizes


def _jump(rng, x):
    """One constant metric on each side of a plane."""
    side = (x @ rng.normal(size=3) > 0).astype(int)
    frames = turned(rng.normal(size=(2, 3)))
    sizes = -np.array([_ratio(rng), _ratio(rng)])[:, None] * rng.random((2, 3))
    return frames[side], sizes[side]


def _rough(rng, x):
    n = len(x)
    return turned(rng.normal(size=(n, 3))), -_ratio(rng) * rng.random((n, 3))


def _layer(rng, x):
    """A layer along a plane or a sphere."""
    if rng.random() < 0.5:
        normal = np.tile(rng.normal(size=3), (len(x), 1))
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        far = np.einsum("ij,ij->i", x, normal) + rng.uniform(-0.3, 0.3)
    else:
        normal = x - rng.uniform(-0.7, 0.7, 3)
        far = np.linalg.norm(normal, axis=1)
        normal = normal / np.maximum(far, 1e-12)[:, None]
        far = far - rng.uniform(0.1, 0.6)
    first = np.where(np.abs(normal[:, :1]) < 0.9, [[1.0, 0, 0]], [[0, 1.0, 0]])
    first = np.cross(normal, first)
    first /= np.linalg.norm(first, axis=1)[:, None]
    frames = np.stack([first, np.cross(normal, first), normal], axis=2)
    near = np.exp(-((far / 10 ** rng.uniform(-1.5, -0.3)) ** 2))
    zero = np.zeros(len(x))
    return frames, np.stack([zero, zero, -_ratio(rng) * near], axis=1)


KINDS = {
    "constant": _constant,
    "rotating": _rotating,
    "exchanging": _exchanging,
    "smooth": _smooth,
    "graded": _smooth,
    "jump": _jump,
    "rough": _rough,
    "layer": _layer,
}
