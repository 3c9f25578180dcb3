"""Random metric fields on a background mesh."""

import numpy as np

from anistar.metric import complexity, graded


def metric_field(rng, mesh, *, largest=3000.0):
    """Return the kind and an (n, 2, 2) field of random complexity up to `largest`."""
    kind = str(rng.choice(list(KINDS)))
    size = float(np.ptp(mesh.points, axis=0).max())
    x = (mesh.points - mesh.points.mean(axis=0)) / size
    angle, log_size, log_ratio = KINDS[kind](rng, x)
    M = _tensors(angle, log_size, log_ratio) / size**2
    M *= 10 ** rng.uniform(0, np.log10(largest)) / complexity(mesh, M)
    if kind == "graded":
        M = graded(mesh, M, factor=rng.uniform(1.2, 2))
    excess = complexity(mesh, M) / largest
    return kind, M / max(1.0, excess)


def _tensors(angle, log_size, log_ratio):
    """M with sizes exp(log_size) along `angle` and exp(log_size - log_ratio) across."""
    c, s = np.cos(angle), np.sin(angle)
    along, across = np.exp(-2 * log_size), np.exp(-2 * (log_size - log_ratio))
    M = np.empty((len(angle), 2, 2))
    M[:, 0, 0] = along * c * c + across * s * s
    M[:, 1, 1] = along * s * s + across * c * c
    M[:, 0, 1] = M[:, 1, 0] = (along - across) * c * s
    return M


def _ratio(rng):
    """Return the logarithm of an aspect ratio, up to 1e6 now and then."""
    return np.log(10) * (rng.uniform(0, 6) if rng.random() < 0.3 else rng.uniform(0, 1.5))


def _constant(rng, x):
    one = np.ones(len(x))
    return rng.uniform(0, np.pi) * one, 0 * one, (rng.random() < 0.7) * _ratio(rng) * one


def _smooth(rng, x):
    def wave(height):
        k = rng.normal(size=(3, 2)) * rng.uniform(0.5, 4)
        return height * np.sin(x @ k.T + rng.uniform(0, 6, 3)).mean(axis=1)

    ratio = _ratio(rng)
    return wave(rng.uniform(0, 6)), wave(rng.uniform(0, 3)), ratio * (0.5 + 0.5 * wave(1.0))


def _rough(rng, x):
    n = len(x)
    return (
        rng.uniform(0, np.pi, n),
        rng.normal(size=n) * rng.uniform(0, 2),
        _ratio(rng) * rng.random(n),
    )


def _layer(rng, x):
    """A layer along a line or a circle."""
    if rng.random() < 0.5:
        angle = np.full(len(x), rng.uniform(0, np.pi))
        far = x @ [-np.sin(angle[0]), np.cos(angle[0])] + rng.uniform(-0.3, 0.3)
    else:
        centre = rng.uniform(-0.7, 0.7, 2)
        angle = np.arctan2(*(x - centre).T[::-1]) + np.pi / 2
        far = np.linalg.norm(x - centre, axis=1) - rng.uniform(0.1, 0.6)
    near = np.exp(-((far / 10 ** rng.uniform(-2, -0.3)) ** 2))
    return angle, np.zeros(len(x)), _ratio(rng) * near


KINDS = {
    "constant": _constant,
    "smooth": _smooth,
    "graded": _smooth,
    "rough": _rough,
    "layer": _layer,
}
