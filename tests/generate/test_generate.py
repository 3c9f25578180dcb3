"""First meshes of small geometries, by every method, with all that comes along."""

import json

import numpy as np
import pytest

import anistar
from anistar.generating.report.shapes import CellShapes
from anistar.judging.quality import metric_lengths
from anistar.meshes.topology import cell_volumes, edge_lengths, facet_measures, unique_edges

SIDES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
NAMES = {(2, 1): "left", (2, 2): "right"}


def box(extent=(1.0, 1.0, 1.0), **others):
    """A box of six facets, tagged 1 to 6; 1 and 2 are called left and right."""
    corners = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    points = np.array(corners, float) * extent
    return anistar.PLC(points, facets=SIDES, facet_tags=range(1, 7), names=NAMES, **others)


def two_boxes(**others):
    """Two unit cubes, the second on the right of the first, that share a facet with the tag 7."""
    corners = [[x, y, z] for x in (0, 1, 2) for y in (0, 1) for z in (0, 1)]
    around = [[s[k] + 4 * shift for k in range(4)] for s in SIDES[2:] for shift in (0, 1)]
    facets = [SIDES[0], [8, 10, 11, 9], *around, SIDES[1]]
    seeds = [(0.5, 0.5, 0.5), (1.5, 0.5, 0.5)]
    regions = [
        anistar.Region(seeds[0], 10, name="steel"),
        anistar.Region(seeds[1], 20, size=others.pop("size", None), name="air"),
    ]
    tags = [1, 2, *[3] * 8, 7]
    return anistar.PLC(np.array(corners, float), facets=facets, facet_tags=tags, regions=regions)


def icosphere(rounds):
    """A sphere of radius 1 as triangles."""
    golden = (1 + 5**0.5) / 2
    points = [[s, t * golden, 0] for s in (-1, 1) for t in (-1, 1)]
    points = np.array([np.roll(p, k) for k in range(3) for p in points], float)
    length = edge_lengths(points, np.array([[i, j] for i in range(12) for j in range(i)])).min()
    near = lambda i, j: abs(np.sqrt(((points[i] - points[j]) ** 2).sum()) - length) < 1e-9  # noqa: E731
    triangles = [
        (i, j, k)
        for i in range(12)
        for j in range(i)
        for k in range(j)
        if near(i, j) and near(j, k) and near(i, k)
    ]
    triangles = np.array(triangles)
    for _ in range(rounds):
        edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        unique, middle = np.unique(edges, axis=0, return_inverse=True)
        a, b, c = triangles.T
        d, e, f = middle.reshape(-1, 3).T + len(points)
        points = np.vstack([points, points[unique].mean(axis=1)])
        triangles = np.stack([[a, d, f], [d, b, e], [f, e, c], [d, e, f]]).transpose(2, 0, 1)
        triangles = triangles.reshape(-1, 3)
    points /= np.sqrt((points**2).sum(axis=1))[:, None]
    outward = np.einsum("ni,ni->n", np.cross(*_legs(points, triangles)), points[triangles[:, 0]])
    triangles[outward < 0] = triangles[outward < 0][:, ::-1]
    return points, triangles


def _legs(points, triangles):
    a, b, c = points[triangles].transpose(1, 0, 2)
    return b - a, c - a


def areas(mesh):
    size = facet_measures(mesh.points, mesh.facets)
    return {int(t): size[mesh.facet_tags == t].sum() for t in np.unique(mesh.facet_tags)}


def volumes(mesh):
    size = cell_volumes(mesh.points, mesh.cells)
    return {int(t): size[mesh.cell_tags == t].sum() for t in np.unique(mesh.cell_tags)}


def unit_share(mesh, M):
    lengths = metric_lengths(mesh, M, unique_edges(mesh.cells, mesh.n_points))
    return np.mean((lengths > 0.7) & (lengths < 1.42))


@pytest.fixture(scope="module")
def cube():
    return anistar.generate(box(), 0.15)


def test_a_mesh_has_the_tags_names_corners_and_ridges_of_its_geometry(cube):
    mesh = cube.mesh
    assert anistar.validate(mesh) == []
    assert areas(mesh) == pytest.approx(dict.fromkeys(range(1, 7), 1.0), rel=1e-12)
    assert mesh.names == NAMES
    assert len(mesh.corners) == 8
    assert edge_lengths(mesh.points, mesh.edges).sum() == pytest.approx(12.0, rel=1e-12)
    assert cell_volumes(mesh.points, mesh.cells).sum() == pytest.approx(1.0, rel=1e-12)


