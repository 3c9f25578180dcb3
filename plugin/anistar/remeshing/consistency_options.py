"""The parameters of the algorithms that refine until every star agrees."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

import numpy as np

from .. import _core
from ..metric.base.by_name import by_name


@by_name
@dataclass(frozen=True, slots=True, kw_only=True)
class ConsistencyOptions:
    """Parameters of Algorithms 2 to 5, named as in Boissonnat, Wormser, Yvinec, RR-7712 v2.

    The rules are those of Algorithm 4, where Algorithm 2 has the rules on cells alone.

    Parameters
    ----------
    alpha_0 : float
        Rule 4 refines a cell whose circumradius is at least ``alpha_0 * sf``; the sizing
        field sf is 1 in the metric, less where ``gamma_0`` asks for it. A unit equilateral
        triangle has .577, so .95 leaves a quasi-unit mesh alone.
    alpha_1 : float, optional
        The same for facets of surfaces and their surface balls (rule 1); half of `alpha_0` by
        default. In 2D, and in 3D with ``until_consistent=True``, only facets that are not
        consistent are refined. The proof of termination (Theorem 7.1) asks for less than 1/40.
    rho_0 : float
        Rules 3 and 5: largest radius-edge ratio; above sqrt 2, the classical bound for termination.
    sigma_0 : float
        Rule 6: smallest sliverity. In 2D a triangle that passes rule 5 is never a sliver;
        a regular tetrahedron has .49.
    gamma_0 : float or None
        Bound on the distortion within an element, through the sizing field. None, the
        default, is off: measured, it only adds points.
    delta : float
        Radius of the picking region relative to the circumradius.
    beta : float
        New quasi-cospherical configurations count up to ``beta`` circumradii.
    candidates : int
        Points that pick_valid tries before it takes the best one.
    max_growth : float
        The run stops when it has added this fraction of vertices.
    protecting_balls : bool
        How ``until_consistent="pure"`` keeps ridges in 3D. False halves an edge of a ridge where a
        point encroaches upon it, which can go on for ever where surfaces meet at less than 90
        degrees in the metric. True gives the points of ridges balls that no other point may
        enter: the stars are those of weighted sites then, and `certify`, which knows no
        weights, does not find all of them near ridges. Where ridges would get more than 4096
        balls, they get none.
    """

    alpha_0: float = 0.95
    alpha_1: float | None = None
    rho_0: float = 1.5
    sigma_0: float = 0.05
    gamma_0: float | None = None
    delta: float = 0.4
    beta: float = 2.0
    candidates: int = 16
    max_growth: float = 1.0
    protecting_balls: bool = False

    def __post_init__(self) -> None:
        for name in ("alpha_0", "rho_0", "sigma_0", "beta", "max_growth"):
            if not getattr(self, name) > 0:
                raise ValueError(f"{name} must be positive, got {getattr(self, name)}")
        if self.alpha_1 is not None and not self.alpha_1 > 0:
            raise ValueError(f"alpha_1 must be positive, got {self.alpha_1}")
        if not 0 < self.delta < 1:
            raise ValueError(f"delta must be in (0, 1), got {self.delta}")
        if self.gamma_0 is not None and not self.gamma_0 > 1:
            raise ValueError(f"gamma_0 must be above 1, got {self.gamma_0}")
        if not isinstance(self.candidates, int | np.integer):
            raise TypeError(f"candidates must be an integer, got {self.candidates!r}")
        if not isinstance(self.protecting_balls, bool | np.bool_):
            raise TypeError(f"protecting_balls must be a bool, got {self.protecting_balls!r}")
        if self.candidates < 1:
            raise ValueError(f"candidates must be at least 1, got {self.candidates}")

    def as_parameters(self) -> _core.ConsistencyParameters:
        """Return the parameters for the core, where a bound that is off is infinite."""
        parameters = _core.ConsistencyParameters()
        for name, value in asdict(self).items():
            setattr(parameters, name, math.inf if value is None else value)
        parameters.alpha_1 = 0.5 * self.alpha_0 if self.alpha_1 is None else self.alpha_1
        return parameters
