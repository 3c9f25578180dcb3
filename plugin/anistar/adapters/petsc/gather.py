"""A distributed DMPlex on one process, with a metric, and back to all."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...base.arrays import Floats
from .library import PETSc


def gathered(plex: Any, metric: Floats) -> tuple[Any, Floats]:
    """Return a DMPlex and its metric on the first process of its communicator.

    Collective.

    Parameters
    ----------
    plex : petsc4py.PETSc.DMPlex
        Without an overlap, whose cells would come twice.
    metric : (n, d, d) float64
        At the n vertices that this process has.

    Returns
    -------
    plex : petsc4py.PETSc.DMPlex
        Empty on all but the first process.
    metric : (n, d, d) float64
        At its vertices.
    """
    whole = plex.clone()
    whole.getPartitioner().setType(PETSc.Partitioner.Type.GATHER)
    migration = whole.distribute()
    if migration is None:
        return whole, metric
    values = PETSc.Vec().createMPI((metric.size, PETSc.DECIDE), comm=plex.comm)
    values.setArray(metric.ravel())
    _, moved = whole.distributeField(migration, _vertex_section(plex), values)
    dim = plex.getDimension()
    return whole, np.array(moved.getArray(readonly=True)).reshape(-1, dim, dim)


def scattered(plex: Any) -> Any:
    """Distribute a DMPlex that lies on the first process over all of its communicator."""
    plex.getPartitioner().setFromOptions()
    plex.distribute()
    return plex


def _vertex_section(plex: Any) -> Any:
    """Return the layout of a metric: one tensor at every vertex."""
    dim = plex.getDimension()
    layout = plex.clone()
    layout.setNumFields(1)
    return layout.createSection([dim * dim], [dim * dim] + [0] * dim)
