"""The compiled core of anistar."""

from collections.abc import Sequence
import enum
from typing import Any

import numpy
from numpy.typing import NDArray

class MeshingError(RuntimeError):
    pass

class MeshArrays:
    """A mesh as arrays, which are not copied."""

    def __init__(
        self,
        *,
        points: NDArray[numpy.float64],
        cells: NDArray[numpy.int32],
        cell_tags: NDArray[numpy.int32],
        facets: NDArray[numpy.int32],
        facet_tags: NDArray[numpy.int32],
        edges: NDArray[numpy.int32],
        edge_tags: NDArray[numpy.int32],
        corners: NDArray[numpy.int32],
    ) -> None: ...
    @property
    def points(self) -> NDArray[numpy.float64]: ...
    @property
    def cells(self) -> NDArray[numpy.int32]: ...
    @property
    def cell_tags(self) -> NDArray[numpy.int32]: ...
    @property
    def facets(self) -> NDArray[numpy.int32]: ...
    @property
    def facet_tags(self) -> NDArray[numpy.int32]: ...
    @property
    def edges(self) -> NDArray[numpy.int32]: ...
    @property
    def edge_tags(self) -> NDArray[numpy.int32]: ...
    @property
    def corners(self) -> NDArray[numpy.int32]: ...

class MetricMesh:
    """
    A mesh with its walls and the metric at its points, which are not copied: what a certificate says of it.
    """

    def __init__(
        self,
        *,
        points: NDArray[numpy.float64],
        cells: NDArray[numpy.int32],
        facets: NDArray[numpy.int32],
        metric: NDArray[numpy.float64],
    ) -> None: ...
    def delaunay(self, *, threads: int) -> NDArray[numpy.uint8]:
        """Per cell, bit k: it is Delaunay in the metric of its vertex k."""

    def delaunay_across_interfaces(self, *, threads: int) -> NDArray[numpy.uint8] | None:
        """
        The same where interfaces are no walls; None where there is no interface.
        """

    def exempt(self, *, star_ok: NDArray[numpy.uint8]) -> NDArray[numpy.uint8]:
        """Per vertex, whether its star fails and may, at a sharp corner."""

    def distortion(self, *, threads: int) -> NDArray[numpy.float64]:
        """Per vertex, the largest distortion along its edges."""

    def circumspheres(
        self, *, delaunay: NDArray[numpy.uint8], threads: int
    ) -> tuple[NDArray[numpy.float64], NDArray[numpy.float64], tuple[int, int], tuple[int, int]]:
        """
        Per cell the radius-edge ratio and the sliverity; and for both versions of the paper (how many, of how many) cells are in the restricted stars of all their vertices.
        """

    def violator(self, *, cell: int, metric: NDArray[numpy.float64]) -> int:
        """
        A vertex that the cell reaches inside its circumsphere for one metric, -1 when it is Delaunay.
        """

    def surface_delaunay(
        self, *, bulges: NDArray[numpy.float64], threads: int
    ) -> NDArray[numpy.uint8]:
        """Per facet, bit k: it is in the surface star of its vertex k."""

    def surface_violator(
        self, *, bulges: NDArray[numpy.float64], facet: int, corner: int
    ) -> tuple[int, float]:
        """
        A vertex that a facet reaches inside its surface ball for the metric of a corner, -1 when there is none, and the shift of that ball.
        """

def facet_bulges(mesh: MeshArrays, shape: DomainShape) -> NDArray[numpy.float64]:
    """
    Heights of the smooth shape over the middles of the edges opposite the vertices of every facet, (k, 3); in 2D over its middle, (k, 1).
    """

def intersect(
    first: NDArray[numpy.float64], second: NDArray[numpy.float64]
) -> NDArray[numpy.float64]:
    """Intersect two fields of metrics (n, d, d) by simultaneous reduction."""

def exp(values: NDArray[numpy.float64]) -> NDArray[numpy.float64]:
    """exp of values (n,)."""

def log(values: NDArray[numpy.float64]) -> NDArray[numpy.float64]:
    """Natural logarithm of values (n,)."""

def power(values: NDArray[numpy.float64], exponent: float) -> NDArray[numpy.float64]:
    """A power of values (n,) that are not negative."""

def cosine(values: NDArray[numpy.float64]) -> NDArray[numpy.float64]:
    """Cosine of angles (n,) in radians."""