def test_a_mesh_has_the_size_asked_for(cube):
    M = np.repeat(np.eye(3)[None] / 0.15**2, cube.mesh.n_points, 0)
    assert unit_share(cube.mesh, M) > 0.9
    assert cube.report.shapes.angle_min > 12.0
    assert cube.report.converged


def test_the_volume_between_a_facet_and_what_became_of_it_is_told():
    """A corner lifted by a millionth makes a side of two planes that is one facet all the same."""
    lift = 1e-6
    points = box().points.copy()
    points[0, 0] -= lift
    triangles = [t for a, b, c, d in SIDES for t in ([a, b, c], [a, c, d])]
    plc = anistar.PLC.from_surface(points, triangles)
    assert plc.n_facets == 6
    # of the two ways to cut the side, one encloses a third of half of the lift more
    measures = anistar.generate(plc, method="constrained").report.measures
    assert min(measures.volume_between, abs(measures.volume_between - lift / 6)) < 1e-12
    measures = anistar.generate(plc, 0.2).report.measures
    assert 1e-9 < measures.volume_between < lift
    assert anistar.generate(box(), 0.2).report.measures.volume_between < 1e-15


def test_the_report_says_what_was_done_in_builtins(cube):
    told = json.loads(json.dumps(cube.report.as_dict()))
    assert told["method"] == "remesh"
    assert told["n_points"] == cube.mesh.n_points
    assert told["measures"]["facet_error"] < 1e-12
    assert told["shapes"]["angle_min"] == CellShapes.of(cube.mesh).angle_min
    assert {"checking", "constrained", "remesh"} <= told["seconds"].keys()
    assert "least_angle" in repr(cube)


def test_the_same_mesh_comes_with_any_number_of_threads(cube):
    again = anistar.generate(box(), 0.15, threads=2).mesh
    assert again.points.tobytes() == cube.mesh.points.tobytes()
    assert again.cells.tobytes() == cube.mesh.cells.tobytes()


def test_without_a_size_thin_parts_get_small_cells():
    made = anistar.generate(box((1.0, 1.0, 0.1)))
    assert anistar.validate(made.mesh) == []
    assert made.report.shapes.angle_min > 12.0
    assert edge_lengths(made.mesh.points, made.mesh.edges).max() < 0.2


def test_sizes_may_be_a_function_of_the_place():
    def size(points):
        return 0.05 + 0.3 * np.abs(points[:, 0] - 0.3)

    mesh = anistar.generate(box(), size).mesh
    M = np.eye(3) / size(mesh.points)[:, None, None] ** 2
    assert anistar.validate(mesh) == []
    assert unit_share(mesh, M) > 0.85


def test_sizes_at_points_grow_inward():
    sizes = np.array([0.03, *[np.inf] * 7])
    mesh = anistar.generate(box(), sizes).mesh
    lengths = edge_lengths(mesh.points, unique_edges(mesh.cells, mesh.n_points))
    assert lengths.min() < 0.05
    assert lengths.max() > 0.2


def test_sizes_may_be_given_for_names():
    mesh = anistar.generate(box(), 0.3, size_at={"left": 0.1}).mesh
    left = mesh.facets[mesh.facet_tags == 1]
    right = mesh.facets[mesh.facet_tags == 2]
    assert len(left) > 4 * len(right)
    with pytest.raises(ValueError, match="left"):
        anistar.generate(box(), 0.3, size_at={"lift": 0.1})


M_FLAT = np.diag([1 / 0.05**2, 1 / 0.3**2, 1 / 0.3**2])


@pytest.mark.parametrize(
    "metric",
    [
        np.repeat(M_FLAT[None], 8, 0),
        lambda points: np.repeat(M_FLAT[None], len(points), 0),
    ],
    ids=["array", "function"],
)
def test_a_metric_makes_the_first_mesh_anisotropic(metric):
    mesh = anistar.generate(box(), metric=metric).mesh
    assert anistar.validate(mesh) == []
    assert unit_share(mesh, np.repeat(M_FLAT[None], mesh.n_points, 0)) > 0.85


def test_a_metric_may_live_on_another_mesh(cube):
    M = np.repeat(M_FLAT[None], cube.mesh.n_points, 0)
    mesh = anistar.generate(box(), metric=(cube.mesh, M)).mesh
    assert unit_share(mesh, np.repeat(M_FLAT[None], mesh.n_points, 0)) > 0.85


