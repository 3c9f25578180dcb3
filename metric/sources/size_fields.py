"""Size fields around points, in boxes and near boundaries."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats
from ..base.mesh import AnyMesh, MeshLike, as_mesh, diameter, names_of
from ..base.names import Tag, tags_called
from ..base.vectors import norms
from ..kernels.elementary import log
from ..laws.gradation import GrowthLaw
from .distance import distance_to_facets


def size_near_points(
    mesh: AnyMesh,
    centres: ArrayLike,
    h: ArrayLike,
    *,
    radius: float = 0.0,
    growth: float | None = 1.5,
    h_far: float | None = None,
) -> Floats:
    """Sizes that are `h` within `radius` of given points and grow from there.

    Give the result to `from_sizes` to intersect it with another metric, or as `h_max`.

    Parameters
    ----------
    mesh : MeshLike or other mesh object
        The mesh at whose points the sizes are wanted.
    centres : array_like (k, d) or (d,)
        The points.
    h : float or array_like (k,)
        Size at each of them, lengths.
    radius : float
        Distance up to which the size stays.
    growth : float or None
        Factor b between the sizes of neighbouring elements: a size grows by ``ln b`` per length,
        as in `graded`. None means a jump to `h_far`.
    h_far : float, optional
        Largest size; the diagonal of the bounding box if None.

    Returns
    -------
    ndarray (n,)
        Lengths.

    Raises
    ------
    ValueError
        If a value is out of range or a shape does not fit.
    """
    mesh = as_mesh(mesh)
    d = mesh.points.shape[1]
    places = np.atleast_2d(np.asarray(centres, dtype=np.float64))
    if places.ndim != 2 or places.shape[1] != d or not np.isfinite(places).all():
        raise ValueError(f"centres must be finite points of shape (k, {d}), got {places.shape}")
    sizes = _check_sizes(h, len(places))
    result = np.full(len(mesh.points), np.inf)
    for place, size in zip(places, sizes, strict=True):
        away = norms(mesh.points - place)
        result = np.minimum(result, _grown(mesh, size, away - radius, growth, h_far))
    return result


def size_in_box(
    mesh: AnyMesh,
    low: ArrayLike,
    high: ArrayLike,
    h: float,
    *,
    growth: float | None = 1.5,
    h_far: float | None = None,
) -> Floats:
    """Sizes that are `h` in the box from `low` to `high` (d,) and grow from there.

    The other parameters, the result and the errors are those of `size_near_points`.
    """
    mesh = as_mesh(mesh)
    d = mesh.points.shape[1]
    corners = np.array([low, high], dtype=np.float64)
    if corners.shape != (2, d) or not (corners[0] <= corners[1]).all():
        raise ValueError(f"a box needs low <= high, each of {d} numbers, got {low!r} and {high!r}")
    size = _check_sizes(h, 1)[0]
    outside = np.maximum(np.maximum(corners[0] - mesh.points, mesh.points - corners[1]), 0.0)
    return _grown(mesh, size, norms(outside), growth, h_far)


def size_near_boundary(
    mesh: AnyMesh,
    tags: Tag | Sequence[Tag],
    h: float,
    *,
    growth: float | None = 1.5,
    h_far: float | None = None,
) -> Floats:
    """Sizes that are `h` on the facets with the given tags and grow with the distance to them.

    Tags may be given by name. The other parameters, the result and the errors are those of
    `size_near_points`; a tag or name that no facet has is a ValueError too.
    """
    mesh = as_mesh(mesh)
    wanted = tags_called(tags, names_of(mesh), mesh.points.shape[1] - 1, mesh.facet_tags)
    size = _check_sizes(h, 1)[0]
    facets = mesh.facets[np.isin(mesh.facet_tags, wanted)]
    away = distance_to_facets(mesh.points, mesh.points[facets])
    return _grown(mesh, size, away, growth, h_far)


def _grown(
    mesh: MeshLike, h: float, distance: Floats, growth: float | None, h_far: float | None
) -> Floats:
    """Return the size at a distance: ``h + distance ln b``, at most `h_far`."""
    GrowthLaw(factor=growth, model="physical")  # raises if the factor is no growth
    far = diameter(mesh) if h_far is None else h_far
    if not (np.isfinite(far) and far >= h):
        raise ValueError(f"h_far must be at least h = {h:g}, got {far}")
    outside = np.maximum(distance, 0.0)
    if growth is None:
        return np.where(outside > 0.0, far, h)
    return np.minimum(h + log(growth) * outside, far)


def _check_sizes(h: ArrayLike, k: int) -> Floats:
    sizes = np.asarray(h, dtype=np.float64)
    if sizes.shape not in ((), (k,)):
        raise ValueError(f"h has shape {sizes.shape} but there are {k} places")
    bad = np.flatnonzero(~(np.isfinite(sizes) & (sizes > 0.0)))
    if bad.size:
        raise ValueError(f"h must be positive and finite, got {sizes.ravel()[bad[0]]}")
    return np.broadcast_to(sizes, (k,))