def angle_of(y: NDArray[numpy.float64], x: NDArray[numpy.float64]) -> NDArray[numpy.float64]:
    """The angles (n,) of the vectors (x, y), in [-pi, pi]."""

def grade(
    points: NDArray[numpy.float64],
    metric: NDArray[numpy.float64],
    offsets: NDArray[numpy.int32],
    neighbours: NDArray[numpy.int32],
    *,
    model: str,
    log_factor: float,
    max_distortion: float,
    tolerance: float,
    max_rounds: int,
) -> tuple:
    """
    Grade a metric (n, d, d) along a graph given by offsets and neighbours; returns (metric, rounds, updates, converged).
    """

def pieces(
    points: NDArray[numpy.float64], cells: NDArray[numpy.int32], metric: NDArray[numpy.float64]
) -> tuple[NDArray[numpy.float64], NDArray[numpy.float64]]:
    """
    Into how many pieces a metric divides the longest edge of each point, and the fewest among its neighbours.
    """

def spectra(tensors: NDArray[numpy.float64]) -> tuple:
    """
    Eigenvalues (n, d), increasing, and eigenvectors (n, d, d) in columns of symmetric tensors (n, d, d).
    """

def compose(
    values: NDArray[numpy.float64], vectors: NDArray[numpy.float64]
) -> NDArray[numpy.float64]:
    """The tensors (n, d, d) with the given eigenvalues and eigenvectors."""

def product(
    first: NDArray[numpy.float64], second: NDArray[numpy.float64]
) -> NDArray[numpy.float64]:
    """The products of matrices (n, d, d)."""

def wide_graph(cells: NDArray[numpy.int32], n_points: int) -> tuple:
    """
    The graph of the edges of a mesh and of the vertices opposite across facets; returns (offsets, neighbours).
    """

def close_facets2(
    points: NDArray[numpy.float64], facets: NDArray[numpy.int32], contact: float
) -> NDArray[numpy.int32]:
    """Pairs of facets without a clear gap between them, each once, (n, 2)."""

def close_facets3(
    points: NDArray[numpy.float64], facets: NDArray[numpy.int32], contact: float
) -> NDArray[numpy.int32]:
    """Pairs of facets without a clear gap between them, each once, (n, 2)."""

class Locator2:
    """Exact point location in a simplicial mesh."""

    def __init__(self, points: NDArray[numpy.float64], cells: NDArray[numpy.int32]) -> None: ...
    def locate(
        self, queries: NDArray[numpy.float64]
    ) -> tuple[NDArray[numpy.int32], NDArray[numpy.float64], NDArray[numpy.float64]]:
        """
        Cell, barycentric coordinates and distance of the mesh point nearest to each query.
        """

class Locator3:
    """Exact point location in a simplicial mesh."""

    def __init__(self, points: NDArray[numpy.float64], cells: NDArray[numpy.int32]) -> None: ...
    def locate(
        self, queries: NDArray[numpy.float64]
    ) -> tuple[NDArray[numpy.int32], NDArray[numpy.float64], NDArray[numpy.float64]]:
        """
        Cell, barycentric coordinates and distance of the mesh point nearest to each query.
        """

def nearest_facets2(
    points: NDArray[numpy.float64], facets: NDArray[numpy.int32], queries: NDArray[numpy.float64]
) -> tuple[NDArray[numpy.int32], NDArray[numpy.float64]]:
    """The row of the facet nearest to each query, and its distance."""

def nearest_in_metric2(
    points: NDArray[numpy.float64],
    queries: NDArray[numpy.float64],
    metrics: NDArray[numpy.float64],
    seeds: NDArray[numpy.int32],
) -> NDArray[numpy.int32]:
    """The point nearest to each query in the query's own metric."""

def nearest_facets3(
    points: NDArray[numpy.float64], facets: NDArray[numpy.int32], queries: NDArray[numpy.float64]
) -> tuple[NDArray[numpy.int32], NDArray[numpy.float64]]:
    """The row of the facet nearest to each query, and its distance."""

def nearest_in_metric3(
    points: NDArray[numpy.float64],
    queries: NDArray[numpy.float64],
    metrics: NDArray[numpy.float64],
    seeds: NDArray[numpy.int32],
) -> NDArray[numpy.int32]:
    """The point nearest to each query in the query's own metric."""