@pytest.mark.parametrize("method", ["constrained", "remesh", "refine"])
def test_regions_and_interfaces_are_kept_exactly(method):
    size = None if method == "constrained" else 0.4
    mesh = anistar.generate(two_boxes(), size, method=method).mesh
    assert anistar.validate(mesh) == []
    assert volumes(mesh) == pytest.approx({10: 1.0, 20: 1.0}, rel=1e-12)
    assert areas(mesh) == pytest.approx({1: 1.0, 2: 1.0, 3: 8.0, 7: 1.0}, rel=1e-12)
    assert mesh.names == {(3, 10): "steel", (3, 20): "air"}


def test_a_region_may_have_a_size():
    mesh = anistar.generate(two_boxes(size=0.1), 0.5).mesh
    assert np.mean(mesh.cell_tags == 20) > 0.8


def test_a_smooth_surface_is_met_through_its_points():
    points, triangles = icosphere(2)
    plc = anistar.PLC.from_surface(points, triangles)
    flat = anistar.generate(plc, method="constrained").mesh
    smooth = anistar.generate(plc, 0.12, shape="smooth").mesh
    assert anistar.validate(smooth) == []
    sphere = 4 / 3 * np.pi
    lost = [1 - sum(volumes(mesh).values()) / sphere for mesh in (flat, smooth)]
    assert 0.0 < lost[1] < 0.4 * lost[0]


def test_the_constrained_mesh_has_no_points_but_those_given():
    made = anistar.generate(box(), method="constrained")
    assert made.mesh.n_points == 8
    assert made.report.constrained["steiner_points"] == 0
    with pytest.raises(ValueError, match="constrained"):
        anistar.generate(box(), 0.1, method="constrained")


def test_refinement_keeps_its_bounds():
    made = anistar.generate(box(), 0.2, method="refine")
    assert anistar.validate(made.mesh) == []
    assert made.report.shapes.radius_edge_max <= 2.0
    assert made.report.shapes.angle_min >= 10.0
    assert areas(made.mesh) == pytest.approx(dict.fromkeys(range(1, 7), 1.0), rel=1e-12)
    with pytest.raises(ValueError, match="isotropic"):
        anistar.generate(box(), metric=np.repeat(M_FLAT[None], 8, 0), method="refine")


@pytest.mark.parametrize("method", ["remesh", "refine"])
def test_a_budget_leaves_a_valid_mesh(method):
    made = anistar.generate(box(), 0.02, method=method, max_vertices=500)
    assert anistar.validate(made.mesh) == []
    assert not made.report.converged
    assert made.report.stop_reason == "max_vertices"
    assert made.mesh.n_points < 600


def test_what_cannot_be_meshed_is_named():
    crossing = np.array([[0.5, 0.5, -1.0], [0.5, 0.6, 2.0], [0.6, 0.5, 2.0]])
    points = np.vstack([box().points, crossing])
    plc = anistar.PLC(points, facets=[*SIDES, [8, 9, 10]])
    with pytest.raises(anistar.PLCError, match="facets 4 and 6") as caught:
        anistar.generate(plc, 0.1)
    assert {problem.kind for problem in caught.value.problems} >= {"crossing"}


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"size": 0.1, "metric": np.repeat(M_FLAT[None], 8, 0)}, "not both"),
        ({"size": -0.1}, "positive"),
        ({"size": np.ones(7)}, "8 points"),
        ({"size": 0.1, "methods": "refine"}, "method"),
        ({"size": 0.1, "method": "advance"}, "remesh"),
        ({"size": 0.1, "bound": 0.5}, "bound"),
        ({"metric": np.ones((8, 2, 2))}, "shape"),
    ],
)
def test_wrong_calls_say_what_is_wrong(given, message):
    with pytest.raises((ValueError, TypeError), match=message):
        anistar.generate(box(), **given)


def test_a_mesh_may_come_as_that_of_another_package():
    meshio = pytest.importorskip("meshio")
    made = anistar.generate(box(), 0.5, like="meshio")
    assert isinstance(made, meshio.Mesh)


def test_a_callback_may_interrupt():
    def stop(phase, fraction):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        anistar.generate(box(), 0.05, callback=stop)


