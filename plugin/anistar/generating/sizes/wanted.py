"""What a caller asks of the sizes of a first mesh, as one wish."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...base.arrays import Floats
from ...meshes.mesh import Mesh
from ...metric.base.mesh import diameter
from ...objects import AnyMesh
from ..first_mesh import FirstMesh
from ..options import GenerateOptions
from .widths import affordable, local_widths
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


@dataclass(frozen=True)
class Wanted:
    """What is wanted, None where anything will do, and what could not be had."""

    wish: Wish | None
    warnings: tuple[str, ...] = ()


def wanted_of(
    first: FirstMesh, size: Sizes | None, metric: Sizes | None, options: GenerateOptions
) -> Wanted:
    """Return all that a size or a metric, names, regions and widths ask for.

    Delaunay refinement has cells of any size where nothing is asked for.

    Raises
    ------
    ValueError
        If the size or the metric does not fit the geometry.
    """
    given, what = (size, "size") if metric is None else (metric, "metric")
    is_free = given is None and options.method == "remesh"
    wishes: list[Wish] = []
    on_surface = np.full(first.mesh.n_points, np.inf)
    if _is_list(given):
        on_surface = first.at_points(_sizes(np.asarray(given, dtype=np.float64), first))
    elif given is not None:
        wishes.append(_as_wish(given, what, first))
    if options.size_at:
        wishes.append(Named(_tagging(first, options), options.size_at, options.growth))
    warnings: tuple[str, ...] = ()
    if is_free if options.follow_widths is None else options.follow_widths:
        shape = first.smooth() if options.shape == "smooth" else first.mesh
        widths = local_widths(shape)
        if options.follow_widths is None:
            widths, warnings = affordable(first.mesh, widths)
        on_surface = np.minimum(on_surface, widths)
    extent = diameter(first.mesh)
    around = Surrounding(
        first=first.mesh,
        sizes=on_surface,
        in_regions={r.tag: r.size for r in first.plc.regions if r.size is not None},
        largest=extent / EDGES_PER_DIAGONAL if is_free else extent,
        growth=options.growth,
    )
    if is_free or around.asks:
        wishes.append(around)
    if not wishes and options.method == "remesh":  # all sizes that are given are infinite
        wishes.append(Uniform(extent / EDGES_PER_DIAGONAL))
    wish = Together(wishes) if len(wishes) > 1 else wishes[0] if wishes else None
    return Wanted(wish, warnings)


def _as_wish(given: Any, what: str, first: FirstMesh) -> Wish:
    """Return a function, a pair, a number or a metric at the points as a wish."""
    if callable(given):
        return Evaluated(given)
    if isinstance(given, tuple):
        return carried_from(given)
    values = np.asarray(given, dtype=np.float64)
    if values.ndim == 0:
        return Uniform(_positive(float(values), what))
    M = metric_of(values, first.plc.n_points, first.plc.dim, f"the {what}")
    return Carried(first.mesh, first.at_points(M))


def _tagging(first: FirstMesh, options: GenerateOptions) -> Callable[[Mesh], Mesh]:
    """Return what gives the meshes in between the tags of the geometry."""
    goes_by_numbers = options.method == "refine" or (
        first.plc.dim == 3 and options.shape == "polyhedron"
    )
    return first.tagged if goes_by_numbers else _as_it_is


def _is_list(given: Any) -> bool:
    """Return whether something is numbers in a row, and no pair of a mesh and what is on it."""
    if isinstance(given, tuple | list):
        return all(map(np.isscalar, given))
    return isinstance(given, np.ndarray) and given.ndim == 1


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