def constrained_tetrahedra(
    *,
    points: NDArray[numpy.float64],
    triangles: NDArray[numpy.int32],
    triangle_facets: NDArray[numpy.int32],
    segments: NDArray[numpy.int32],
    kept_points: NDArray[numpy.int32],
    seeds: NDArray[numpy.float64],
    seed_tags: NDArray[numpy.int32],
    holes: NDArray[numpy.float64],
    rule: str,
    facets_may_flip: bool,
    max_seconds: float,
    callback: object | None,
) -> dict[str, Any]:
    """
    Constrained Delaunay tetrahedra of a piecewise linear complex, as arrays by name.
    """

class Flaw(enum.Enum):
    """What can be wrong with a complex."""

    out_of_range = 0

    repeated_point = 1

    empty_edge = 2

    repeated_edge = 3

    degenerate_triangle = 4

    repeated_triangle = 5

    overlap = 6

    crossing = 7

    touching = 8

    point_on_edge = 9

    point_on_facet = 10

    open_border = 11

    thin_triangle = 12

    near_miss = 13

    crowded_edge = 14

class Problem:
    """Something that is wrong with a complex."""

    @property
    def flaw(self) -> Flaw: ...
    @property
    def triangles(self) -> list[int]: ...
    @property
    def edges(self) -> list[list[int]]: ...
    @property
    def points(self) -> list[int]: ...
    @property
    def where(self) -> list[float]: ...
    @property
    def measure(self) -> float: ...

class Problems:
    """What is wrong with a complex, a few of a kind."""

    @property
    def listed(self) -> list[Problem]: ...
    @property
    def totals(self) -> list[int]: ...
    @property
    def is_complete(self) -> bool: ...

def check_plc(
    points: NDArray[numpy.float64],
    triangles: NDArray[numpy.int32],
    triangle_facets: NDArray[numpy.int32],
    segments: NDArray[numpy.int32],
    points_kept: NDArray[numpy.int32],
    listed: int,
    near_distance: float,
) -> Problems:
    """What is wrong with a complex in space; `near_distance` in diagonals."""

def check_pslg(
    points: NDArray[numpy.float64],
    segments: NDArray[numpy.int32],
    points_kept: NDArray[numpy.int32],
    listed: int,
    near_distance: float,
) -> Problems:
    """What is wrong with segments and points in the plane."""

def cut_triangles(
    points: NDArray[numpy.float64], triangles: NDArray[numpy.int32]
) -> tuple[NDArray[numpy.float64], NDArray[numpy.int32], NDArray[numpy.int32]]:
    """
    Points, triangles and the source of each, cut where triangles meet others.
    """

def turned_triangles(
    points: NDArray[numpy.float64], triangles: NDArray[numpy.int32]
) -> tuple[NDArray[numpy.uint8], int, int]:
    """
    Which triangles to turn for an outer side, and the numbers of parts that are open and that have one side only.
    """

def wrap_triangles(
    points: NDArray[numpy.float64], triangles: NDArray[numpy.int32], alpha: float, offset: float
) -> tuple[NDArray[numpy.float64], NDArray[numpy.int32], NDArray[numpy.int32]]:
    """A closed surface around triangles."""

def supermesh2(
    source_points: NDArray[numpy.float64],
    source_cells: NDArray[numpy.int32],
    source_regions: NDArray[numpy.int32],
    target_points: NDArray[numpy.float64],
    target_cells: NDArray[numpy.int32],
    target_regions: NDArray[numpy.int32],
    nodal: NDArray[numpy.float64],
    *,
    points: bool,
    blocks: bool,
    threads: int,
    callback: object | None,
) -> dict:
    """
    Lay two meshes over each other: matrices (starts, columns, values) between points and between cells, moments of the pairs, loads of nodal values, and coverage.
    """

def supermesh3(
    source_points: NDArray[numpy.float64],
    source_cells: NDArray[numpy.int32],
    source_regions: NDArray[numpy.int32],
    target_points: NDArray[numpy.float64],
    target_cells: NDArray[numpy.int32],
    target_regions: NDArray[numpy.int32],
    nodal: NDArray[numpy.float64],
    *,
    points: bool,
    blocks: bool,
    threads: int,
    callback: object | None,
) -> dict:
    """
    Lay two meshes over each other: matrices (starts, columns, values) between points and between cells, moments of the pairs, loads of nodal values, and coverage.
    """

