"""What a complex is made of, converted and checked one by one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from ...base.arrays import AnyArray, Floats, Ints
from ...meshes.conversion import as_int32, as_rows
from .region import Region

Names = dict[tuple[int, int], str]


def as_points(given: ArrayLike) -> Floats:
    """Return points (n, d) as a new array; raise if they are none, or one is not finite."""
    points = _as_floats(given, "points")
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise ValueError(f"points must have shape (n, 2) or (n, 3), not {points.shape}")
    if len(points) == 0:
        raise ValueError("the complex is empty: it has no points")
    _require_finite("point", points)
    return points


def as_edges(given: ArrayLike | None) -> Ints:
    """Return edges (e, 2) as a new array; raise if one joins a point to itself."""
    edges = as_rows(given, "edges", 2)
    is_loop = edges[:, 0] == edges[:, 1]
    if is_loop.any():
        at = int(np.argmax(is_loop))
        raise ValueError(f"edges[{at}] joins point {edges[at, 0]} to itself")
    return edges


def as_points_kept(given: ArrayLike | None) -> Ints:
    """Return point indices, sorted and each once."""
    kept = as_int32([] if given is None else given, "points_kept")
    if kept.ndim != 1:
        raise ValueError(f"points_kept must have shape (k,), not {kept.shape}")
    return np.unique(kept)


def as_holes(given: ArrayLike | None, dim: int) -> Floats:
    """Return places (h, d) as a new array."""
    holes = np.zeros((0, dim)) if given is None else _as_floats(given, "holes")
    if holes.size == 0:
        holes = holes.reshape(0, dim)
    if holes.ndim != 2 or holes.shape[1] != dim:
        raise ValueError(f"holes must have shape (h, {dim}), not {holes.shape}")
    _require_finite("hole", holes)
    return holes


def as_regions(given: Sequence[Region], dim: int) -> tuple[Region, ...]:
    """Return regions; raise if one is none, or its seed has not `dim` coordinates."""
    regions = tuple(given)
    for number, region in enumerate(regions):
        if not isinstance(region, Region):
            raise TypeError(f"regions[{number}] must be a Region, not {type(region).__name__}")
        if len(region.seed) != dim:
            raise ValueError(
                f"the seed of regions[{number}] has {len(region.seed)} coordinates, "
                f"the points have {dim}"
            )
    return regions


def as_names(given: Mapping[tuple[int, int], str], regions: Sequence[Region], dim: int) -> Names:
    """Return the names by (dim, tag), those of regions among them."""
    names: Names = {}
    for key, name in given.items():
        if not (isinstance(key, tuple) and len(key) == 2):
            raise TypeError(f"names must have keys (dim, tag), not {key!r}")
        if not isinstance(name, str):
            raise TypeError(f"the name of {key} must be a string, not {name!r}")
        if not 0 <= key[0] <= dim:
            raise ValueError(f"names has dimension {key[0]} in {key}, the complex has {dim}")
        names[int(key[0]), int(key[1])] = name
    for region in regions:
        if region.name is None:
            continue
        other = names.setdefault((dim, region.tag), region.name)
        if other != region.name:
            raise ValueError(f"region {region.tag} is called {other!r} and {region.name!r}")
    return names


def require_in_range(name: str, indices: AnyArray, n_points: int) -> None:
    """Raise if an index is that of no point."""
    outside = (indices < 0) | (indices >= n_points)
    if outside.any():
        raise ValueError(
            f"{name} refer to point {indices[outside][0]} (counting from 0), "
            f"there are {n_points} points"
        )


def require_different(triangles: Ints) -> None:
    """Raise if a triangle has a point twice."""
    bad = (triangles == np.roll(triangles, 1, axis=1)).any(axis=1)
    if bad.any():
        at = int(np.argmax(bad))
        raise ValueError(f"triangles[{at}] has a point twice: {tuple(triangles[at].tolist())}")


def _as_floats(given: ArrayLike, name: str) -> Floats:
    array = np.asarray(given)
    if array.dtype.kind not in "biuf":
        raise TypeError(f"{name} must be real numbers, not {array.dtype}")
    return np.array(array, dtype=np.float64, order="C")


def _require_finite(what: str, rows: Floats) -> None:
    bad = ~np.isfinite(rows).all(axis=1)
    if bad.any():
        at = int(np.argmax(bad))
        raise ValueError(f"{what} {at} is {tuple(rows[at].tolist())}, not finite")
