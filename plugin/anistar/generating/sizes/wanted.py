"""What a caller asks of the sizes of a first mesh, as one wish."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...base.arrays import Floats
from ...meshes.mesh import Mesh
from ...metric.base.mesh import diameter
from ...objects import AnyMesh
from ..first_mesh import FirstMesh
from ..options import GenerateOptions
from .widths import local_widths
from .wishes import (
    Carried,
    Evaluated,
    Named,
    Surrounding,
    Together,
    Uniform,
    Wish,
    carried_from,
    metric_of,
)

Sizes = float | ArrayLike | Callable[[Floats], ArrayLike] | tuple[AnyMesh, Any]

#: Edges per diagonal where nothing asks for smaller ones.
EDGES_PER_DIAGONAL = 10.0


def wish_for(
    first: FirstMesh, size: Sizes | None, metric: Sizes | None, options: GenerateOptions
) -> Wish | None:
    """Return all that sizes, metric, names, regions and widths ask for, None where nothing does.

    Delaunay refinement has cells of any size where nothing is asked for.

    Raises
    ------
    ValueError
        If both a size and a metric are given, or one does not fit the geometry.
    """
    if size is not None and metric is not None:
        raise ValueError("give a size or a metric, not both: intersect them where both hold")
    given = size if metric is None else metric
    what = "size" if metric is None else "metric"
    wishes: list[Wish] = []
    on_surface = np.full(first.mesh.n_points, np.inf)
    is_free = given is None and options.method == "remesh"
    largest = diameter(first.mesh) / EDGES_PER_DIAGONAL if is_free else np.inf
    if callable(given):
        wishes.append(Evaluated(given))
    elif isinstance(given, tuple) and not all(map(np.isscalar, given)):
        wishes.append(carried_from(given))
    elif given is not None:
        values = np.asarray(given, dtype=np.float64)
        if values.ndim == 0:
            wishes.append(Uniform(_positive(float(values), what)))
        elif values.ndim == 1:
            on_surface = first.at_points(_sizes(values, first))
        else:
            M = metric_of(values, first.plc.n_points, first.plc.dim, f"the {what}")
            wishes.append(Carried(first.mesh, first.at_points(M)))
    follows = is_free if options.follow_widths is None else options.follow_widths
    if follows:
        shape = first.smooth() if options.shape == "smooth" else first.mesh
        on_surface = np.minimum(on_surface, local_widths(shape))
    if options.size_at:
        # meshes in between have numbers of facets for tags where remeshing goes by these
        is_numbered = options.method == "refine" or (
            first.plc.dim == 3 and options.shape == "polyhedron"
        )
        tagged = first.tagged if is_numbered else _as_it_is
        wishes.append(Named(tagged, options.size_at, options.growth))
    in_regions = {r.tag: r.size for r in first.plc.regions if r.size is not None}
    if np.isfinite(largest) or np.isfinite(on_surface).any() or in_regions:
        finite = on_surface[np.isfinite(on_surface)]
        far = max([*finite.tolist(), *in_regions.values()], default=largest)
        largest = min(largest, max(far, diameter(first.mesh)))
        wishes.append(Surrounding(first.mesh, on_surface, in_regions, largest, options.growth))
    if not wishes and options.method == "remesh":  # all sizes that are given are infinite
        wishes.append(Uniform(diameter(first.mesh) / EDGES_PER_DIAGONAL))
    return Together(wishes) if len(wishes) > 1 else wishes[0] if wishes else None


def _as_it_is(mesh: Mesh) -> Mesh:
    return mesh


def _positive(size: float, what: str) -> float:
    if not (np.isfinite(size) and size > 0.0):
        raise ValueError(f"the {what} must be positive and finite, got {size}")
    return size


def _sizes(values: Floats, first: FirstMesh) -> Floats:
    """Return sizes at the points of the geometry, checked; infinite ones are no wish."""
    n = first.plc.n_points
    if values.shape != (n,):
        raise ValueError(f"{len(values)} sizes are given, the geometry has {n} points")
    bad = np.flatnonzero(~(values > 0.0))
    if bad.size:
        raise ValueError(f"the size at point {bad[0]} must be positive, got {values[bad[0]]}")
    return values
