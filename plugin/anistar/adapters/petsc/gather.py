"""A distributed DMPlex on one process, with a metric, and back to all."""

from __future__ import annotations

import warnings
from typing import Any

from .library import PETSc, overlap

_LARGE = 2_000_000


def gathered(plex: Any, metric: Any) -> tuple[Any, Any]:
    """Return a DMPlex and its metric on the first process of its communicator.

    Warns
    -----
    RuntimeWarning
        If the mesh is so large that one process may not have the memory.

    Raises
    ------
    ValueError
        If the DMPlex has an overlap, whose cells would come twice.
    """
    if overlap(plex) > 0:
        raise ValueError("the DMPlex has an overlap: adapt it before distributeOverlap()")
    whole = plex.clone()
    partitioner = whole.getPartitioner()
    partitioner.setType(PETSc.Partitioner.Type.GATHER)
    migration = whole.distribute()
    section = _vertex_section(plex, metric)
    if migration is None:
        return whole, metric
    _, moved = whole.distributeField(migration, section, metric)
    first, end = whole.getHeightStratum(0)
    if end - first > _LARGE:
        warnings.warn(
            f"{end - first} cells are adapted on one of {plex.comm.size} processes",
            RuntimeWarning,
            stacklevel=2,
        )
    return whole, moved


def scattered(plex: Any) -> Any:
    """Distribute a DMPlex that lies on the first process over all of its communicator."""
    plex.getPartitioner().setFromOptions()
    plex.distribute()
    return plex


def _vertex_section(plex: Any, metric: Any) -> Any:
    """Return the layout of a metric: the same number of values at every vertex."""
    first, end = plex.getDepthStratum(0)
    totals = plex.comm.tompi4py().allreduce((metric.getLocalSize(), end - first), op=_add)
    size = totals[0] // totals[1]
    layout = plex.clone()
    layout.setNumFields(1)
    return layout.createSection([size], [size] + [0] * plex.getDimension())


def _add(a: tuple[int, int], b: tuple[int, int]) -> tuple[int, int]:
    return a[0] + b[0], a[1] + b[1]
