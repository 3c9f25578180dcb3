"""Run a harsh case and judge everything that comes back, with judges of our own."""

import re
import time
import warnings
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from exact_judge import EPSILON, eigenvalue_ratios, mesh_problem
from fuzz_cases import PLACES
from harsh_cases import STRAIGHT
from meshes import certified_anew
from volume_cases import euler

import anistar
from anistar.metric import MetricError, check_metric

REFUSED_ABOVE = 1e14
"""Eigenvalue ratio that the door refuses."""

LATE = 6.0
"""Seconds, by the clock and of this process, that a call may take beyond its `max_seconds`."""

RIGHT_ANGLED = (
    *("checkerboard", "comb", "strip", "layers", "holes"),
    *("pinched", "plate", "voxels", "l-shape"),
)
"""Kinds made of boxes. Others may turn by less than any ridge angle: there a curve is read."""


@dataclass
class Verdict:
    """What became of a case: `ok`, `refused`, or the kind of failure, and the words for it."""

    verdict: str = "ok"
    message: str = ""
    step: str = ""
    ratio: float = 0.0
    n_points: int = 0
    stop: str = ""
    warned: str = ""


UNBOUNDED = 30.0
"""Seconds for a call that takes no `max_seconds`; all are small."""


class VerdictError(Exception):
    """A verdict that ends the case."""

    def __init__(self, verdict, message):
        super().__init__(message)
        self.verdict = verdict


def run_harsh_case(case):
    """Do what the case asks for and return the verdict."""
    found = Verdict(ratio=case.ratio)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            _steps(case, found)
        except VerdictError as failure:
            found.verdict, found.message = failure.verdict, str(failure)
    if caught:
        found.warned = f"{caught[0].message} in {Path(caught[0].filename).name}"
    return found


def _steps(case, found):
    M = case.metric
    if case.before:
        found.step = case.before
        M = _called(case, lambda: BEFORE[case.before](case.mesh, M))
        _judge_metric(M)
    done = _remeshed(case, found, "remesh", case.mesh, M, case.options)
    found.n_points, found.stop = done.mesh.n_points, done.report.stop_reason
    found.step = "certify"
    _called(case, lambda: certified_anew(done))
    if case.repeated and "max_seconds" not in found.stop:
        options = replace(case.options, threads=1 + case.options.threads % 2)
        other = _remeshed(case, found, "repeat", case.mesh, M, options)
        if "max_seconds" not in other.report.stop_reason and not _same_bytes(done, other):
            raise VerdictError("differs", "another number of threads gives other bytes")
    if case.again:
        _remeshed(case, found, "again", done.mesh, done.metric, case.options)
    found.step = ""


BEFORE = {
    "graded": lambda mesh, M: anistar.metric.graded(mesh, M, factor=1.5),
    "bounded": lambda mesh, M: anistar.metric.bounded(M, a_max=1e3),
    "intersected": lambda mesh, M: anistar.metric.intersected(M, M[::-1].copy()),
}


def _remeshed(case, found, step, mesh, M, options):
    found.step = step
    limit = UNBOUNDED if options.max_seconds is None else options.max_seconds + LATE
    done = _called(
        case, lambda: anistar.remesh(mesh, M, options, geometry=case.geometry), limit=limit
    )
    _judge_metric(done.metric)
    _judge_mesh(case, done)
    return done


def _called(case, function, *, limit=UNBOUNDED):
    """Return what a function returns; tell refusals that the contract allows from the others."""
    clock, used = time.monotonic(), time.process_time()
    try:
        return _answered(case, function)
    finally:
        took = min(time.monotonic() - clock, time.process_time() - used)
        if took > limit:
            raise VerdictError("late", f"took {took:.1f} s, more than {limit:g}")


def _answered(case, function):
    try:
        return function()
    except np.linalg.LinAlgError as error:
        raise VerdictError("exception", f"LinAlgError: {error}") from error
    except MemoryError as error:
        raise VerdictError("refused", f"MemoryError: {error}") from error
    except (anistar.MeshingError, ValueError) as error:
        raise _refusal(case, error) from error
    except Exception as error:
        raise VerdictError("exception", f"{type(error).__name__}: {error}") from error


def _refusal(case, error):
    """A refusal names a place and a value; what can be held is not refused at the door."""
    text = f"{type(error).__name__}: {error}"
    names_a_place = any(place in text for place in PLACES) or "memory" in text
    if not names_a_place or not re.search(r"\d", text):
        return VerdictError("unclear", f"names no place or no value: {text}")
    is_held = case.ratio < 0.1 * REFUSED_ABOVE and "out of range" not in text
    if isinstance(error, MetricError) and is_held and not case.before:
        return VerdictError("unfounded", f"the ratio is {case.ratio:.1e} only: {text}")
    is_bounded = case.options.max_vertices is not None
    if is_bounded and ("max_vertices" in text or "more than there may be" in text):
        return VerdictError("budget", text)
    return VerdictError("refused", text)


def _judge_metric(M):
    """The tensors that come back are finite, positive definite, and taken as a metric again."""
    if not np.isfinite(M).all():
        point = int(np.flatnonzero(~np.isfinite(M).all(axis=(1, 2)))[0])
        raise VerdictError("metric", f"the tensor at point {point} is {M[point].tolist()}")
    ratios = eigenvalue_ratios(M)
    if not np.isfinite(ratios).all():
        point = int(np.flatnonzero(~np.isfinite(ratios))[0])
        raise VerdictError("metric", f"not definite at point {point}: {M[point].tolist()}")
    try:
        check_metric(M)
    except ValueError as error:
        raise VerdictError("metric", f"what came back is refused: {error}") from error


