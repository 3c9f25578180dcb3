"""How far a recovered Hessian can be trusted."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..base.arrays import Floats


@dataclass(frozen=True, kw_only=True)
class RecoveryConfidence:
    """Per-point evidence for or against a recovered Hessian; the worst side on interfaces.

    Attributes
    ----------
    order : ndarray (n,) of int8
        2 where a quadratic was fitted, 1 where gradients were projected twice.
    condition : ndarray (n,)
        Smallest pivot of the scaled normal matrix of the patch, in (0, 1]: the squared sine of
        the angle between a basis function and the others. 0 without a fit.
    level : ndarray (n,) of int8
        How often the patch was grown, -1 without a fit.
    discrepancy : ndarray (n,) or (n, k)
        Norm of the difference to the Hessian by ``l2``, relative to the larger of both norms
        and to what noise can make: 0 if the methods agree, above 1 if they tell nothing.
    signal : ndarray (n,) or (n, k)
        Norm of the Hessian relative to what noise and round-off can make. Below 1, nothing is
        known of the Hessian, and it is damped to zero.
    noise : float or ndarray (k,)
        Standard deviation of the values, given or estimated.
    """

    order: NDArray[np.int8]
    condition: Floats
    level: NDArray[np.int8]
    discrepancy: Floats
    signal: Floats
    noise: Floats

    def of_columns(self, columns: int | slice) -> RecoveryConfidence:
        """Return the evidence for some of the functions that were recovered together."""
        return replace(
            self,
            discrepancy=self.discrepancy[:, columns],
            signal=self.signal[:, columns],
            noise=self.noise[columns],
        )

    def as_dict(self) -> dict[str, Any]:
        """Return counts and quantiles in JSON builtins."""
        levels, counts = np.unique(self.level, return_counts=True)
        quantiles = {f"p{q}": float(np.percentile(self.discrepancy, q)) for q in (50, 90, 99)}
        return {
            "quadratic_fits": int((self.order == 2).sum()),
            "projections": int((self.order == 1).sum()),
            "levels": dict(zip(map(int, levels), map(int, counts), strict=True)),
            "smallest_condition": float(self.condition.min()),
            "discrepancy": quantiles,
            "below_noise": int((self.signal < 1.0).sum()),
            "noise": np.asarray(self.noise).tolist(),
        }
