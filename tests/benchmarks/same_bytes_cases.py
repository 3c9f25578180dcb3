"""What `same_bytes` computes: cases by name, from the public names of anistar alone.

A result is a mesh, an array, a report, or a digest that was made elsewhere.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import result_digests
from analytic_cases import CASES, Case, Floats
from meshes import annulus, two_region_cube, two_regions
from remesh3d import test_volume_golden as golden_volumes
from remesh3d.domains import cube_with_ridges, layer, turning
from remesh3d.domains import uniform as uniform_volume
from shapes import arc_metric, rotating_metric, sectors, stretched, uniform
from test_golden import CASES as GOLDEN_AREAS

from anistar import (
    AdaptOptions,
    ConsistencyOptions,
    Field,
    LoopOptions,
    Mesh,
    MetricOptions,
    Remeshed,
    RemeshOptions,
    UnsteadyOptions,
    adapt,
    adapt_loop,
    certify,
    explain_star,
    metric,
    remesh,
    transfer,
    unsteady_loop,
)

Results = dict[str, Any]

COMPLEXITIES = {
    2: {"S": 1600.0, "M": 16000.0},
    3: {"XS": 100.0, "S": 1000.0, "M": 10000.0},
}
PASSES = 2

SETTINGS: dict[str, dict[str, Any]] = {
    "default": {},
    "agreement": {"agreement": True},
    "agreement, seed 7": {"agreement": True, "seed": 7},
    "agreement, two threads": {"agreement": True, "threads": 2},
    "no agreement": {"agreement": False},
    "polyhedron": {"shape": "polyhedron"},
    "unlimited": {"max_refinement": None},
    "few vertices": {"max_vertices": 700},
    "near curves": {"hausdorff_number": 0.01, "ridge_angle": 30.0},
}
BRIEF = ConsistencyOptions(max_growth=0.1)
"""Algorithm 2 takes long where a metric varies fast; a tenth more vertices show all of it."""
CONSISTENT = {"until_consistent": True, "consistency": BRIEF}
PURE = {"until_consistent": "pure", "max_vertices": 6000}
QUICK = ((2, "flat layer"), (2, "tanh front"))
LAWS = ("physical", "metric", "mixed")


@dataclass(frozen=True, kw_only=True)
class Run:
    """What is computed under a name; the quick ones are enough for every day."""

    name: str
    results: Callable[[], Results]
    is_quick: bool = False


def runs() -> Iterator[Run]:
    """Yield all cases, the small ones first."""
    yield from golden()
    yield from tagged()
    yield from thin()
    yield from pipeline()
    yield from small()
    yield from medium()


def remeshed(mesh: Mesh, M: Floats, **options: Any) -> Results:
    """Return what one remeshing gives."""
    return named(remesh(mesh, M, RemeshOptions(**options)))


def named(done: Remeshed) -> Results:
    """Return the parts of a new mesh."""
    return {"mesh": done.mesh, "metric": done.metric, "report": done.report}


def golden() -> Iterator[Run]:
    """Yield the inputs of the topologies that the tests keep as text."""
    for case in GOLDEN_AREAS:
        yield Run(name=f"2D golden {case.__name__}", results=at_once(case), is_quick=True)
    for case in golden_volumes.CASES:
        yield Run(name=f"3D golden {case.__name__}", results=at_once(case), is_quick=True)


def at_once(make: Callable[[], tuple[Mesh, Floats]], **options: Any) -> Callable[[], Results]:
    """Return a call that makes a mesh and a metric and remeshes the one with the other."""
    return lambda: remeshed(*make(), **options)


def tagged() -> Iterator[Run]:
    """Yield domains with interfaces, ridges, corners and frozen facets."""
    areas = {
        "regions": (lambda: turned(two_regions(12)), {"agreement": True}),
        "frozen interface": (lambda: turned(two_regions(12)), {"frozen_tags": [9]}),
        "sharp corners": (sharp_corners, {"agreement": True, "until_consistent": True}),
        "few around sharp corners": (sharp_corners, {"max_vertices": 400}),
        "ring": (lambda: around(annulus(8)), {"until_consistent": True}),
    }
    volumes = {
        "regions": (lambda: with_metric(two_region_cube(4), turning), {"agreement": True}),
        "ridges": (lambda: with_metric(cube_with_ridges(4), layer), {}),
        "frozen side": (lambda: with_metric(cube_with_ridges(4), layer), {"frozen_tags": [1]}),
        "consistent ridges": (lambda: with_metric(cube_with_ridges(3), layer), CONSISTENT),
    }
    for dim, domains in ((2, areas), (3, volumes)):
        for name, (make, options) in domains.items():
            yield Run(name=f"{dim}D tagged {name}", results=at_once(make, **options), is_quick=True)


def with_metric(mesh: Mesh, M: Callable[[Mesh], Floats]) -> tuple[Mesh, Floats]:
    """Return a mesh and a metric on it."""
    return mesh, M(mesh)


def turned(mesh: Mesh) -> tuple[Mesh, Floats]:
    """Return a mesh and long cells whose direction turns."""
    return mesh, rotating_metric(mesh, 400)


def around(mesh: Mesh) -> tuple[Mesh, Floats]:
    """Return a mesh and a layer along a circle."""
    return mesh, arc_metric(mesh, 400)


def sharp_corners() -> tuple[Mesh, Floats]:
    """Return sectors of many angles, and long cells in all directions."""
    mesh = sectors([9, 31, 17, 24, 40, 12, 35, 28], np.linspace(1, 0.7, 9))
    return mesh, stretched(0.12, 0.03, 9.0 * mesh.points[:, 0] - 5.0 * mesh.points[:, 1])


def thin() -> Iterator[Run]:
    """Yield domains thinner than the sizes asked for, where the quality of the input counts."""
    ring, plate = annulus(6, inner=0.95), plate_of(0.05)
    for size in (0.3, 0.03):
        yield Run(
            name=f"2D thin ring, size {size}",
            results=partial(remeshed, ring, uniform(ring, size)),
            is_quick=True,
        )
    for size in (0.5, 0.15):
        yield Run(
            name=f"3D thin plate, size {size}",
            results=partial(remeshed, plate, uniform_volume(plate, size)),
            is_quick=True,
        )


def plate_of(thickness: float) -> Mesh:
    """Return a plate with two regions and a ridge."""
    base = two_region_cube(6)
    return Mesh(**{**base.arrays(), "points": base.points * [1.0, 1.0, thickness]})


def pipeline() -> Iterator[Run]:
    """Yield all that leads from fields to fields on a new mesh."""
    for dim, n in ((2, 12), (3, 6)):
        mesh = result_digests.box(dim, n)
        u = result_digests.layer(mesh.points)
        parts: dict[str, Callable[[], Results]] = {
            "recovery": partial(result_digests.recovered, mesh, u),
            "metrics": partial(result_digests.made_metrics, mesh, u),
            "gradation": partial(graded, mesh, u),
            "stages": partial(result_digests.adapted, mesh, u, 400.0),
            "adapt": partial(adapted, mesh, u),
            "transfer": partial(transferred, mesh, u),
            "loop": partial(looped, mesh),
            "unsteady": partial(advanced, mesh),
        }
        for name, results in parts.items():
            yield Run(name=f"{dim}D {name}", results=results, is_quick=True)
        curved = partial(result_digests.curved, dim)
        yield Run(name=f"{dim}D curved", results=curved, is_quick=dim == 2)


def graded(mesh: Mesh, u: Floats) -> Results:
    """Return a metric after each law of gradation."""
    M = metric.from_fields(
        mesh, {"u": u}, MetricOptions(target_complexity=400.0, gradation_factor=None)
    )[0]
    found = {
        f"{law} {f}": metric.graded(mesh, M, factor=f, model=law)
        for law in LAWS
        for f in (1.3, 2.0)
    }
    return found | {"distortion": metric.graded(mesh, M, factor=1.5, max_distortion=0.4)}


def adapted(mesh: Mesh, u: Floats) -> Results:
    """Return an adaptation and the certificate of its mesh."""
    asked = AdaptOptions(
        metric=MetricOptions(target_elements=800.0),
        remesh=RemeshOptions(agreement=True),
    )
    done = adapt(mesh, {"u": u, "v": mesh.points * u[:, None]}, asked)
    cert = certify(done.mesh, done.metric)
    arrays = ("simplex_ok", "star_ok", "distortion", "radius_edge", "sliverity", "exempt")
    return {
        "mesh": done.mesh,
        "metric": done.metric,
        **done.fields,
        "report": done.report,
        **{name: getattr(cert, name) for name in (*arrays, "delaunay")},
        "certificate": cert,
        "star": explain_star(done.mesh, done.metric, done.mesh.n_points // 2),
    }


def transferred(mesh: Mesh, u: Floats) -> Results:
    """Return fields of several kinds on a finer mesh, by each method."""
    finer = result_digests.box(mesh.dim, 9 if mesh.dim == 3 else 17, moved=0.1)
    in_cells = Field(result_digests.layer(mesh.points[mesh.cells].mean(axis=1)), on="cells")
    found: Results = {}
    for method in result_digests.TRANSFERS:
        done = transfer(mesh, {"u": u, "c": in_cells}, finer, method=method, outside="nearest")
        found |= {f"{method} {name}": values_of(field) for name, field in done.fields.items()}
        found[f"{method} report"] = done.report
    return found


def values_of(field: Any) -> Floats:
    """Return the values of a field, in whichever form it came back."""
    return np.asarray(getattr(field, "values", field))


def looped(mesh: Mesh) -> Results:
    """Return the steps of a loop."""
    asked = LoopOptions(complexities=[200.0, 200.0, 300.0])
    done = adapt_loop(lambda new, _: {"u": result_digests.layer(new.points)}, mesh, asked)
    meshes = {f"step {step.iteration} mesh": step.mesh for step in done.steps}
    return {**meshes, "report": done}


def advanced(mesh: Mesh) -> Results:
    """Return the instants of a problem in time, a layer that wanders."""

    def at(new: Mesh, _fields: Any, _begin: float, end: float) -> Results:
        return {"u": result_digests.layer(new.points - 0.2 * end)}

    asked = UnsteadyOptions(adapt=AdaptOptions(metric=MetricOptions(target_complexity=200.0)))
    start = {"u": result_digests.layer(mesh.points)}
    done = unsteady_loop(at, mesh, start, np.linspace(0.0, 1.0, 7), asked)
    return {"report": done, "mesh": done.last.mesh, **done.last.fields}


def small() -> Iterator[Run]:
    """Yield every analytic case with every setting."""
    for case in CASES:
        for name, options in SETTINGS.items():
            yield of_case(case, "S", name, **options)
        for law in LAWS:
            yield of_case(case, "S", f"graded {law}", law=law, agreement=True)
        size = "S" if case.dim == 2 else "XS"
        yield of_case(case, size, "consistent", **CONSISTENT)
        yield of_case(case, size, "consistent, seed 7", **CONSISTENT, seed=7)
        if case.dim == 2:
            yield of_case(case, "S", "pure", **PURE)


def medium() -> Iterator[Run]:
    """Yield every analytic case at a size where meshes are worked on in blocks."""
    for case in CASES:
        yield of_case(case, "M", "default")
        yield of_case(case, "M", "agreement", agreement=True, threads=2)
        yield of_case(case, "M", "graded", law="mixed")
        if case.dim == 2:
            yield of_case(case, "M", "consistent", **CONSISTENT)


def of_case(case: Case, size: str, name: str, **options: Any) -> Run:
    """Return the run of an analytic case."""
    return Run(
        name=f"{case.dim}D {case.name} {size}, {name}",
        results=partial(passes, case, size, **options),
        is_quick=size == "S" and (case.dim, case.name) in QUICK,
    )


def passes(case: Case, size: str, law: str | None = None, **options: Any) -> Results:
    """Return the meshes of repeated remeshing, the metric evaluated before each pass."""
    target = COMPLEXITIES[case.dim][size]
    first = mesh = case.start(target)
    scale = (target / metric.complexity(first, case.metric(first.points))) ** (2 / case.dim)
    found: Results = {}
    for k in range(1, PASSES + 1):
        M = scale * case.metric(mesh.points)
        if law is not None:
            M = metric.graded(mesh, M, factor=1.5, model=law)
        done = remesh(mesh, M, RemeshOptions(**options), geometry=first)
        found |= {f"pass {k} {name}": result for name, result in named(done).items()}
        mesh = done.mesh
    return found
