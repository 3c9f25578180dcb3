"""One random case: what goes into `remesh`, and the judgement of what comes out."""

from dataclasses import dataclass, field

import numpy as np
from fuzz_domains import domain
from meshes import certified_anew, compacted, grid
from metric_fields import metric_field

import anistar
from anistar.judging.certificate import certify
from anistar.meshes.mesh import Mesh
from anistar.meshes.topology import cell_volumes, facet_measures, measure_by_tag
from anistar.remeshing.remesh import RemeshOptions


@dataclass(frozen=True)
class Case:
    """Everything that a call of `remesh` gets."""

    number: int
    kind: str
    metric_kind: str
    geometry: Mesh
    mesh: Mesh  # carries the metric
    metric: np.ndarray
    options: RemeshOptions


@dataclass
class Outcome:
    """What happened; `problem` is empty when nothing was wrong."""

    problem: str = ""
    error: str = ""  # a refusal that the contract allows
    n_points: int = 0
    star_ok: float = 0.0
    reason: str = ""  # why not certified
    stop: str = ""
    numbers: dict = field(default_factory=dict)


def make_case(seed, number, *, largest=3000.0):
    """Return case `number` of a seed: the same on every machine."""
    rng = np.random.default_rng([seed, number])
    shape = domain(rng)
    geometry = shape.mesh
    mesh = geometry if rng.random() < 0.5 else _background(rng, geometry)
    metric_kind, M = metric_field(rng, mesh, largest=largest)
    tags = np.unique(geometry.facet_tags)
    frozen = [int(rng.choice(tags))] if rng.random() < 0.2 else []
    options = RemeshOptions(
        frozen_tags=frozen,
        hausdorff_number=float(rng.choice([0.1, 0.1, 0.02, 0.3])),
        ridge_angle=float(rng.choice([45.0, 45.0, 30.0, 80.0])),
        max_vertices=int(rng.choice([200, 6000, 6000, 6000])),
        max_seconds=60.0,
        agreement=["auto", "auto", True, False][rng.integers(4)],
        until_consistent=bool(rng.random() < 0.15),
    )
    return Case(number, shape.kind, metric_kind, geometry, mesh, M, options)


def _background(rng, geometry):
    """A grid over the box of the domain, a little larger or a little too small."""
    low, high = geometry.points.min(axis=0), geometry.points.max(axis=0)
    points, cells = grid(*rng.integers(1, 12, size=2))
    points, cells = compacted(points, cells)
    margin = rng.choice([0.1, 0.0, -0.02]) * (high - low)
    return Mesh(points=(low - margin) + points * (high - low + 2 * margin), cells=cells)


def run_case(case):
    """Remesh and judge."""
    try:
        done = anistar.remesh(case.mesh, case.metric, case.options, geometry=case.geometry)
    except (anistar.MeshingError, ValueError) as error:
        return judged_error(str(error))
    found = Outcome(n_points=done.mesh.n_points, stop=done.report.stop_reason)
    for judge in (_validity, _tags, _topology, _corners, _frozen, _measures):
        found.problem = judge(case, done.mesh)
        if found.problem:
            return found
    _certify(done, found)
    return found


PLACES = ("near (", "at (", "tag", "point", "facet", "cell")


def judged_error(message):
    """Return what a refusal is worth: it must name a place."""
    names_a_place = any(place in message for place in PLACES)
    problem = "" if names_a_place else f"the message names no place: {message}"
    return Outcome(problem=problem, error=message)


def _validity(case, mesh):
    violations = anistar.validate(mesh)
    return f"invalid: {violations[0].message}" if violations else ""


def _tags(case, mesh):
    for name in ("facet_tags", "cell_tags"):
        got, want = (set(getattr(m, name).tolist()) for m in (mesh, case.geometry))
        if got != want:
            return f"{name} differ: lost {sorted(want - got)}, new {sorted(got - want)}"
    return "" if mesh.names == case.geometry.names else "names differ"


