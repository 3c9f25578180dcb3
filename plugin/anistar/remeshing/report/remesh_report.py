"""What a remeshing did, and how good its result is."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from ... import _core
from ..._core import ConsistencyStop, StopReason
from ...base.arrays import Floats
from ...judging.certificate import Certificate, share_of
from ...meshes.mesh import Mesh
from ...metric.base.told import Told
from ...metric.laws.refinement import Refinement
from .bad_cells import BadCell, quality_bound, worst_cells
from .fidelity import SurfaceDeviation, TagMeasure, shape_warnings
from .long_edges import LONG_EDGE, LongEdge, longest_edges
from .verdict import agreement_text, verdict_of


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class RemeshReport(Told):
    """What `remesh` did and how good the result is.

    Attributes
    ----------
    converged : bool
        The run ended by itself, not by a budget; with ``until_consistent`` also: every star
        agrees.
    stop_reason : str
        ``finished``, ``max_vertices``, ``max_seconds`` or ``max_refinement``.
    limited : dict of str to float
        Where `max_refinement` acted: ``share`` of the points of the given mesh, and ``excess``,
        the factor by which the sizes asked for were below the bound at most (1: nowhere). The
        figures of this report are then in the metric with the limit.
    n_points, n_cells : int
        Size of the new mesh.
    statistics : dict
        ``edge_unit`` (fraction of edges within [1/sqrt 2, sqrt 2]), ``edge_min``, ``edge_mean``,
        ``edge_max``, ``edge_bins`` and ``edge_histogram``; ``q_min``, ``q_mean`` and
        ``q_histogram`` of the mean ratio, all in `Remeshed.metric`.
    kept_quality : float
        Least mean ratio of the input in the given metric, but .2 at most: no cell of the new mesh
        should be worse.
    n_bad_cells : int
        Cells whose mean ratio is below `kept_quality`, or below 1e-3: what no operation could
        improve.
    bad_cells : tuple of BadCell
        The worst of them, ten at most: row, quality and place.
    long_edges : tuple of LongEdge
        Edges longer than 2 in the metric, the ten longest at most: ends, length and place.
    agreement : str
        ``done``, ``off``, or ``skipped:`` and why; in 3D also how many facets were left, some of
        which the certificate may have mended since, and why the rounds ended.
    consistency : dict
        Vertices inserted by each rule, for cells (``size``, ``radius_edge``, ``sliver``,
        ``inconsistency``) and for facets of surfaces (``facet_size``, ``facet_topology``,
        ``facet_radius_edge``, ``facet_inconsistency``), points for cells that became points of
        surfaces (``boundary``), ``rounds`` (of star sets in 3D: insertions), ``stop_reason``, and
        ``ln_gamma_p90``: 10 % of the edges of the cells that still fail have a larger ln gamma
        between the metrics at their ends (0 when none fails). Compare it with `distortion`.
    simplex_ok, star_ok : float or None
        Certified fractions of the cells and of the stars of the mesh that came back (see
        `certify`, which costs next to nothing then); where `max_refinement` has limited the
        metric, in the metric that this mesh could reach. None where neither agreement nor
        consistency was asked for or a budget had stopped the run, and in 3D also where "auto"
        skipped agreement.
    surface_star_ok : float or None
        Certified fraction of the surface stars, those of the vertices of facets; None where
        `star_ok` is.
    verdict : str
        That of the certificate in one line, with what agreement came to where stars fail; or why
        there is no certificate.
    distortion : dict of str to float
        Quantiles of ln gamma, the distortion of the metric along the edges.
    tags : tuple of TagMeasure
        Measure of every facet and region tag against the geometry and against the smooth shape
        through its points.
    deviations : tuple of SurfaceDeviation
        How far the new vertices of curves and curved surfaces lie from the given facets, for every
        facet tag; empty where all are straight, and with `project`, whose shape is its own.
    warnings : tuple of str
        Where the shape of the new mesh may not be what is meant: a deviation that no smooth shape
        has, or a measure that changed by more than 1 %; and that a budget ended the work.
    counts : dict of str to float
        Operations made; ``consistency_moves`` are the vertices that Algorithm 2 moved in 3D, and
        ``star_set_sites`` those of the star set when ``until_consistent="pure"`` ended there;
        ``protected_corners`` and ``unprotected_corners`` are sharp corners whose
        legs have equal lengths, and those without a common one. ``disagreeing_before`` and
        ``disagreeing_after`` count the facets about which the metrics of the vertices of their
        two cells disagree, around the agreement phase. ``star_failures`` are the cells that the
        certificate refused after it, ``star_moves`` the moves that mended some of them. In 3D
        ``curved`` is 1 when some surface or ridge is curved.
    seconds : dict of str to float
        Wall time of each phase.
    reading : tuple of str
        What was changed of the mesh object or file to read it, such as cells that were split or
        curved edges that became the geometry; empty for a `Mesh`.
    """

    converged: bool
    stop_reason: str
    limited: dict[str, float]
    n_points: int
    n_cells: int
    statistics: dict[str, Any]
    kept_quality: float
    n_bad_cells: int
    bad_cells: tuple[BadCell, ...]
    long_edges: tuple[LongEdge, ...]
    agreement: str
    consistency: dict[str, Any]
    simplex_ok: float | None
    star_ok: float | None
    surface_star_ok: float | None
    verdict: str
    distortion: dict[str, float]
    tags: tuple[TagMeasure, ...]
    deviations: tuple[SurfaceDeviation, ...]
    warnings: tuple[str, ...]
    counts: dict[str, float]
    seconds: dict[str, float]
    reading: tuple[str, ...] = ()

    def _figures(self) -> dict[str, Any]:
        figures = {
            "points": self.n_points,
            "cells": self.n_cells,
            "edge_unit": self.statistics["edge_unit"],
            "q_min": self.statistics["q_min"],
            "star_ok": self.star_ok,
            "seconds": sum(self.seconds.values()),
        }
        if not self.converged:
            figures["stop_reason"] = self.stop_reason
        if self.warnings:
            figures["warnings"] = len(self.warnings)
        return figures

    def _table(self) -> tuple[tuple[str, ...], list[tuple[Any, ...]]]:
        rows = [(t.name or t.tag, t.dim, t.before, t.after, t.change) for t in self.tags]
        return ("tag", "dim", "before", "after", "change"), rows

    def as_dict(self) -> dict[str, Any]:
        """Return the report as JSON builtins."""
        out = asdict(self)
        out["tags"] = [tag.as_dict() for tag in self.tags]
        out["deviations"] = [it.as_dict() for it in self.deviations]
        out["warnings"] = list(self.warnings)
        out["long_edges"] = [edge.as_dict() for edge in self.long_edges]
        out["bad_cells"] = [{**asdict(bad), "place": list(bad.place)} for bad in self.bad_cells]
        return out


def report_of(
    made: _core.RemeshResult,
    new: Mesh,
    metric: Floats,
    *,
    ramp: Refinement,
    certificate: Certificate | None,
    tags: tuple[TagMeasure, ...],
    deviations: tuple[SurfaceDeviation, ...],
) -> RemeshReport:
    """Return the report on what the core made, and on its shape beside the geometry.

    Parameters
    ----------
    made : RemeshResult
    new : Mesh
        The mesh in it, in the coordinates of the caller.
    metric : (n, d, d) float64
        At its points, within the limit of refinement.
    ramp : Refinement
        That limit.
    certificate : Certificate or None
        Of the mesh in it.
    tags : tuple of TagMeasure
    deviations : tuple of SurfaceDeviation
    """
    n_bad: int = 0
    bad: tuple[BadCell, ...] = ()
    bound = quality_bound(made.kept_quality)
    statistics = made.statistics
    if not statistics["q_min"] >= bound:
        n_bad, bad = worst_cells(new, metric, bound)
    is_long = statistics["edge_max"] > LONG_EDGE
    stop_reason = _stop_reason(made, ramp)
    agreement = agreement_text(made.agreement, new.dim)
    return RemeshReport(
        converged=stop_reason == "finished"
        and made.consistency_stop in (ConsistencyStop.none_yet, ConsistencyStop.consistent),
        stop_reason=stop_reason,
        limited={"share": float(ramp.is_limited.mean()), "excess": ramp.excess},
        n_points=new.n_points,
        n_cells=new.n_cells,
        statistics=statistics,
        kept_quality=made.kept_quality,
        n_bad_cells=n_bad,
        bad_cells=bad,
        long_edges=longest_edges(new, metric) if is_long else (),
        agreement=agreement,
        consistency={**made.consistency, "stop_reason": _consistency_stop(made)},
        simplex_ok=made.certified.simplex_ok if made.certified else None,
        star_ok=made.certified.star_ok if made.certified else None,
        surface_star_ok=share_of(*certificate.surface_stars) if certificate else None,
        verdict=verdict_of(made, certificate, agreement),
        distortion=made.distortion,
        tags=tags,
        deviations=deviations,
        warnings=(
            *_budget_warnings(stop_reason, statistics["edge_max"]),
            *shape_warnings(tags, deviations),
        ),
        counts={name: float(count) for name, count in made.counts.items()},
        seconds=made.seconds,
    )


def _budget_warnings(stop_reason: str, longest: float) -> tuple[str, ...]:
    """Return that a budget ended the work before the mesh was what the metric asks for."""
    if stop_reason not in (StopReason.max_vertices.name, StopReason.max_seconds.name):
        return ()
    return (
        f"stopped by {stop_reason}: this is not the mesh that the metric asks for, its longest "
        f"edge has the length {longest:.3g} there",
    )


def _stop_reason(made: _core.RemeshResult, ramp: Refinement) -> str:
    if ramp.is_limited.any() and made.stop_reason is StopReason.finished:
        return "max_refinement"
    return made.stop_reason.name


def _consistency_stop(made: _core.RemeshResult) -> str:
    """Return why it ended, empty where it was not asked for."""
    stop = made.consistency_stop
    return "" if stop is ConsistencyStop.none_yet else stop.name
