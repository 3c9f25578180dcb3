"""One harsh case: domain, background, metric, options, and what is done with them."""

from dataclasses import dataclass, replace

import numpy as np
from exact_judge import eigenvalue_ratios
from harsh_domains import harsh_domain
from harsh_metrics import boundary_demand, harsh_metric
from harsh_volumes import harsh_volume
from meshes import compacted, grid
from volume_domains import boxes, positive

from anistar.meshes.mesh import Mesh
from anistar.remeshing.consistency_options import ConsistencyOptions
from anistar.remeshing.remesh import RemeshOptions

LARGEST = {2: 400.0, 3: 50.0}
"""Complexity of the metrics that are meant to be met; others are cut off by a budget."""

HOPELESS = 1e13
"""Vertices that no machine holds."""

STRAIGHT = 1e-3
"""A ridge angle in degrees with which no curve is read into a polygon."""


@dataclass(frozen=True, kw_only=True)
class HarshCase:
    """Everything that the calls of a case get."""

    number: int
    kind: str
    metric_kind: str
    geometry: Mesh
    mesh: Mesh  # carries the metric
    metric: np.ndarray
    ratio: float  # largest eigenvalue ratio of the metric, infinite where it is not definite
    options: RemeshOptions
    before: str  # what is done with the metric first
    again: bool  # remesh the result with the metric that came back
    repeated: bool  # with another number of threads


def make_harsh_case(seed, number, *, dim=2, largest=None):
    """Return harsh case `number` of a seed: the same on every machine."""
    rng = np.random.default_rng([seed, number, dim, 13])
    largest = LARGEST[dim] if largest is None else largest
    shape = _shape(rng, harsh_domain if dim == 2 else harsh_volume)
    geometry = shape.mesh
    # In 3D facets and tags are those of the mesh: another mesh has lost them, and is refused.
    mesh = _background(rng, geometry) if rng.random() < (0.3, 0.04)[dim - 2] else geometry
    metric_kind, M = harsh_metric(rng, mesh, largest=largest)
    options = _options(rng, geometry)
    demand = _demand(mesh, M)
    if demand > 20 * largest:
        options = _bounded(rng, options, demand)
    return HarshCase(
        number=number,
        kind=shape.kind,
        metric_kind=metric_kind,
        geometry=geometry,
        mesh=mesh,
        metric=M,
        ratio=float(eigenvalue_ratios(M).max()),
        options=options,
        before=str(rng.choice(["", "graded", "bounded", "intersected"], p=[0.7, 0.1, 0.1, 0.1])),
        again=bool(rng.random() < 0.3),
        repeated=bool(rng.random() < 0.05),
    )


def _shape(rng, domain):
    """A random domain; some triangulations of slivers are refused as meshes, by good reason."""
    for _ in range(9):
        try:
            return domain(rng)
        except ValueError:
            continue
    return domain(rng)


def _background(rng, geometry):
    """A grid of another shape over the box of the domain, which may leave a rim uncovered."""
    low, high = geometry.points.min(axis=0), geometry.points.max(axis=0)
    if geometry.dim == 2:
        points, cells = compacted(*grid(*rng.integers(1, 9, size=2)))
    else:
        points, cells = positive(*boxes(tuple(rng.integers(1, 4, size=3))))
    extent = np.maximum(high - low, 1e-6 * (high - low).max())
    margin = rng.choice([0.1, 0.0, 3.0, -0.02]) * extent
    try:
        return Mesh(points=(low - margin) + points * (extent + 2 * margin), cells=cells)
    except ValueError:  # the box is too thin, so far from the origin
        return geometry


def _demand(mesh, M):
    """A rough number of vertices that the metric asks for, at least of the boundary."""
    corners = mesh.points[mesh.cells]
    volumes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1]))
    with np.errstate(all="ignore"):
        density = np.sqrt(np.abs(np.linalg.det(M)))
        inside = float((volumes * density[mesh.cells].max(axis=1)).sum())
        return max(inside, boundary_demand(mesh, M))


def _options(rng, geometry):
    """Options of every sort; a time that no case should need bounds them all."""
    tags = np.unique(geometry.facet_tags).tolist()
    frozen = [tag for tag in tags if rng.random() < 0.3] if rng.random() < 0.2 else []
    angles = [STRAIGHT, STRAIGHT, STRAIGHT, 45.0, 45.0, 10.0, 90.0, 180.0]
    consistency = [False, False, False, False, True, "pure" if geometry.dim == 2 else True]
    return RemeshOptions(
        frozen_tags=frozen,
        hausdorff_number=float(rng.choice([0.1, 0.1, 0.02, 0.3, 1.0])),
        ridge_angle=float(rng.choice(angles)),
        max_vertices=_one_of(rng, [20000, None, 3000, 300, 20, 3], rare=0.35),
        max_seconds=_one_of(rng, [20.0, 1.0, 0.02, 1e-6], rare=0.2),
        agreement=["auto", "auto", True, False][rng.integers(4)],
        until_consistent=consistency[rng.integers(6)],
        consistency=ConsistencyOptions(gamma_0=_one_of(rng, [None, 1.5, 5.0], rare=0.1)),
        seed=int(rng.integers(5)),
        threads=_one_of(rng, [1, 2, 2, 3], rare=0.5),
    )


def _one_of(rng, values, *, rare):
    """The first value, or with the probability `rare` one of the others."""
    return values[rng.integers(1, len(values))] if rng.random() < rare else values[0]


def _bounded(rng, options, demand):
    """The options with a budget that a metric of any demand must keep to.

    What no memory can hold may come without: it is refused before anything is done.
    """
    if demand > HOPELESS and rng.random() < 0.3:
        return replace(options, max_vertices=None, max_seconds=None)
    return replace(
        options,
        max_vertices=int(rng.choice([5, 100, 2000, 2000])),
        max_seconds=float(rng.choice([1e-6, 1.0, 20.0, 20.0])),
    )
