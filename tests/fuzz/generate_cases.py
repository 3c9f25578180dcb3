"""One random complex of which the first mesh is made, and judged."""

from dataclasses import dataclass, field

import numpy as np
from complexes import KINDS, Complex, Placing

from anistar import MeshingError, generate, validate
from anistar.meshes.topology import cell_volumes, facet_measures

METHODS = ("constrained", "remesh", "refine")

MOST_VERTICES = 3000
"""No case has more points than this and a few."""

ROUND_OFF = 1e-13
"""Of a coordinate, relative, as it moves points off their planes and changes volumes."""


@dataclass(frozen=True, kw_only=True)
class GenerateCase:
    """A complex, and what is asked for."""

    number: int
    kind: str
    given: Complex
    placing: Placing
    method: str
    wish: str
    call: dict = field(default_factory=dict)

    @property
    def metric_kind(self):
        """What the table counts by beside the kind of complex."""
        return f"{self.method} {self.wish}"


@dataclass(frozen=True, kw_only=True)
class GenerateVerdict:
    """A verdict of `fuzz_tables.VERDICTS`, and the words for it."""

    verdict: str
    message: str = ""
    stop: str = ""
    n_points: int = 0


def make_generate_case(seed, number):
    """Return case `number` of a seed."""
    rng = np.random.default_rng([seed, number, 19])
    kind = KINDS[rng.integers(len(KINDS))]
    given = kind(rng)
    placing = Placing.random(rng)
    placed = placing.of(given)
    method = METHODS[rng.integers(3)]
    wish, call = ("none", {}) if method == "constrained" else _wished(rng, placed, method)
    call["max_vertices"] = MOST_VERTICES
    call["threads"] = int(rng.integers(1, 3))
    if rng.random() < 0.1 and kind.__name__ in ("hull", "nested"):
        call["inside"] = "nonzero"
    return GenerateCase(
        number=number,
        kind=kind.__name__,
        given=placed,
        placing=placing,
        method=method,
        wish=wish,
        call=call,
    )


def _wished(rng, given, method):
    finite = given.points[np.isfinite(given.points).all(axis=1)]
    diagonal = float(np.sqrt((np.ptp(finite, axis=0) ** 2).sum()))
    h, middle = diagonal / rng.uniform(4, 20), finite.mean(axis=0)

    def graded(points):
        return h * (0.3 + 2 * np.sqrt(((points - middle) ** 2).sum(axis=1)) / diagonal)

    def stretched(points):
        return np.repeat(np.diag([1 / h**2, 1 / (2 * h) ** 2, 16 / h**2])[None], len(points), 0)

    what = int(rng.integers(6))
    if what == 0:
        return "none", {}
    if what == 1:
        return "function", {"size": graded}
    if what == 2:
        sizes = np.where(rng.random(len(given.points)) < 0.3, h / 2, np.inf)
        return "array", {"size": sizes}
    if what == 3:
        return "size_at", {"size": h, "size_at": {1: h / 4}}
    if what == 4 and method == "remesh":
        return "metric", {"metric": stretched}
    return "size", {"size": h}


def run_generate_case(case):
    """Make the mesh and judge it."""
    try:
        done = generate(case.given.plc(), method=case.method, **case.call)
    except (ValueError, TypeError, MeshingError) as error:
        return _judged_refusal(case, error)
    problem = _problem(case, done)
    if problem:
        return GenerateVerdict(verdict="changed", message=problem)
    return GenerateVerdict(verdict="ok", stop=done.report.stop_reason, n_points=done.mesh.n_points)


def _judged_refusal(case, error):
    message = f"{type(error).__name__}: {error}"
    if not case.given.may_fail:
        return GenerateVerdict(verdict="unfounded", message=message)
    if not any(character.isdigit() for character in str(error)):
        return GenerateVerdict(verdict="unclear", message=message)
    return GenerateVerdict(verdict="refused", message=message)


def _problem(case, done):
    mesh, report = done.mesh, done.report
    violations = validate(mesh)
    if violations:
        return f"invalid: {violations[0].message}"
    plc = case.given.plc()
    size = np.abs(plc.points).max() / np.ptp(plc.points, axis=0).max()
    error = 1e-9 + ROUND_OFF * size + (1e-6 if case.placing.is_rounded else 0.0)
    if not report.measures.facet_error <= error:
        return f"the area of a facet is off by {report.measures.facet_error:.2g}"
    if not report.measures.region_error <= error:
        return f"the volume of a region is off by {report.measures.region_error:.2g}"
    return (
        _areas(case, plc, mesh, error)
        or _volumes(case, mesh, error)
        or _corners(plc, mesh)
        or _bounds(case, report)
        or _budget(report)
    )


def _areas(case, plc, mesh, error):
    """Each facet has the area that it had."""
    if case.given.may_fail:
        return ""
    given = facet_measures(plc.points, plc.triangles)
    wanted = np.bincount(plc.triangle_facets, given, plc.n_facets)
    found = np.bincount(mesh.facet_tags, facet_measures(mesh.points, mesh.facets), plc.n_facets + 1)
    off = np.abs(found[1:] - wanted) / wanted.sum()
    worst = int(off.argmax())
    return f"facet {worst} is off by {off[worst]:.2g}" if off[worst] > error else ""


def _volumes(case, mesh, error):
    """Regions have the volumes that are known."""
    if case.given.volumes is None or "inside" in case.call:
        return ""
    found = {}
    sizes = cell_volumes(mesh.points, mesh.cells)
    for tag in np.unique(mesh.cell_tags).tolist():
        found[tag] = sizes[mesh.cell_tags == tag].sum() / case.placing.scale**3
    wanted = case.given.volumes
    if found.keys() != wanted.keys():
        return f"regions {sorted(found)} were meshed, not {sorted(wanted)}"
    # volumes of the first placing, which round-off has changed
    extent = np.ptp(case.given.points, axis=0).max() / case.placing.scale
    slack = 10 * (error * sum(wanted.values()) + error * extent**3)
    off = {tag: abs(found[tag] - wanted[tag]) for tag in wanted}
    worst = max(off, key=off.get)
    return f"region {worst} is off by {off[worst]:.2g}" if off[worst] > slack else ""


def _corners(plc, mesh):
    """Kept points are there, bit by bit."""
    have = set(map(tuple, mesh.points.tolist()))
    for point in plc.points_kept.tolist():
        if tuple(plc.points[point].tolist()) not in have:
            return f"point {point} is lost"
    return ""


def _bounds(case, report):
    """Refinement keeps its bound where the theory says so."""
    if case.method != "refine" or not report.converged or not case.given.is_blunt:
        return ""
    record = report.refinement
    if record["above_bound"]:
        return f"{record['above_bound']} cells are above the bound"
    for lemma in ("edge_lemma", "facet_lemma"):
        if record[lemma]["violated"]:
            return f"{lemma} is violated {record[lemma]['violated']} times"
    return ""


def _budget(report):
    if report.converged != (report.stop_reason == "finished"):
        return f"converged is {report.converged}, stop_reason {report.stop_reason}"
    return ""
