"""Options of `generate`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, get_args

import numpy as np

from ..metric.base.by_name import by_name, require_numbers
from ..metric.base.names import Tag
from ..remeshing.options import Callback, RemeshOptions

Method = Literal["remesh", "refine", "constrained"]
Shape = Literal["polyhedron", "smooth"]
Inside = Literal["regions", "winding", "nonzero"]
Repair = Literal["none", "orient", "stitch", "resolve"]


@by_name
@dataclass(frozen=True, slots=True, kw_only=True)
class GenerateOptions:
    """How to make the first mesh of a geometry.

    Parameters
    ----------
    method : "remesh", "refine" or "constrained"
        What follows the constrained Delaunay mesh of the geometry. "remesh": the mesher of
        `remesh`, to the sizes or the metric; the best cells. "refine": Delaunay refinement with
        bounds that are proved where facets and edges meet at angles above 90 degrees, then the
        elimination of slivers. "constrained": nothing; no point is added but those without which
        there is no such mesh.
    shape : "polyhedron" or "smooth"
        What the facets mean to `remesh`. "polyhedron": they are the domain, and each stays as it
        is. "smooth": samples of smooth surfaces between ridges, on which new points are placed.
    ridge_angle : float
        Degrees; a smooth surface has a ridge where it turns by at least this.
    inside : "regions", "winding" or "nonzero"
        What is meshed of the parts that facets cut space into, where no seed of a region says
        so. "regions": those with an odd number of walls between them and the outside. "winding":
        those around which oriented facets turn more than half, each number of turns a region of
        its own. "nonzero": all but the outside.
    repair : "none", "orient", "stitch" or "resolve"
        What may be changed of a geometry that is not valid, see `repaired`; each includes those
        before it, and the report says what was done. "none" refuses such geometries.
    bound : float, optional
        Of "refine": the largest ratio of circumradius and shortest edge, B of the theory, which
        proves an end above 2 in space, and above 1.414 in the plane; less is tried under a guard.
        None is 2 in space, and 1.15 in the plane, where angles are above 25 degrees then.
    sliver_dihedral : float
        Of "refine", in degrees: a flatter tetrahedron is a sliver. 0 eliminates none.
    size_at : mapping of str or int to float
        Largest sizes at facets (in 2D segments) and in regions, by their names, or facets by their
        tags; at facets sizes grow from there.
    growth : float
        Factor between the sizes of neighbouring edges, where sizes are not given everywhere.
    follow_widths : bool, optional
        Keep sizes below the widths of the facets, so that narrow strips get no needles. None
        does so where neither a size nor a metric is given.
    max_vertices : int, optional
        The mesh grows no further; it is valid and the report is not converged.
    max_seconds : float, optional
        The same after this wall time, once there is a constrained mesh.
    seed : int
        Of random choices.
    threads : int
        That remesh side by side; the result does not depend on it, to the last bit.
    callback : callable, optional
        ``callback(phase, fraction)`` for progress; raise in it to interrupt.
    """

    method: Method = "remesh"
    shape: Shape = "polyhedron"
    ridge_angle: float = 45.0
    inside: Inside = "regions"
    repair: Repair = "none"
    bound: float | None = None
    sliver_dihedral: float = 12.0
    size_at: Mapping[Tag, float] = field(default_factory=dict)
    growth: float = 1.5
    follow_widths: bool | None = None
    max_vertices: int | None = None
    max_seconds: float | None = None
    seed: int = 0
    threads: int = 1
    callback: Callback | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        words = {"method": Method, "shape": Shape, "inside": Inside, "repair": Repair}
        for name, kind in words.items():
            value = getattr(self, name)
            if value not in get_args(kind):
                raise ValueError(f"{name} must be one of {', '.join(get_args(kind))}: {value!r}")
        if not isinstance(self.size_at, Mapping):
            raise TypeError(
                f"size_at must be a mapping of tags or names to sizes: {self.size_at!r}"
            )
        require_numbers(bound=self.bound, sliver_dihedral=self.sliver_dihedral, growth=self.growth)
        if self.bound is not None and not (np.isfinite(self.bound) and self.bound >= 0.6):
            raise ValueError(f"bound must be at least 0.6 and finite, got {self.bound}")
        if not 0.0 <= self.sliver_dihedral < 70.0:
            raise ValueError(f"sliver_dihedral must be in [0, 70), got {self.sliver_dihedral}")
        if not (np.isfinite(self.growth) and self.growth > 1.0):
            raise ValueError(f"growth must be above 1 and finite, got {self.growth}")
        self.as_remesh_options()  # checks the others

    def as_remesh_options(
        self, *, max_seconds: float | None = None, agreement: bool | Literal["auto"] = "auto"
    ) -> RemeshOptions:
        """Return what `remesh` is told; the facets of polyhedra are told apart by their tags."""
        return RemeshOptions(
            shape="smooth" if self.shape == "smooth" else "faceted",
            ridge_angle=self.ridge_angle,
            agreement=agreement,
            max_refinement=None,
            max_vertices=self.max_vertices,
            max_seconds=self.max_seconds if max_seconds is None else max_seconds,
            seed=self.seed,
            threads=self.threads,
            callback=self.callback,
        )