def _judge_mesh(case, done):
    problem = mesh_problem(done.mesh)
    if problem:
        raise VerdictError("invalid", problem)
    violations = anistar.validate(done.mesh)
    if violations:
        raise VerdictError("invalid", f"validate says: {violations[0].message}")
    for judge in (_tags, _topology, _corners, _frozen, _measures, _report):
        problem = judge(case, done)
        if problem:
            raise VerdictError("changed", problem)


def _tags(case, done):
    for name in ("cell_tags", "facet_tags", "edge_tags"):
        got, want = (set(getattr(m, name).tolist()) for m in (done.mesh, case.geometry))
        if got != want and not (name == "edge_tags" and case.geometry.dim == 2):
            return f"{name} differ: lost {sorted(want - got)[:5]}, new {sorted(got - want)[:5]}"
    return ""


def _parts(mesh, name):
    """Simplices of one dimension by tag."""
    rows, tags = getattr(mesh, f"{name}s"), getattr(mesh, f"{name}_tags")
    return {tag: rows[tags == tag] for tag in np.unique(tags).tolist()}


def _topology(case, done):
    """Regions and surfaces keep their Euler characteristics."""
    for name in ("cell", "facet"):
        got, want = (_parts(m, name) for m in (done.mesh, case.geometry))
        for tag, rows in want.items():
            if euler(got[tag]) != euler(rows):
                return f"{name} tag {tag} had Euler characteristic {euler(rows)}: {euler(got[tag])}"
    return ""


def _corners(case, done):
    have = set(map(tuple, done.mesh.points[done.mesh.corners].tolist()))
    for corner in case.geometry.points[case.geometry.corners].tolist():
        if tuple(corner) not in have:
            return f"the corner at {corner} is lost"
    return ""


def _frozen(case, done):
    """Frozen facets are there bit by bit, and no others with their tags."""
    for tag in case.options.frozen_tags:
        got, want = (
            {
                tuple(sorted(map(tuple, corners)))
                for corners in m.points[m.facets[m.facet_tags == tag]].tolist()
            }
            for m in (done.mesh, case.geometry)
        )
        if got != want:
            return f"frozen tag {tag}: {len(want - got)} facets lost, {len(got - want)} new"
    return ""


def _measures(case, done):
    """Without curves every tag keeps its length, area or volume to round-off."""
    if case.options.ridge_angle != STRAIGHT:
        return ""
    geometry = case.geometry
    centre = geometry.points.mean(axis=0)
    rounding = 64 * EPSILON * np.abs(geometry.points).max()
    extent = np.ptp(geometry.points, axis=0).max()
    # Rounded ends turn a short side; by less than the ridge angle it is read as a curve.
    slightest = extent * np.radians(STRAIGHT)
    turned = rounding * extent / _shortest(geometry.points, geometry.facets)
    rounding += min(slightest, turned) if case.kind in RIGHT_ANGLED else slightest
    for name in ("facet", "cell"):
        got, want = (_parts(m, name) for m in (done.mesh, geometry))
        for tag, rows in want.items():
            before = _measure(geometry.points - centre, rows)
            after = _measure(done.mesh.points - centre, got[tag])
            slack = 1e-9 * before.sum() + sum(
                rounding * _reach(m.points, part)
                for m, part in ((geometry, rows), (done.mesh, got[tag]))
            )
            if not abs(after.sum() - before.sum()) <= slack:
                return f"{name} tag {tag} measures {after.sum():.12g}, not {before.sum():.12g}"
    return ""


def _measure(points, rows):
    """Measures of simplices of any dimension, by the Gram determinant of their edges."""
    edges = points[rows[:, 1:]] - points[rows[:, :1]]
    if edges.shape[1] == edges.shape[2]:
        return np.abs(np.linalg.det(edges)) / (1, 1, 2, 6)[edges.shape[1]]
    if edges.shape[1] == 1:
        return np.linalg.norm(edges[:, 0], axis=1)
    return 0.5 * np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)


def _shortest(points, rows):
    edges = points[rows[:, 1:]] - points[rows[:, :1]]
    return float(np.linalg.norm(edges, axis=2).min())


def _reach(points, rows):
    """How much the measure of simplices changes when each point moves by a unit, at most."""
    edges = points[rows[:, 1:]] - points[rows[:, :1]]
    longest = np.linalg.norm(edges, axis=2).max(axis=1)
    return float((longest ** (edges.shape[1] - 1)).sum())


def _report(case, done):
    mesh, report = done.mesh, done.report
    if (report.n_points, report.n_cells) != (mesh.n_points, len(mesh.cells)):
        return "the report has other counts than the mesh"
    finished = report.stop_reason == "finished"
    if report.converged and not finished:
        return f"converged, but stopped by {report.stop_reason}"
    if finished and not report.converged and not case.options.until_consistent:
        return "finished, but not converged"
    bound = case.options.max_vertices
    if bound is not None and mesh.n_points > bound and report.converged:
        return f"converged with {mesh.n_points} vertices where max_vertices is {bound}"
    return ""


def _same_bytes(done, other):
    return done.metric.tobytes() == other.metric.tobytes() and all(
        np.asarray(getattr(done.mesh, name)).tobytes()
        == np.asarray(getattr(other.mesh, name)).tobytes()
        for name in ("points", "cells", "facets", "cell_tags", "facet_tags")
    )
