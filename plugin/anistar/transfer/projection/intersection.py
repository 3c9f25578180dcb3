"""The intersection of two meshes: matrices between their points and between their cells."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import bsr_array, csr_array

from ... import _core
from ...base.arrays import Bools, Floats
from ...base.progress import task
from ...meshes.mesh import Mesh
from ...meshes.topology import cell_volumes
from ..regions import Regions, common_regions, sums_by_region
from ..report import Coverage

# Meshes whose regions differ by less than this part of their volume are of the same domain: a
# cell counts as uncovered beyond the same part, which is what clipping is good to at an aspect
# ratio of 1e6.
SAME_DOMAIN = 1e-9

Sparse = csr_array | bsr_array
Progress = Callable[[str, float], object]


@dataclass(frozen=True, eq=False)
class Supermesh:
    """Integrals over the intersections of the cells of two meshes.

    Source volume is what its region gives to the cells of the same region of the target. Where
    the source leaves target volume uncovered, that volume is given to the nearest source cell,
    so that the rows of every matrix sum to the moments of the target.

    Attributes
    ----------
    source, target : Mesh
        The two meshes.
    regions : Regions
        Their common regions.
    points : (n_target, n_source) csr_array or None
        Integrals of the products of hat functions.
    cells : (m_target, m_source) csr_array
        Volumes of the intersections of the cells.
    blocks : bsr_array or None
        Integrals of the products of the barycentric coordinates of the cells, with one block
        ``(d + 1, d + 1)`` for each intersection.
    loads : (m_target * (d + 1), c) float64
        Integrals of the nodal values that were given, times the barycentric coordinates of each
        target cell.
    uncovered : (m_target,) float64
        Volume of each target cell that the source leaves uncovered.
    distance : (m_target,) float64
        From the middle of the uncovered volume to the source, 0 where there is none.
    covered : (m_source,) float64
        Volume of each source cell that the target covers.

    References
    ----------
    [1] P. E. Farrell, M. D. Piggott, C. C. Pain, G. J. Gorman, C. R. Wilson, Conservative
        interpolation between unstructured meshes via supermesh construction, Comput. Methods
        Appl. Mech. Engrg. 198 (2009).
    """

    source: Mesh
    target: Mesh
    regions: Regions
    points: csr_array | None
    cells: csr_array
    blocks: bsr_array | None
    loads: Floats
    uncovered: Floats
    distance: Floats
    covered: Floats

    def matrix(self, on: str) -> Sparse:
        """Return the matrix for values on points, cells or cell_nodes."""
        made = {"points": self.points, "cells": self.cells, "cell_nodes": self.blocks}[on]
        assert made is not None, f"the supermesh was made without the matrix for {on}"
        return made

    def coincides(self) -> Bools:
        """Tell for each common region whether both meshes cover the same place."""
        count = self.regions.count
        target = cell_volumes(self.target.points, self.target.cells)
        source = cell_volumes(self.source.points, self.source.cells)
        size = sums_by_region(source, self.regions.source, count)
        gap = sums_by_region(self.uncovered, self.regions.target, count)
        rest = np.abs(sums_by_region(source - self.covered, self.regions.source, count))
        other = np.abs(sums_by_region(target, self.regions.target, count) - size)
        return np.asarray(np.maximum(np.maximum(gap, rest), other) <= SAME_DOMAIN * size)

    def coverage(self) -> Coverage:
        """Return how well the meshes cover each other."""
        target = cell_volumes(self.target.points, self.target.cells)
        source = cell_volumes(self.source.points, self.source.cells)
        rest = np.maximum(source - self.covered, 0.0)
        rest[rest <= SAME_DOMAIN * source] = 0.0
        return Coverage(
            cells=int(np.count_nonzero(self.uncovered)),
            volume=float(self.uncovered.sum() / target.sum()),
            worst=float((self.uncovered / target).max()),
            source_volume=float(rest.sum() / source.sum()),
            max_distance=float(self.distance.max()),
        )


def supermesh(
    source: Mesh,
    target: Mesh,
    *,
    points: bool = True,
    blocks: bool = False,
    nodal: Floats | None = None,
    threads: int = 1,
    callback: Progress | None = None,
) -> Supermesh:
    """Intersect two meshes.

    Parameters
    ----------
    source, target : Mesh
        Two meshes of the same dimension; cells are intersected within regions of equal tag, or
        all with all when the tags of the two meshes are not the same.
    points, blocks : bool
        Whether the matrices of these names are wanted. A block takes 72 bytes for each
        intersection in 2D, 128 in 3D.
    nodal : (m_source * (d + 1), c) float64, optional
        Values at the corners of the source's cells whose loads are wanted: what `blocks` would
        give, in one pass and without their memory.
    threads : int
        The result does not depend on it.
    callback : callable, optional
        ``callback(phase, fraction)`` is called now and then; what it raises stops the call.

    Returns
    -------
    Supermesh
    """
    regions = common_regions(source, target)
    intersect = _core.supermesh2 if source.dim == 2 else _core.supermesh3
    with task("intersect") as line:
        made = intersect(
            np.ascontiguousarray(source.points),
            np.ascontiguousarray(source.cells),
            regions.source,
            np.ascontiguousarray(target.points),
            np.ascontiguousarray(target.cells),
            regions.target,
            np.zeros((0, 0)) if nodal is None else np.ascontiguousarray(nodal),
            points=points,
            blocks=blocks,
            threads=threads,
            callback=line.callback(callback),
        )
    starts, columns, volumes = made["pairs"]
    shape, width = (target.n_cells, source.n_cells), source.dim + 1
    block_shape = (shape[0] * width, shape[1] * width)
    return Supermesh(
        source=source,
        target=target,
        regions=regions,
        points=_csr(made["points"], (target.n_points, source.n_points)) if points else None,
        cells=csr_array((volumes, columns, starts), shape=shape),
        blocks=bsr_array((made["blocks"], columns, starts), shape=block_shape) if blocks else None,
        loads=made["loads"],
        uncovered=made["uncovered"],
        distance=made["distance"],
        covered=made["covered"],
    )


def _csr(rows: tuple[Floats, Floats, Floats], shape: tuple[int, int]) -> csr_array:
    starts, columns, values = rows
    return csr_array((values, columns, starts), shape=shape)
