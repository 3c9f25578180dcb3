"""One random 3D case: what goes into `remesh`, and the judgement of what comes out."""

import numpy as np
from fuzz_cases import Case, Outcome, judged_error
from volume_domains import FLAT, volume_domain
from volume_metrics import volume_metric

import anistar
from anistar.meshes.topology import (
    cell_volumes,
    edge_lengths,
    facet_measures,
    facet_table,
    measure_by_tag,
)
from anistar.remeshing.remesh import RemeshOptions


def make_volume_case(seed, number, *, largest=1000.0):
    """Return 3D case `number` of a seed: the same on every machine."""
    rng = np.random.default_rng([seed, number, 3])
    shape = volume_domain(rng)
    geometry = shape.mesh
    metric_kind, M = volume_metric(rng, geometry, largest=largest)
    tags = np.unique(geometry.facet_tags)
    options = RemeshOptions(
        frozen_tags=[int(rng.choice(tags))] if rng.random() < 0.15 else [],
        hausdorff_number=float(rng.choice([0.1, 0.1, 0.02, 0.3])),
        ridge_angle=float(rng.choice([45.0, 45.0, 30.0, 80.0])),
        max_vertices=int(rng.choice([300, 20000, 20000, 20000])),
        max_seconds=60.0,
        agreement=(False, "auto", True)[rng.integers(3)],
    )
    return Case(number, shape.kind, metric_kind, geometry, geometry, M, options)


def run_volume_case(case, *, again=True):
    """Remesh, judge, and do both once more with another metric on the new mesh."""
    mesh, M = case.mesh, case.metric
    rng = np.random.default_rng(case.number)
    found = Outcome()
    for _ in range(2 if again else 1):
        try:
            done = anistar.remesh(mesh, M, case.options, geometry=case.geometry)
        except (anistar.MeshingError, ValueError) as error:
            return judged_error(str(error))
        found = Outcome(n_points=done.mesh.n_points, stop=done.report.stop_reason, reason="made")
        found.numbers = {"q_min": done.report.statistics["q_min"]}
        for judge in (_ended, _validity, _tags, _topology, _corners, _frozen, _measures, _report):
            found.problem = judge(case, done)
            if found.problem:
                return found
        mesh = done.mesh
        _, M = volume_metric(rng, mesh, largest=300.0)
    return found


def _ended(case, done):
    """No case is so large that its time may run out: that is a loop that does not end."""
    seconds = case.options.max_seconds
    return f"stopped after {seconds} s" if done.report.stop_reason == "max_seconds" else ""


def _validity(case, done):
    violations = anistar.validate(done.mesh)
    return f"invalid: {violations[0].message}" if violations else ""


def _tags(case, done):
    for name in ("facet_tags", "cell_tags", "edge_tags"):
        got, want = (set(getattr(m, name).tolist()) for m in (done.mesh, case.geometry))
        if got != want:
            return f"{name} differ: lost {sorted(want - got)}, new {sorted(got - want)}"
    return "" if done.mesh.names == case.geometry.names else "names differ"


def _topology(case, done):
    """Every region, every surface and every line keeps its Euler characteristic."""
    for name, rows in (("cell", "cells"), ("facet", "facets"), ("edge", "edges")):
        tags = getattr(case.geometry, f"{name}_tags")
        for tag in np.unique(tags).tolist():
            got, want = (
                euler(getattr(m, rows)[getattr(m, f"{name}_tags") == tag])
                for m in (done.mesh, case.geometry)
            )
            if got != want:
                return f"{name} tag {tag} has Euler characteristic {got}, not {want}"
    return ""


def euler(simplices):
    """The Euler characteristic of the union of simplices of one dimension."""
    n, total = simplices.shape[1], 0
    faces = [
        np.sort(simplices[:, [k for k in range(n) if mask >> k & 1]], axis=1)
        for mask in range(1, 2**n)
    ]
    for size in range(1, n + 1):
        rows = np.concatenate([face for face in faces if face.shape[1] == size])
        total += (-1) ** (size - 1) * len(np.unique(rows, axis=0))
    return total


