"""What `generate` did, and how good its mesh is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...base.report import as_builtin
from ...metric.base.told import Told
from ...remeshing.report import RemeshReport
from .measures import FacetMeasures
from .shapes import CellShapes


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class GenerateReport(Told):
    """What `generate` did and how good the result is.

    Attributes
    ----------
    method : str
        ``remesh``, ``refine`` or ``constrained``.
    converged : bool
        The run ended by itself, not by a budget or a guard.
    stop_reason : str
        ``finished``, ``max_vertices``, ``max_seconds``, or the name of another guard.
    n_points, n_cells : int
        Size of the mesh.
    shapes : CellShapes
    measures : FacetMeasures
        Facets and regions of the mesh against those of the geometry.
    repair : dict
        What was changed of the geometry, by kind; empty with ``repair="none"``.
    constrained : dict of str to int
        Counts of the constrained Delaunay mesh: Steiner points, facets recovered and the like.
    refinement : dict
        Of ``method="refine"``: points by rule, refusals by name, what stays encroached and why.
    remeshing : tuple of RemeshReport
        Of ``method="remesh"``: the report of each pass.
    warnings : tuple of str
    seconds : dict of str to float
        Wall time of each step.
    reading : tuple of str
        What was changed or left out to read the geometry.
    """

    method: str
    converged: bool
    stop_reason: str
    n_points: int
    n_cells: int
    shapes: CellShapes
    measures: FacetMeasures
    repair: dict[str, Any]
    constrained: dict[str, int]
    refinement: dict[str, Any]
    remeshing: tuple[RemeshReport, ...]
    warnings: tuple[str, ...]
    seconds: dict[str, float]
    reading: tuple[str, ...] = ()

    def _figures(self) -> dict[str, Any]:
        figures = {
            "method": self.method,
            "points": self.n_points,
            "cells": self.n_cells,
            "least_angle": self.shapes.angle_min,
            "radius_edge": self.shapes.radius_edge_max,
            "seconds": sum(self.seconds.values()),
        }
        if not self.converged:
            figures["stop_reason"] = self.stop_reason
        if self.warnings:
            figures["warnings"] = len(self.warnings)
        return figures

    def as_dict(self) -> dict[str, Any]:
        """Return the report as JSON builtins."""
        return {name: as_builtin(getattr(self, name)) for name in self.__slots__}