def square_with_hole():
    outer = [(0, 0), (2, 0), (2, 1), (0, 1)]
    inner = [(0.5, 0.4), (1.0, 0.4), (1.0, 0.6), (0.5, 0.6)]
    loops = [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4]]
    tags = [1, 2, 3, 4, 5, 5, 5, 5]
    return anistar.PLC(
        np.array([*outer, *inner], float), edges=loops, edge_tags=tags, names={(1, 5): "hole"}
    )


@pytest.mark.parametrize("method", ["constrained", "remesh", "refine"])
def test_the_plane_takes_the_same_calls(method):
    size = None if method == "constrained" else 0.1
    made = anistar.generate(square_with_hole(), size, method=method)
    mesh = made.mesh
    assert anistar.validate(mesh) == []
    wanted = {1: 2.0, 2: 1.0, 3: 2.0, 4: 1.0, 5: 1.4}
    assert areas(mesh) == pytest.approx(wanted, rel=1e-12)
    assert cell_volumes(mesh.points, mesh.cells).sum() == pytest.approx(1.9, rel=1e-12)
    assert mesh.names == {(1, 5): "hole"}
    if method != "constrained":
        assert made.report.shapes.angle_min > 25.0


@pytest.mark.parametrize("method", ["remesh", "refine"])
def test_in_the_plane_sizes_belong_to_names_and_tags_by_every_method(method):
    mesh = anistar.generate(square_with_hole(), 0.5, size_at={"hole": 0.05}, method=method).mesh
    at_hole = mesh.facets[mesh.facet_tags == 5]
    assert edge_lengths(mesh.points, at_hole).max() < 0.08
    other = anistar.generate(square_with_hole(), 0.5, size_at={4: 0.05}, method=method).mesh
    assert edge_lengths(other.points, other.facets[other.facet_tags == 4]).max() < 0.08
    assert edge_lengths(other.points, other.facets[other.facet_tags == 2]).max() > 0.15


@pytest.mark.parametrize("given", [box, square_with_hole])
def test_sizes_that_are_all_infinite_ask_for_nothing(given):
    plc = given()
    made = anistar.generate(plc, np.full(plc.n_points, np.inf))
    assert anistar.validate(made.mesh) == []
    assert made.report.converged


def test_a_budget_that_is_too_small_for_a_close_look_may_do_for_the_mesh():
    made = anistar.generate(box(), lambda points: np.full(len(points), 0.35), max_vertices=1000)
    assert made.report.converged
    assert made.mesh.n_points < 200


def test_refinement_sees_small_sizes_between_the_points_of_the_geometry():
    middle = np.array([0.52, 0.53, 0.55])

    def size(points):
        return np.where(((points - middle) ** 2).sum(axis=1) < 0.12**2, 0.04, 0.5)

    mesh = anistar.generate(box(), size, method="refine").mesh
    near = ((mesh.points - middle) ** 2).sum(axis=1) < 0.1**2
    assert near.sum() > 60
    ends = unique_edges(mesh.cells, mesh.n_points)
    assert edge_lengths(mesh.points, ends[near[ends].all(axis=1)]).max() < 0.085


def test_refinement_takes_no_anisotropic_size():
    M = np.repeat(M_FLAT[None], 8, 0)
    with pytest.raises(ValueError, match="isotropic"):
        anistar.generate(box(), M, method="refine")


@pytest.mark.parametrize(
    ("given", "kind", "message"),
    [
        ({"size": (box(), 1, 2)}, ValueError, "pair"),
        ({"size_at": {1: 0.1}, "method": "constrained"}, ValueError, "constrained"),
        ({"size_at": [1]}, TypeError, "mapping"),
    ],
)
def test_wishes_of_a_wrong_form_are_named(given, kind, message):
    with pytest.raises(kind, match=message):
        anistar.generate(box(), **given)


def test_a_tuple_of_numbers_is_as_good_as_an_array():
    made = [anistar.generate(box(), kind([0.4] * 8)).mesh for kind in (tuple, np.array)]
    assert made[0].points.tobytes() == made[1].points.tobytes()


@pytest.mark.parametrize("method", ["remesh", "refine"])
def test_a_point_near_a_long_edge_makes_cells_small_there_and_not_at_its_ends(method):
    points = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 1e-2]])
    plc = anistar.PLC(points, edges=[[0, 1], [1, 2], [2, 3], [3, 0], [4, 2]])
    made = anistar.generate(plc, method=method)
    assert made.report.converged
    assert made.report.shapes.angle_min > 20.0
    assert made.mesh.n_points < 500
