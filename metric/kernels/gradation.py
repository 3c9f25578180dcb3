"""Gradation, and the graph that it goes along."""

from __future__ import annotations

import numpy as np

from ..base.arrays import Floats
from ..base.mesh import MeshLike
from . import compiled, growth
from . import graph as graphs
from .graph import VertexGraph
from .growth import Growth


def grade(
    points: Floats,
    metric: Floats,
    graph: VertexGraph,
    *,
    model: str,
    log_factor: float,
    max_distortion: float,
    tolerance: float,
    max_rounds: int,
) -> Growth:
    """Grade `metric` along `graph`, see `growth.grade`."""
    bounds = {
        "log_factor": log_factor,
        "max_distortion": max_distortion,
        "tolerance": tolerance,
    }
    if compiled.core is None:
        return growth.grade(points, metric, graph, model=model, max_rounds=max_rounds, **bounds)
    graded, rounds, updates, converged = compiled.core.grade(
        np.ascontiguousarray(points, dtype=np.float64),
        metric,
        graph.offsets,
        graph.neighbours,
        model=model,
        max_rounds=max_rounds,
        **bounds,
    )
    return Growth(metric=graded, rounds=rounds, updates=updates, converged=converged)


def wide_graph(mesh: MeshLike) -> VertexGraph:
    """Return the graph of the edges and opposite vertices, see `graph.wide_graph`."""
    if compiled.core is None:
        return graphs.wide_graph(mesh)
    cells = np.ascontiguousarray(mesh.cells, dtype=np.int32)
    offsets, neighbours = compiled.core.wide_graph(cells, len(mesh.points))
    return VertexGraph(offsets=offsets, neighbours=neighbours)