class SymmetricSystem:
    """A sparse symmetric positive semi-definite system."""

    def __init__(
        self,
        starts: NDArray[numpy.int64],
        columns: NDArray[numpy.int32],
        values: NDArray[numpy.float64],
    ) -> None: ...
    def solve(
        self,
        rights: NDArray[numpy.float64],
        starts: NDArray[numpy.float64],
        *,
        residual: float,
        max_steps: int,
    ) -> tuple:
        """
        Solve for the rows of `rights`, from those of `starts`; returns (solutions, stop reasons, residuals).
        """

class ShapeKind(enum.Enum):
    smooth = 0

    polyhedron = 1

    faceted = 2

class DomainShape:
    """What the facets of a geometry mean."""

    def __init__(self) -> None: ...
    @property
    def kind(self) -> ShapeKind: ...
    @kind.setter
    def kind(self, arg: ShapeKind, /) -> None: ...
    @property
    def ridge_angle(self) -> float: ...
    @ridge_angle.setter
    def ridge_angle(self, arg: float, /) -> None: ...
    @property
    def frozen_tags(self) -> list[int]: ...
    @frozen_tags.setter
    def frozen_tags(self, arg: Sequence[int], /) -> None: ...

class ConsistencyMode(enum.Enum):
    off = 0

    on = 1

    pure = 2

class ConsistencyParameters:
    """Parameters of Algorithm 2."""

    def __init__(self) -> None: ...
    @property
    def alpha_0(self) -> float: ...
    @alpha_0.setter
    def alpha_0(self, arg: float, /) -> None: ...
    @property
    def alpha_1(self) -> float: ...
    @alpha_1.setter
    def alpha_1(self, arg: float, /) -> None: ...
    @property
    def rho_0(self) -> float: ...
    @rho_0.setter
    def rho_0(self, arg: float, /) -> None: ...
    @property
    def sigma_0(self) -> float: ...
    @sigma_0.setter
    def sigma_0(self, arg: float, /) -> None: ...
    @property
    def gamma_0(self) -> float: ...
    @gamma_0.setter
    def gamma_0(self, arg: float, /) -> None: ...
    @property
    def delta(self) -> float: ...
    @delta.setter
    def delta(self, arg: float, /) -> None: ...
    @property
    def beta(self) -> float: ...
    @beta.setter
    def beta(self, arg: float, /) -> None: ...
    @property
    def candidates(self) -> int: ...
    @candidates.setter
    def candidates(self, arg: int, /) -> None: ...
    @property
    def max_growth(self) -> float: ...
    @max_growth.setter
    def max_growth(self, arg: float, /) -> None: ...
    @property
    def protecting_balls(self) -> bool: ...
    @protecting_balls.setter
    def protecting_balls(self, arg: bool, /) -> None: ...

class AgreementMode(enum.Enum):
    off = 0

    when_possible = 1

    on = 2

class HausdorffNumbers:
    """
    Largest distances of curves and of surfaces from an edge, relative to its length.
    """

    def __init__(self, *, curve: float, surface: float) -> None: ...

class RemeshSettings:
    """What a remesher is told; a bound that is not set is off."""

    def __init__(self) -> None: ...
    @property
    def shape(self) -> DomainShape: ...
    @shape.setter
    def shape(self, arg: DomainShape, /) -> None: ...
    @property
    def hausdorff(self) -> HausdorffNumbers: ...
    @hausdorff.setter
    def hausdorff(self, arg: HausdorffNumbers, /) -> None: ...
    @property
    def max_vertices(self) -> int: ...
    @max_vertices.setter
    def max_vertices(self, arg: int, /) -> None: ...
    @property
    def max_seconds(self) -> float: ...
    @max_seconds.setter
    def max_seconds(self, arg: float, /) -> None: ...
    @property
    def agreement(self) -> AgreementMode: ...
    @agreement.setter
    def agreement(self, arg: AgreementMode, /) -> None: ...
    @property
    def consistency(self) -> ConsistencyMode: ...
    @consistency.setter
    def consistency(self, arg: ConsistencyMode, /) -> None: ...
    @property
    def parameters(self) -> ConsistencyParameters: ...
    @parameters.setter
    def parameters(self, arg: ConsistencyParameters, /) -> None: ...
    @property
    def seed(self) -> int: ...
    @seed.setter
    def seed(self, arg: int, /) -> None: ...
    @property
    def threads(self) -> int: ...
    @threads.setter
    def threads(self, arg: int, /) -> None: ...

