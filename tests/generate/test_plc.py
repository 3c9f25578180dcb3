"""The complex: what is checked, how facets are cut into triangles, which segments it has."""

import numpy as np
import pytest
from solids import CORNERS, SIDES, area, grid

from anistar import Mesh
from anistar.generating import PLC, Region, as_plc

# On the lower side of the cube: a triangle, two points on a line, and one more.
POINTS = [*CORNERS, [0.2, 0.2, 0], [0.4, 0.2, 0], [0.2, 0.4, 0], [0.5, 0.5, 0], [0.75, 0.75, 0]]


def test_a_cube_has_six_facets_and_twelve_segments():
    plc = PLC(CORNERS, facets=SIDES, facet_tags=range(6), edges=[[1, 0]], edge_tags=[7])
    assert len(plc.triangles) == 12
    assert plc.triangle_facets.tolist() == sorted(plc.triangle_facets.tolist())
    assert area(plc.points, plc.triangles) == pytest.approx(6)
    assert len(plc.segments) == 12
    assert plc.segments.tolist() == sorted(plc.segments.tolist())
    assert plc.segment_tags.tolist() == [7, *([0] * 11)]
    assert plc.facets[0] == ((0, 3, 2, 1),)
    assert "facets=6" in repr(plc)
    assert "<table>" in plc._repr_html_()


