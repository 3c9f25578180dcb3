"""Regions that two meshes have in common."""

from __future__ import annotations

import logging
from dataclasses import dataclass

import numpy as np

from ..base.arrays import Floats, Ints
from ..meshes.mesh import Mesh

_log = logging.getLogger(__name__)


@dataclass(frozen=True, eq=False)
class Regions:
    """The regions of two meshes by number.

    Attributes
    ----------
    source, target : (m,) int32
        Number of the region of each cell.
    tags : tuple of int
        Tag of each region; empty where the meshes do not have the same tags, and are taken as
        one region each.
    unmatched : tuple of int
        Tags that only one of the meshes has, where one of them has several regions: the regions
        are then not told apart.
    """

    source: Ints
    target: Ints
    tags: tuple[int, ...]
    unmatched: tuple[int, ...] = ()

    @property
    def count(self) -> int:
        """Number of regions, at least one."""
        return max(1, len(self.tags))


def common_regions(source: Mesh, target: Mesh) -> Regions:
    """Return the regions of two meshes, matched by tag when both have the same tags."""
    tags, numbers = np.unique(source.cell_tags, return_inverse=True)
    other_tags, other_numbers = np.unique(target.cell_tags, return_inverse=True)
    if not np.array_equal(tags, other_tags):
        has_regions = max(len(tags), len(other_tags)) > 1
        unmatched = np.setxor1d(tags, other_tags).tolist() if has_regions else []
        return Regions(
            np.zeros(source.n_cells, np.int32),
            np.zeros(target.n_cells, np.int32),
            (),
            tuple(unmatched),
        )
    return Regions(
        numbers.ravel().astype(np.int32),
        other_numbers.ravel().astype(np.int32),
        tuple(int(tag) for tag in tags),
    )


def warn_of_unmatched(regions: Regions) -> None:
    """Log that regions are not told apart, and the tags that are the reason."""
    if regions.unmatched:
        listed = ", ".join(map(str, regions.unmatched))
        _log.warning(
            "only one of the two meshes has the region tags %s: fields are carried across all "
            "interfaces between regions",
            listed,
        )


def sums_by_region(values: Floats, regions: Ints, count: int) -> Floats:
    """Return the (count, ...) sums of the (m, ...) rows of each region."""
    columns = values.reshape(len(values), -1)
    sums = [
        np.bincount(regions, weights=np.ascontiguousarray(column), minlength=count)
        for column in columns.T
    ]
    return np.stack(sums, axis=1).reshape(count, *values.shape[1:])