def _topology(case, mesh):
    """Every region and every tag keeps its Euler characteristic."""
    for tag in np.unique(mesh.cell_tags).tolist():
        got, want = (_euler(m.cells[m.cell_tags == tag]) for m in (mesh, case.geometry))
        if got != want:
            return f"region {tag} has Euler characteristic {got}, not {want}"
    for tag in np.unique(mesh.facet_tags).tolist():
        got, want = (_euler_chain(m.facets[m.facet_tags == tag]) for m in (mesh, case.geometry))
        if got != want:
            return f"facet tag {tag} has Euler characteristic {got}, not {want}"
    return ""


def _euler(cells):
    edges = np.unique(
        np.sort(np.concatenate([cells[:, [0, 1]], cells[:, [1, 2]], cells[:, [2, 0]]])), axis=0
    )
    return len(np.unique(cells)) - len(edges) + len(cells)


def _euler_chain(facets):
    return len(np.unique(facets)) - len(facets)


def _corners(case, mesh):
    """Given corners and points where other than two facets meet are there, bit by bit."""
    geometry = case.geometry
    degree = np.bincount(geometry.facets.ravel(), minlength=geometry.n_points)
    fixed = np.union1d(np.flatnonzero((degree > 0) & (degree != 2)), geometry.corners)
    have = set(map(tuple, mesh.points.tolist()))
    for point in fixed.tolist():
        if tuple(geometry.points[point].tolist()) not in have:
            return f"corner {point} at {geometry.points[point].tolist()} is lost"
    if len(mesh.corners) != len(geometry.corners):
        return f"{len(geometry.corners)} corners became {len(mesh.corners)}"
    return ""


def _frozen(case, mesh):
    """Frozen facets are there, bit by bit, and no others with their tag."""
    for tag in case.options.frozen_tags:
        sets = []
        for m in (mesh, case.geometry):
            ends = m.points[m.facets[m.facet_tags == tag]]
            sets.append({tuple(sorted(map(tuple, pair))) for pair in ends.tolist()})
        if sets[0] != sets[1]:
            lost, new = len(sets[1] - sets[0]), len(sets[0] - sets[1])
            return f"frozen tag {tag}: {lost} facets lost, {new} new"
    return ""


def _measures(case, mesh):
    """Lengths and areas within what chords of this Hausdorff number may change."""
    geometry, h = case.geometry, case.options.hausdorff_number
    got, want = (
        measure_by_tag(facet_measures(m.points, m.facets), m.facet_tags) for m in (mesh, geometry)
    )
    for tag, length in want.items():
        if not abs(got[tag] / length - 1) <= 0.1 + 1.5 * h:
            return f"facet tag {tag} measures {got[tag]:.6g}, not {length:.6g}"
    slack = sum(float((facet_measures(m.points, m.facets) ** 2).sum()) for m in (mesh, geometry))
    got, want = (
        measure_by_tag(cell_volumes(m.points, m.cells), m.cell_tags) for m in (mesh, geometry)
    )
    for tag, area in want.items():
        if not abs(got[tag] - area) <= (h + 0.1) * slack + 1e-10 * area:
            return f"region {tag} measures {got[tag]:.6g}, not {area:.6g}"
    return ""


def _certify(done, found):
    """Certify, or say why the mesh cannot be expected to be."""
    found.numbers = {"q_min": done.report.statistics["q_min"]}
    if found.stop != "finished":  # cells as large as the domain: every ball meets every cell
        found.reason = f"stopped by {found.stop}"
        return
    mesh = done.mesh
    kept = certify(mesh, done.metric)
    certificate = certified_anew(done)
    assert np.array_equal(kept.delaunay, certificate.delaunay)
    found.star_ok = float(certificate.star_ok.mean())
    gamma = float(np.quantile(certificate.distortion, 0.9))
    found.numbers["gamma90"] = gamma
    if found.star_ok == 1:
        found.reason = "certified"
    elif certificate.is_certified:
        found.reason = "certified but for exempt vertices"
    elif done.report.statistics["q_min"] < 0.1:
        found.reason = "walls finer than the metric, or corners: q_min < .1"
    elif np.log(gamma) > 0.2:
        found.reason = "metric: ln gamma p90 > .2"
    else:
        found.reason = "moderate metric"