def test_arrays_are_copies_and_read_only():
    points = np.array(CORNERS)
    plc = PLC(points, facets=SIDES)
    points[0] = 9
    assert plc.points[0].tolist() == [0, 0, 0]
    for name in ("points", "triangles", "segments", "facet_tags", "holes"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(plc, name)[...] = 0


def test_triangles_are_turned_as_the_loop_of_their_facet():
    plc = PLC(CORNERS, facets=SIDES)
    a, b, c = (plc.points[plc.triangles[:, k]] for k in range(3))
    outward = (a + b + c) / 3 - 0.5
    assert (np.einsum("ij,ij->i", np.cross(b - a, c - a), outward) > 0).all()


def test_a_facet_may_have_holes_edges_and_points():
    plc = PLC(POINTS, facets=[[[0, 3, 2, 1], [8, 9, 10], [11, 12]], *SIDES[1:]])
    own = plc.triangles[plc.triangle_facets == 0]
    assert area(plc.points, own) == pytest.approx(1 - 0.02)
    rows = {
        tuple(sorted(pair)) for t in own.tolist() for pair in zip(t, t[1:] + t[:1], strict=True)
    }
    assert (11, 12) in rows
    assert [11, 12] in plc.segments.tolist()
    with_point = PLC(POINTS, facets=[[[0, 3, 2, 1], [11]]])
    assert 11 in with_point.triangles
    assert [11, 12] not in with_point.segments.tolist()


def test_given_edges_between_points_of_a_facet_are_edges_of_its_triangles():
    plc = PLC(CORNERS, facets=[[0, 1, 2, 3]], edges=[[1, 3]])
    other = PLC(CORNERS, facets=[[0, 1, 2, 3]], edges=[[0, 2]])
    assert all({1, 3} <= set(t) for t in plc.triangles.tolist())
    assert all({0, 2} <= set(t) for t in other.triangles.tolist())


def test_an_outer_loop_may_go_to_a_hole_and_back():
    keyhole = [0, 3, 2, 1, 0, 8, 9, 10, 8]
    plc = PLC(POINTS, facets=[keyhole])
    assert area(plc.points, plc.triangles) == pytest.approx(0.98)


@pytest.mark.parametrize(
    ("facet", "message"),
    [
        ([0, 1], "facet 0: its outer loop has 2 points"),
        ([0, 1, 2, 3, 0], "facet 0: loop 0 has point 0 twice in a row"),
        ([0, 1, 1], "its three points are not different"),
        ([0, 1, 2, 6, 3], "facet 0: it is not planar: point .* lies 0.0894"),
        ([0, 1, 3, 2, 9], "facet 0: its edges .* cross"),
        ([[0, 1, 2, 3], [8, 9, 4]], "facet 0: it is not planar: point 4 lies 1"),
        ([[8, 9, 10], [0, 1, 2, 3]], "facet 0: loop 1 lies outside of its outer loop"),
        ([[8, 9, 10], [12]], "facet 0: point 12 lies outside"),
        ([[8, 9, 10], [11, 12]], "facet 0: edge .11, 12. lies outside"),
        ([[0, 1, 2, 3], [0, 12], [11]], "facet 0: point 11 lies on its edge .0, 12."),
        ([0, 8, 11, 12], "facet 0: its outer loop encloses no area"),
        ([[0, 1, 2, 3], [0, 1, 2, 3]], "facet 0: its loops enclose nothing"),
        ([], "facet 0: its outer loop has 0 points"),
        ([0, 1, 99], "facets refer to point 99"),
    ],
)
def test_what_is_no_planar_polygon_is_named(facet, message):
    with pytest.raises(ValueError, match=message):
        PLC(POINTS, facets=[facet])


def test_two_points_of_a_facet_at_one_place_are_named():
    with pytest.raises(ValueError, match=r"its points . and . are at one place"):
        PLC([*CORNERS, [0, 0, 0]], facets=[[0, 1, 2, 3, 8]])


def test_a_coarse_flatness_accepts_what_is_not_quite_planar():
    points = [*CORNERS[:2], [1, 1, 1e-4], CORNERS[3]]
    with pytest.raises(ValueError, match="not planar"):
        PLC(points, facets=[[0, 1, 2, 3]])
    assert len(PLC(points, facets=[[0, 1, 2, 3]], flatness=1e-3).triangles) == 2


@pytest.mark.parametrize(
    ("given", "error", "message"),
    [
        ({"points": [[0, 0, np.nan]]}, ValueError, "point 0 is .* not finite"),
        ({"points": [[0.0]]}, ValueError, "shape"),
        ({"points": [["a", "b", "c"]]}, TypeError, "real numbers"),
        ({"facets": [["a"]]}, TypeError, r"facets\[0\]"),
        ({"facets": [3]}, TypeError, r"facets\[0\] is no sequence"),
        ({"facet_tags": [1]}, ValueError, "facet_tags must have shape"),
        ({"edges": [[1, 1]]}, ValueError, r"edges\[0\] joins point 1 to itself"),
        ({"edges": [[0, 8]]}, ValueError, "edges refer to point 8"),
        ({"edges": [[0, 1], [1, 0]], "edge_tags": [1, 2]}, ValueError, "with the tags 1 and 2"),
        ({"points_kept": [-1]}, ValueError, "points_kept refer to point -1"),
        ({"names": {(4, 1): "a"}}, ValueError, "dimension 4"),
        ({"names": {(3, 1): "a"}, "regions": [Region((0, 0, 0), 1, name="b")]}, ValueError, "'b'"),
        ({"regions": [Region((0, 0), 1)]}, ValueError, "2 coordinates"),
        ({"regions": [3]}, TypeError, r"regions\[0\]"),
        ({"holes": [[0, 0]]}, ValueError, "holes must have shape"),
    ],
)
def test_what_does_not_fit_is_named(given, error, message):
    with pytest.raises(error, match=message):
        PLC(**{"points": CORNERS, "facets": SIDES, **given})


@pytest.mark.parametrize(
    ("given", "error", "message"),
    [
        ({"seed": (0, np.inf, 0)}, ValueError, "not finite"),
        ({"seed": (0,)}, ValueError, "2 or 3 coordinates"),
        ({"tag": 1.5}, TypeError, "no 32-bit integer"),
        ({"size": 0.0}, ValueError, "size in region 1 is 0.0, not positive"),
        ({"name": 3}, TypeError, "no text"),
    ],
)
def test_regions_are_checked(given, error, message):
    with pytest.raises(error, match=message):
        Region(**{"seed": (0, 0, 0), "tag": 1, **given})


def test_an_outline_in_the_plane_has_segments_and_no_facets():
    plc = PLC([[0, 0], [1, 0], [1, 1]], edges=[[0, 1], [2, 1], [2, 0]], edge_tags=[1, 2, 3])
    assert plc.dim == 2
    assert plc.segments.tolist() == [[0, 1], [0, 2], [1, 2]]
    assert plc.segment_tags.tolist() == [1, 3, 2]
    assert "<svg" in plc._repr_html_()
    with pytest.raises(ValueError, match="facets are given in 3D only"):
        PLC([[0, 0], [1, 0], [1, 1]], facets=[[0, 1, 2]])


def test_a_mesh_gives_its_facets_names_and_a_seed_in_each_region():
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1.0]])
    mesh = Mesh(
        points,
        [[0, 1, 2, 3], [1, 2, 3, 4]],
        cell_tags=[3, 5],
        names={(3, 3): "steel", (3, 5): "air"},
        facets=[[0, 2, 1]],
        facet_tags=[9],
    )
    plc = PLC.from_mesh(mesh)
    assert len(plc.triangles) == mesh.n_facets
    assert sorted(set(plc.facet_tags.tolist())) == [0, 9]
    assert [(r.tag, r.name) for r in plc.regions] == [(3, "steel"), (5, "air")]
    assert plc.regions[0].seed == pytest.approx((0.25, 0.25, 0.25))


def test_surfaces_of_other_packages_are_taken():
    points, triangles = grid(3, bend=0.5)
    pyvista = pytest.importorskip("pyvista")
    meshio = pytest.importorskip("meshio")

    class Surface:
        vertices, faces = points, triangles

    expected = PLC.from_surface(points, triangles)
    faces = np.c_[np.full(len(triangles), 3), triangles].ravel()
    given = [
        Surface(),
        pyvista.PolyData(points, faces),
        meshio.Mesh(points, [("triangle", triangles)]),
        expected,
    ]
    for surface in given:
        plc = as_plc(surface)
        assert np.array_equal(plc.triangles, expected.triangles)
        assert np.array_equal(plc.points, expected.points)
    with pytest.raises(TypeError, match="geometry must be"):
        as_plc(3)
