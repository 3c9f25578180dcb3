"""Options of the recovery of gradients and Hessians."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

METHODS = ("auto", "quadratic", "l2", "mixed_l2", "zz", "clement", "green")
MASSES = ("lumped", "consistent")
BOUNDARIES = ("auto", "one_sided", "extrapolated")

EXTRAPOLATED = ("l2", "zz", "clement", "green")
"""Methods whose values at the boundary are worse than a line through those inside."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RecoveryOptions:
    """How gradients and Hessians are recovered.

    Attributes
    ----------
    method : {"auto", "quadratic", "l2", "mixed_l2", "zz", "clement", "green"}
        See `recover_hessian`.
    mass : {"lumped", "consistent"}
        Mass matrix of the method ``l2``.
    boundary : {"auto", "one_sided", "extrapolated"}
        What the points on the boundary get: what the method finds in their one-sided patches,
        or a linear extrapolation of the values inside. "auto" extrapolates for ``l2``, ``zz``,
        ``clement`` and ``green``; ``quadratic`` is accurate in one-sided patches, and
        ``mixed_l2`` has its boundary integral.
    interfaces : bool
        Whether patches end at changes of the region and at inner facets that are listed in the
        mesh. The Hessians of the sides are then intersected, the gradients averaged.
    noise : float, optional
        Standard deviation of the values. Estimated for each field from what the smoothest
        patches leave unexplained if None; 0 means round-off only.
    """

    method: str = "auto"
    mass: str = "lumped"
    boundary: str = "auto"
    interfaces: bool = True
    noise: float | None = None

    def __post_init__(self) -> None:
        for what, value, known in (
            ("recovery method", self.method, METHODS),
            ("mass", self.mass, MASSES),
            ("boundary recovery", self.boundary, BOUNDARIES),
        ):
            if value not in known:
                raise ValueError(f"{what} must be one of {', '.join(known)}, got {value!r}")
        if self.noise is not None and not (np.isfinite(self.noise) and self.noise >= 0.0):
            raise ValueError(f"noise must be finite and at least 0, got {self.noise}")