class StopReason(enum.Enum):
    finished = 0

    max_vertices = 1

    max_seconds = 2

class ConsistencyStop(enum.Enum):
    none_yet = 0

    consistent = 1

    stalled = 2

    no_mesh = 3

    max_growth = 4

    max_rounds = 5

    max_vertices = 6

    max_seconds = 7

class AgreementOutcome(enum.Enum):
    off = 0

    stopped_before = 1

    varies_too_fast = 2

    stopped = 3

    done = 4

class AgreementStop(enum.Enum):
    agreed = 0

    stalled = 1

    rounds = 2

    trials = 3

    interrupted = 4

class AgreementReport:
    """What became of agreement."""

    @property
    def outcome(self) -> AgreementOutcome: ...
    @property
    def stopped_by(self) -> StopReason: ...
    @property
    def percent(self) -> int: ...
    @property
    def ln_gamma(self) -> float: ...
    @property
    def largest_ln_gamma(self) -> float: ...
    @property
    def stop(self) -> AgreementStop: ...
    @property
    def disagreeing(self) -> int: ...

class CertifiedFractions:
    @property
    def simplex_ok(self) -> float: ...
    @property
    def star_ok(self) -> float: ...

class RemeshResult:
    """A new mesh, the metric at its points, and what happened."""

    @property
    def mesh(self) -> MeshArrays: ...
    @property
    def metric(self) -> NDArray[numpy.float64]: ...
    @property
    def delaunay(self) -> NDArray[numpy.uint8] | None: ...
    @property
    def statistics(self) -> dict[str, Any]: ...
    @property
    def kept_quality(self) -> float: ...
    @property
    def distortion(self) -> dict[str, float]: ...
    @property
    def agreement(self) -> AgreementReport: ...
    @property
    def consistency(self) -> dict[str, float]: ...
    @property
    def consistency_stop(self) -> ConsistencyStop: ...
    @property
    def certified(self) -> CertifiedFractions | None: ...
    @property
    def counts(self) -> dict[str, int]: ...
    @property
    def seconds(self) -> dict[str, float]: ...
    @property
    def stop_reason(self) -> StopReason: ...

def remesh(
    *,
    mesh: MeshArrays,
    metric: NDArray[numpy.float64],
    geometry: MeshArrays,
    settings: RemeshSettings,
    project: object | None,
    callback: object | None,
) -> RemeshResult:
    """
    A mesh of the geometry with unit edges in the metric that the mesh carries.
    """

def facet_shapes(
    geometry: MeshArrays, shape: DomainShape
) -> tuple[
    NDArray[numpy.float64], NDArray[numpy.float64], NDArray[numpy.float64], NDArray[numpy.float64]
]:
    """
    Measure of the smooth shape at each facet, what it adds behind the facet, and how far it may lie from it; length of the smooth ridge at each edge.
    """

class Surface3:
    """The smooth surfaces and ridges through given facets."""

    def __init__(self, geometry: MeshArrays, shape: DomainShape) -> None: ...
    def project(
        self, queries: NDArray[numpy.float64], tag: int
    ) -> tuple[NDArray[numpy.float64], NDArray[numpy.float64]]:
        """Feet of points on the surfaces with a tag, and unit normals there."""

    def project_on_ridge(
        self, queries: NDArray[numpy.float64], tag: int | None
    ) -> NDArray[numpy.float64]:
        """Feet of points on the ridges with a tag; None: those without one."""

    def ridges(self) -> NDArray[numpy.int32]:
        """The edges that are ridges, (k, 2)."""

    def curvature(self, n_points: int) -> NDArray[numpy.float64]:
        """
        The (n, 3, 3) curvature tensors at the points: principal curvatures with their directions, of the most curved patch; zero off the surfaces.
        """

def first_at_place(points: NDArray[numpy.float64]) -> NDArray[numpy.int32]:
    """Of each point the first one that is exactly where it is."""

def triangulated_facets(
    points: NDArray[numpy.float64],
    indices: NDArray[numpy.int32],
    loop_starts: NDArray[numpy.int64],
    facet_starts: NDArray[numpy.int64],
    edges: NDArray[numpy.int32],
    flatness: float,
) -> tuple:
    """
    The triangles of polygon facets, the facet of each, and how far the points of each facet lie from its plane.
    """

