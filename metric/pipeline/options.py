"""Options of the pipeline from fields to a metric."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.aliases import advice, asks_nothing, flattened, our_name, our_value
from ..base.arrays import Floats
from ..base.by_name import by_name, require_numbers
from ..laws.bounds import check_bounds
from ..laws.complexity import REAL_ELEMENTS_PER_COMPLEXITY
from ..laws.gradation import DEFAULT_FACTORS, GrowthLaw
from ..laws.normalisation import check_p, check_target
from ..recovery import RecoveryOptions
from ..sources.size_at import SizeAt
from ..tensors.combination import check_rule, check_step
from .scaling import Scale, check_scale

Bound = float | Floats | Callable[[Floats], ArrayLike] | None
TARGETS = ("target_complexity", "target_elements", "target_error")


@by_name
@dataclass(frozen=True, slots=True, kw_only=True)
class MetricOptions:
    """Options of `from_fields`. None means off.

    Attributes
    ----------
    target_complexity, target_elements, target_error : float, optional
        What to aim at, one of them. Complexity of the result. Number of triangles or
        tetrahedra, by the calibrated count of `estimate`. Largest Lp norm of the interpolation
        error of any field, by `predicted_error`, in units of the field's `scale`.
    max_elements : float, optional
        Cap on the estimated number of elements, whatever the target; the ledger says when it
        acted, and where bounds and gradation alone need more it is an error. `adapt` holds the
        mesh to it.
    p : float
        Norm of the interpolation error to minimise, from 1 to infinity.
    scale : {"complexity", "range", "std", "none"}, float, or dict of field to these
        What makes fields comparable. "complexity": each field is normalised to the target by
        itself, so that units do not matter and all get a like number of elements. Else fields
        are divided by their range (largest minus smallest value, of the component with most),
        their standard deviation, 1 ("none"), or a number, intersected, and normalised together.
        A dict gives a value for each field; "complexity" is for all or none.
    intersection_rule : {"pairwise", "john"}
        How more than two fields or components are intersected, see `intersected`.
    h_min, h_max : float, ndarray (n,) or callable, optional
        Bounds of the sizes, lengths; a callable takes the points (n, d). Without `h_max`,
        sizes stay below the diagonal of the bounding box.
    size_at : mapping of str or int to float, optional
        Largest sizes at facets, by their name or tag, from which sizes grow by the gradation
        factor; or in regions of cells, by their name: ``{"hole": 0.02}``.
    a_max : float, ndarray (n,) or callable, optional
        Largest ratio of sizes at a point.
    restrict_anisotropy_first : bool
        Apply `a_max` to the Hessians as well, before they are normalised.
    max_coarsening : float, optional
        By what factor sizes may at most grow against those of the mesh itself, before bounds and
        gradation, see `limited_coarsening`. For the repeated passes of a loop, which has an
        option for it.
    gradation_factor : float, None or "auto"
        Growth of sizes from one unit edge to the next; "auto" is 1.5 in 2D and 2 in 3D.
    gradation_model : {"physical", "metric", "mixed"}
        Law of the growth, see `graded`.
    max_distortion : float, optional
        Bound on ln gamma over one unit edge, see `graded` and `distortion`.
    method : {"auto", "quadratic", "l2", "mixed_l2", "zz", "clement", "green"}
        Recovery of the Hessian, see `recover_hessian`.
    recovery_mass, recovery_boundary, interfaces, noise
        Further options of the recovery, see `RecoveryOptions`.
    """

    target_complexity: float | None = None
    target_elements: float | None = None
    target_error: float | None = None
    max_elements: float | None = None
    p: float = 2.0
    scale: Scale = "complexity"
    intersection_rule: str = "pairwise"
    h_min: Bound = None
    h_max: Bound = None
    size_at: SizeAt | None = None
    a_max: Bound = None
    restrict_anisotropy_first: bool = False
    max_coarsening: float | None = None
    gradation_factor: float | str | None = "auto"
    gradation_model: str = "mixed"
    max_distortion: float | None = None
    method: str = "auto"
    recovery_mass: str = "lumped"
    recovery_boundary: str = "auto"
    interfaces: bool = True
    noise: float | None = None

    def __post_init__(self) -> None:
        given = {name: getattr(self, name) for name in TARGETS}
        given = {name: value for name, value in given.items() if value is not None}
        if len(given) > 1:
            found = ", ".join(f"{name} = {value}" for name, value in given.items())
            raise ValueError(f"give one target, not several: got {found}")
        for name, value in given.items():
            check_target(name, value)
        if self.max_elements is not None:
            check_target("max_elements", self.max_elements)
        for name in ("restrict_anisotropy_first", "interfaces"):
            if not isinstance(getattr(self, name), bool | np.bool_ | int):
                raise TypeError(f"{name} must be True or False, got {getattr(self, name)!r}")
        check_p(self.p)
        check_scale(self.scale)
        check_rule(self.intersection_rule)
        if self.max_coarsening is not None:
            check_step("max_coarsening", self.max_coarsening)
        bounds = {
            name: None if callable(bound) else bound
            for name in ("h_min", "h_max", "a_max")
            for bound in [getattr(self, name)]
        }
        n = max(np.asarray(bound).size for bound in bounds.values())
        check_bounds(n, **bounds)
        if self.size_at is not None and not isinstance(self.size_at, Mapping):
            raise TypeError(f"size_at must be like {{'wall': 0.02}}, got {self.size_at!r}")
        require_numbers(max_coarsening=self.max_coarsening, max_distortion=self.max_distortion)
        for called, size in (self.size_at or {}).items():
            require_numbers(**{f"size_at[{called!r}]": size})
        factor = self.gradation_factor
        if isinstance(factor, str) and factor != "auto":
            raise ValueError(f"gradation_factor must be a number, None or 'auto', got {factor!r}")
        self.growth_law(2)
        _ = self.recovery

    @property
    def recovery(self) -> RecoveryOptions:
        """Return the options of the recovery."""
        return RecoveryOptions(
            method=self.method,
            mass=self.recovery_mass,
            boundary=self.recovery_boundary,
            interfaces=self.interfaces,
            noise=self.noise,
        )

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
        return cls(**_by_our_names(options))

    @classmethod
    def chosen(cls, options: MetricOptions | None, settings: Mapping[str, Any]) -> MetricOptions:
        """Return options with settings, under the names of `from_dict`, in their place.

        Raises
        ------
        TypeError
            If `options` is something else.
        ValueError
            As `from_dict`.
        """
        if options is not None and not isinstance(options, cls):
            raise TypeError(f"options must be MetricOptions, not {type(options).__name__}")
        return (
            replace(options or cls(), **_by_our_names(settings)) if settings else options or cls()
        )

    def check_target(self) -> None:
        """Raise ValueError if the options have no target."""
        if all(getattr(self, name) is None for name in TARGETS):
            raise ValueError(f"give {', '.join(TARGETS[:-1])} or {TARGETS[-1]}, got none of them")

    @property
    def has_count(self) -> bool:
        """Whether the target is a number of vertices or elements, known before any metric."""
        return self.target_complexity is not None or self.target_elements is not None

    def complexity_for(self, dim: int) -> float:
        """Return the complexity to aim at in dimension `dim`, before any mesh is known.

        Raises
        ------
        ValueError
            If neither a complexity nor a number of elements is given.
        """
        if self.target_complexity is not None:
            return self.target_complexity
        if self.target_elements is not None:
            return self.target_elements / REAL_ELEMENTS_PER_COMPLEXITY[dim]
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


def _by_our_names(options: Mapping[str, Any]) -> dict[str, Any]:
    known = {field.name for field in fields(MetricOptions)}
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
    return found
