"""Options of the pipeline from fields to a metric."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .aliases import advice, asks_nothing, flattened, our_name, our_value
from .bounds import check_bounds
from .complexity import ELEMENTS_PER_COMPLEXITY
from .gradation import DEFAULT_FACTORS, GrowthLaw
from .normalisation import check_normalisation
from .recovery import check_method

Bound = float | NDArray[np.float64] | None


@dataclass(frozen=True, slots=True, kw_only=True)
class MetricOptions:
    """Options of `from_fields`. None means off.

    Attributes
    ----------
    target_complexity : float, optional
        Complexity of the result. Either this or `target_elements` must be given.
    target_elements : float, optional
        Number of triangles or tetrahedra to aim at, turned into a complexity by the count of
        perfect unit simplices, 2.309 or 8.49 per unit of complexity.
    p : float
        Norm of the interpolation error to minimise, from 1 to infinity.
    h_min, h_max : float or ndarray (n,), optional
        Bounds of the sizes, lengths. Without `h_max`, sizes stay below the diagonal of the
        bounding box.
    a_max : float or ndarray (n,), optional
        Largest ratio of sizes at a point.
    gradation_factor : float, None or "auto"
        Growth of sizes from one unit edge to the next; "auto" is 1.5 in 2D and 2 in 3D.
    gradation_model : {"physical", "metric", "mixed"}
        Law of the growth, see `graded`.
    max_distortion : float, optional
        Bound on ln gamma over one unit edge, see `graded` and `distortion`.
    method : {"auto", "quadratic", "l2"}
        Recovery of the Hessian, see `recover_hessian`.
    """

    target_complexity: float | None = None
    target_elements: float | None = None
    p: float = 2.0
    h_min: Bound = None
    h_max: Bound = None
    a_max: Bound = None
    gradation_factor: float | str | None = "auto"
    gradation_model: str = "mixed"
    max_distortion: float | None = None
    method: str = "auto"

    def __post_init__(self) -> None:
        if self.target_complexity is not None and self.target_elements is not None:
            raise ValueError(
                "give target_complexity or target_elements, not both: got "
                f"{self.target_complexity} and {self.target_elements}"
            )
        elements = self.target_elements
        if elements is not None and not (np.isfinite(elements) and elements > 0):
            raise ValueError(f"target_elements must be positive, got {elements}")
        check_normalisation(self.target_complexity or 1.0, self.p)
        if self.target_complexity is not None:
            check_normalisation(self.target_complexity, self.p)
        n = max((np.asarray(b).size for b in (self.h_min, self.h_max, self.a_max)), default=1)
        check_bounds(n, h_min=self.h_min, h_max=self.h_max, a_max=self.a_max)
        factor = self.gradation_factor
        if isinstance(factor, str) and factor != "auto":
            raise ValueError(f"gradation_factor must be a number, None or 'auto', got {factor!r}")
        self.growth_law(2)
        check_method(self.method)

    @classmethod
    def from_dict(cls, options: Mapping[str, Any]) -> MetricOptions:
        """Build options from a dict that may use the names of PETSc or Mmg.

        Accepted are the names above, ``dm_plex_metric_*`` or ``{"dm_plex_metric": {...}}``, and
        ``hmin hmax hgrad``. There, a gradation of -1 and an anisotropy of 0 mean off. Options that
        have no counterpart here are passed over where they ask for nothing.

        Raises
        ------
        ValueError
            If a key is unknown, or given twice under two names.
        """
        known = {field.name for field in fields(cls)}
        found: dict[str, Any] = {}
        for key, value in flattened(options):
            name = our_name(key)
            if name not in known:
                if asks_nothing(key, value):
                    continue
                raise ValueError(f"unknown metric option '{key}': {advice(key, known)}")
            if name in found:
                raise ValueError(f"metric option '{name}' is given twice, the second as '{key}'")
            found[name] = value if name == key else our_value(name, value)
        return cls(**found)

    def complexity_for(self, dim: int) -> float:
        """Return the complexity to reach in dimension `dim`.

        Raises
        ------
        ValueError
            If neither a complexity nor a number of elements was given.
        """
        if self.target_complexity is not None:
            return self.target_complexity
        if self.target_elements is not None:
            return self.target_elements / ELEMENTS_PER_COMPLEXITY[dim]
        raise ValueError("give target_complexity or target_elements, got neither")

    def gradation_for(self, dim: int) -> float | None:
        """Return the gradation factor in dimension `dim`."""
        if isinstance(self.gradation_factor, str):
            return DEFAULT_FACTORS[dim]
        return self.gradation_factor

    def growth_law(self, dim: int) -> GrowthLaw:
        """Return the law of the gradation in dimension `dim`."""
        return GrowthLaw(
            factor=self.gradation_for(dim),
            model=self.gradation_model,
            max_distortion=self.max_distortion,
        )
