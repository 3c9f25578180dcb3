"""Larger patches against noise."""

from __future__ import annotations

import numpy as np

from ...base.arrays import Floats
from ..patches.fit import Fits, fit_patches
from ..patches.noise import NOISE_MARGIN, hessian_norm
from .setting import Setting

MEASURABLE_NOISE = 2e-15
"""Noise relative to the values from which it is more than round-off."""

CLEAR_SIGNAL = 5.0
"""Hessians this many times above the noise need no larger patch."""

LARGEST_GROWTH = {2: 3, 3: 1}
"""Highest level to which patches are grown against noise, by dimension: some hundred samples."""


def is_measurable(setting: Setting, noise: Floats) -> bool:
    """Whether the noise (k,) of a field is more than round-off."""
    size = np.abs(setting.samples.columns).max(axis=0, initial=0.0)
    return bool((noise > MEASURABLE_NOISE * size).any())


def grow_against_noise(setting: Setting, fits: Fits, noise: Floats) -> None:
    """Take larger patches where the signal is weak and the larger patch does not deny it.

    A larger patch has less noise and more features that a quadratic cannot follow. It is taken
    as long as the Hessian that it gives differs from the previous one by no more than noise can
    explain, which is the rule of Lepskii [1]_.

    References
    ----------
    .. [1] Lepskii, On a problem of adaptive estimation in Gaussian white noise, Theory of
       Probability and its Applications 35, 1990.
    """
    active = np.flatnonzero(fits.level >= 0)
    largest = LARGEST_GROWTH[setting.cut.points.shape[1]]
    for _ in range(largest):
        threshold = NOISE_MARGIN * fits.gain[:, None] * noise
        norm = hessian_norm(fits.hessian[active], fits.covariance[active])
        is_weak = (norm < CLEAR_SIGNAL * threshold[active]).any(axis=1)
        active = active[is_weak & (fits.level[active] < largest)]
        taken = []
        for level in np.unique(fits.level[active]):
            rows = active[fits.level[active] == level]
            grown = fit_patches(
                setting.cut.points,
                setting.cloud,
                setting.graph.matrix(),
                degree=2,
                rows=rows,
                levels=(int(level) + 1,),
                with_gain=True,
            )
            change = hessian_norm(grown.hessian - fits.hessian[rows], fits.covariance[rows])
            is_explained = (change <= threshold[rows]).all(axis=1) & (grown.level >= 0)
            fits.put(rows[is_explained], grown, is_explained)
            taken.append(rows[is_explained])
        if not taken:
            break
        active = np.concatenate(taken)
