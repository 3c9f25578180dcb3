"""Inputs changed in the last digits, for tests of what is chaotic in them.

A remesher takes thousands of decisions, and the last bit of an input can turn one: counts and
the success of a loop are judged by how they are distributed.
"""

import numpy as np

PERTURBATIONS = 20

SIZE = 1e-13
"""Relative; some hundred times the round-off that another library may make."""


def perturbed(values, number, size=SIZE):
    """Return values, or tensors at points, times 1 + `size` at most; number 0 changes nothing."""
    if number == 0:
        return np.array(values)
    random = np.random.default_rng(number)
    factors = 1.0 + size * random.uniform(-1.0, 1.0, len(values))
    return values * factors.reshape(-1, *[1] * (np.ndim(values) - 1))