def _corners(case, done):
    """The given corners are there, bit by bit."""
    mesh, geometry = done.mesh, case.geometry
    have = set(map(tuple, mesh.points[mesh.corners].tolist()))
    for point in geometry.corners.tolist():
        if tuple(geometry.points[point].tolist()) not in have:
            return f"corner {point} at {geometry.points[point].tolist()} is lost"
    if len(mesh.corners) != len(geometry.corners):
        return f"{len(geometry.corners)} corners became {len(mesh.corners)}"
    return ""


def _frozen(case, done):
    """Frozen facets are there, bit by bit, and no others with their tag."""
    for tag in case.options.frozen_tags:
        sets = []
        for m in (done.mesh, case.geometry):
            ends = m.points[m.facets[m.facet_tags == tag]]
            sets.append({tuple(sorted(map(tuple, ends_of))) for ends_of in ends.tolist()})
        if sets[0] != sets[1]:
            lost, new = len(sets[1] - sets[0]), len(sets[0] - sets[1])
            return f"frozen tag {tag}: {lost} facets lost, {new} new"
    return ""


def _measures(case, done):
    """A domain of planes keeps its volume; the rest what the Hausdorff number allows."""
    mesh, geometry = done.mesh, case.geometry
    got, want = (float(cell_volumes(m.points, m.cells).sum()) for m in (mesh, geometry))
    size = np.abs(geometry.points).max() / np.ptp(geometry.points, axis=0).min()
    if case.kind in FLAT and not abs(got - want) <= (1e-9 + 1e-14 * size) * want:
        return f"the volume is {got:.12g}, not {want:.12g}"
    if case.options.frozen_tags:
        return ""  # what meets a frozen surface follows its facets, not its curve
    number = case.options.hausdorff_number
    for name, measure, rows in (
        ("facet", facet_measures, "facets"),
        ("edge", edge_lengths, "edges"),
    ):
        got_by, want_by = (
            measure_by_tag(measure(m.points, getattr(m, rows)), getattr(m, f"{name}_tags"))
            for m in (mesh, geometry)
        )
        for tag, value in want_by.items():
            slack = (0.25 + 2 * number) * value
            if name == "facet":
                slack += number * sum(_rim_squares(m, tag) for m in (mesh, geometry))
            if not abs(got_by[tag] - value) <= slack:
                return f"{name} tag {tag} measures {got_by[tag]:.6g}, not {value:.6g}"
    return ""


def _rim_squares(mesh, tag):
    """What the rim of a surface sweeps when its edges stray by their own lengths."""
    facets = mesh.facets[mesh.facet_tags == tag]
    edges = np.sort(np.concatenate([facets[:, [0, 1]], facets[:, [1, 2]], facets[:, [2, 0]]]), 1)
    rim, count = np.unique(edges, axis=0, return_counts=True)
    return float((edge_lengths(mesh.points, rim[count == 1]) ** 2).sum())


def _report(case, done):
    """The report says what the mesh is."""
    mesh, report = done.mesh, done.report
    if (report.n_points, report.n_cells) != (mesh.n_points, len(mesh.cells)):
        return "the report has other counts than the mesh"
    if report.converged != (report.stop_reason == "finished"):
        return f"converged is {report.converged} but the run {report.stop_reason}"
    wanted = set(mesh.facet_tags.tolist())
    if {t.tag for t in report.tags if t.dim == 2} != wanted:
        return "the report does not have every facet tag"
    volume = float(cell_volumes(mesh.points, mesh.cells).sum())
    if not abs(sum(t.after for t in report.tags if t.dim == 3) - volume) <= 1e-9 * volume:
        return "the volumes of the report are not those of the mesh"
    if not np.isfinite(report.statistics["q_min"]) or report.statistics["q_min"] <= 0:
        return f"q_min is {report.statistics['q_min']}"
    boundary = facet_table(mesh.cells, mesh.n_points).counts == 1
    return "" if boundary.any() else "no boundary"
