"""Sizes at parts of a mesh that are called by name."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..base.arrays import Floats
from ..base.mesh import MeshLike, names_of
from ..base.names import Tag, tags_called, unknown_name
from .size_fields import size_near_boundary

SizeAt = Mapping[Tag, float]


def sizes_at(mesh: MeshLike, sizes: SizeAt, growth: float | None) -> Floats:
    """Return the largest size (n,) that each point may have.

    Parameters
    ----------
    mesh : MeshLike
        Its attribute ``names``, if it has one, says what tags are called.
    sizes : mapping of str or int to float
        Sizes, lengths, by the name or the tag of facets, or by the name of cells. On facets the
        size grows from there; in a region of cells it ends with the region.
    growth : float or None
        As in `size_near_boundary`.

    Raises
    ------
    ValueError
        If no facets and no cells are called so, or a size is not positive.
    """
    result = np.full(len(mesh.points), np.inf)
    dim, names = mesh.points.shape[1], names_of(mesh)
    for called, h in sizes.items():
        if not (np.isfinite(h) and h > 0.0):
            raise ValueError(f"the size at {called!r} must be positive and finite, got {h}")
        dims = {d for (d, _), name in names.items() if name == called}
        if isinstance(called, str) and not dims & {dim, dim - 1} and not called.isdecimal():
            both = {(dim, k): name for k, name in enumerate(names.values())}
            raise ValueError(unknown_name(called, both, dim, "facet or region"))
        if dim in dims:
            tags = tags_called(called, names, dim, mesh.cell_tags, kind="cell")
            inside = mesh.cells[np.isin(mesh.cell_tags, tags)]
            result[inside] = np.minimum(result[inside], h)
        if dim not in dims or dim - 1 in dims:
            near = size_near_boundary(mesh, called, h, growth=growth)
            result = np.minimum(result, near)
    return result