def planar_facets(
    points: NDArray[numpy.float64],
    triangles: NDArray[numpy.int32],
    tags: NDArray[numpy.int32],
    degrees: float,
    distance: float,
    rounding: float,
) -> NDArray[numpy.int32]:
    """The planar facet of each triangle of a surface."""

def surface_loops(
    points: NDArray[numpy.float64],
    triangles: NDArray[numpy.int32],
    owners: NDArray[numpy.int32],
    n_facets: int,
) -> tuple:
    """
    The loops around facets of triangles: (indices, loop_starts, facet_starts).
    """

class Inside(enum.Enum):
    parity = 0

    winding = 1

    nonzero = 2

def constrained_triangles(
    *,
    points: NDArray[numpy.float64],
    segments: NDArray[numpy.int32],
    turns: NDArray[numpy.int32],
    points_kept: NDArray[numpy.int32],
    seeds: NDArray[numpy.float64],
    seed_tags: NDArray[numpy.int32],
    holes: NDArray[numpy.float64],
    inside: Inside,
    max_seconds: float,
    callback: object | None,
) -> MeshArrays:
    """
    The constrained Delaunay mesh of what segments enclose. All points are there; the tags of facets are their segments.
    """

def refined_triangles(
    mesh: MeshArrays,
    *,
    given_points: NDArray[numpy.float64],
    segments: NDArray[numpy.int32],
    bound: float,
    sizes: NDArray[numpy.float64],
    region_tags: NDArray[numpy.int32],
    region_sizes: NDArray[numpy.float64],
    max_vertices: int,
    max_seconds: float,
    callback: object | None,
) -> tuple[MeshArrays, dict[str, int], StopReason]:
    """
    A constrained mesh after Delaunay refinement, what was counted, and what ended it.
    """

class SliverSettings:
    """What Li's elimination of slivers may choose."""

    def __init__(self) -> None: ...
    @property
    def are_eliminated(self) -> bool: ...
    @are_eliminated.setter
    def are_eliminated(self, arg: bool, /) -> None: ...
    @property
    def least_dihedral(self) -> float: ...
    @least_dihedral.setter
    def least_dihedral(self, arg: float, /) -> None: ...
    @property
    def delta(self) -> float: ...
    @delta.setter
    def delta(self, arg: float, /) -> None: ...
    @property
    def rho_0(self) -> float: ...
    @rho_0.setter
    def rho_0(self, arg: float, /) -> None: ...
    @property
    def C(self) -> float: ...
    @C.setter
    def C(self, arg: float, /) -> None: ...
    @property
    def n_picks(self) -> int: ...
    @n_picks.setter
    def n_picks(self, arg: int, /) -> None: ...
    def meet_conditions(self) -> bool: ...

class RefinementSettings:
    """What Delaunay refinement is told."""

    def __init__(self) -> None: ...
    @property
    def bound(self) -> float: ...
    @bound.setter
    def bound(self, arg: float, /) -> None: ...
    @property
    def shortest_edge(self) -> float: ...
    @shortest_edge.setter
    def shortest_edge(self, arg: float, /) -> None: ...
    @property
    def slivers(self) -> SliverSettings: ...
    @slivers.setter
    def slivers(self, arg: SliverSettings, /) -> None: ...
    @property
    def max_vertices(self) -> int: ...
    @max_vertices.setter
    def max_vertices(self, arg: int, /) -> None: ...
    @property
    def max_seconds(self) -> float: ...
    @max_seconds.setter
    def max_seconds(self, arg: float, /) -> None: ...
    @property
    def seed(self) -> int: ...
    @seed.setter
    def seed(self, arg: int, /) -> None: ...

def refined_tetrahedra(
    *,
    points: NDArray[numpy.float64],
    cells: NDArray[numpy.int32],
    cell_regions: NDArray[numpy.int32],
    walls: NDArray[numpy.int32],
    wall_facets: NDArray[numpy.int32],
    edges: NDArray[numpy.int32],
    edge_segments: NDArray[numpy.int32],
    sizes: NDArray[numpy.float64],
    settings: RefinementSettings,
    callback: object | None,
) -> dict[str, Any]:
    """Tetrahedra after Delaunay refinement, and what the rules did, by name."""
