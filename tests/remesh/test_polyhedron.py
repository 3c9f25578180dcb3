"""With shape="polyhedron" the given facets are the domain, to round-off."""

import math

import numpy as np
import pytest
from meshes import annulus, cube
from scipy.spatial import ConvexHull
from surface.smooth_shapes import ball

from anistar import AdaptOptions, RemeshOptions, remesh, validate
from anistar.meshes.mesh import Mesh
from anistar.meshes.topology import cell_volumes, facet_measures

POLYHEDRON = RemeshOptions(shape="polyhedron")


def uniform(mesh, h):
    return np.broadcast_to(np.eye(mesh.dim) / h**2, (mesh.n_points, mesh.dim, mesh.dim)).copy()


def measures(mesh):
    """Volume, area, and the area of every tag."""
    areas = facet_measures(mesh.points, mesh.facets)
    tags = [areas[mesh.facet_tags == tag].sum() for tag in np.unique(mesh.facet_tags)]
    return [cell_volumes(mesh.points, mesh.cells).sum(), areas.sum(), *tags]


def hull(n, seed):
    """The hull of random points on a sphere, cut into cells from its middle."""
    x = np.random.default_rng(seed).normal(size=(n, 3))
    x /= np.linalg.norm(x, axis=1)[:, None]
    cells = np.insert(ConvexHull(x).simplices, 0, n, axis=1)
    points = np.concatenate([x, x.mean(axis=0, keepdims=True)])
    legs = points[cells[:, 1:]] - points[cells[:, :1]]
    cells = np.where((np.linalg.det(legs) < 0)[:, None], cells[:, [0, 1, 3, 2]], cells)
    return Mesh(points=points, cells=cells)


def l_body():
    """Three quarters of a cube, turned so that no plane is along an axis, one tag."""
    base = cube(4)
    middle = base.points[base.cells].mean(axis=1)
    cells = base.cells[~((middle[:, 0] > 0.5) & (middle[:, 1] > 0.5))]
    used, cells = np.unique(cells, return_inverse=True)
    c, s = math.cos(0.7), math.sin(0.7)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ [[1, 0, 0], [0, c, -s], [0, s, c]]
    return Mesh(points=base.points[used] @ turn.T, cells=cells.reshape(-1, 4))


BODIES = {"hull": hull(100, 1), "sphere": ball(2), "l": l_body(), "ring": annulus(2)}


@pytest.mark.parametrize("name", BODIES)
def test_volume_and_area_stay_to_round_off_over_passes(name):
    geometry = mesh = BODIES[name]
    for h in (0.35, 0.2, 0.5):
        mesh = remesh(mesh, uniform(mesh, h), POLYHEDRON, geometry=geometry).mesh
        assert validate(mesh) == []
        np.testing.assert_allclose(measures(mesh), measures(geometry), rtol=1e-12)


def test_what_is_read_as_smooth_grows_where_the_polyhedron_does_not():
    mesh = hull(100, 1)
    smooth = remesh(mesh, uniform(mesh, 0.2), RemeshOptions(ridge_angle=90)).mesh
    assert measures(smooth)[0] > 1.03 * measures(mesh)[0]


def test_coplanar_facets_are_one_face_that_is_coarsened():
    mesh = l_body()
    done = remesh(mesh, uniform(mesh, 1.0), POLYHEDRON).mesh
    # the twelve corners of the L, and a point or two that keep the least quality
    assert done.n_points <= 14 < mesh.n_points


def test_a_polygon_keeps_its_corners_and_loses_the_points_between():
    angle = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    ring = np.stack([ring, (ring + np.roll(ring, -1, axis=0)) / 2], 1).reshape(-1, 2)
    here = np.arange(96)
    cells = np.stack([np.full(96, 96), here, (here + 1) % 96], 1)
    mesh = Mesh(points=np.concatenate([ring, [[0, 0]]]), cells=cells)
    done = remesh(mesh, uniform(mesh, 5.0), POLYHEDRON).mesh
    assert validate(done) == []
    assert measures(done) == pytest.approx(measures(mesh), rel=1e-14)
    on_boundary = {tuple(x) for x in done.points[np.unique(done.facets)]}
    assert on_boundary == {tuple(x) for x in ring[::2]}


def test_frozen_facets_stay_beside_a_polyhedron():
    mesh = ball(2)
    upper = mesh.points[mesh.facets].mean(axis=1)[:, 2] > 0
    tagged = Mesh(**{**mesh.arrays(), "facet_tags": np.where(upper, 1, 2)})
    options = RemeshOptions(shape="polyhedron", frozen_tags=[1])
    done = remesh(tagged, uniform(tagged, 0.3), options).mesh
    assert validate(done) == []
    np.testing.assert_allclose(measures(done), measures(tagged), rtol=1e-13)
    before, after = (
        {frozenset(map(tuple, x)) for x in m.points[m.facets[m.facet_tags == 1]]}
        for m in (tagged, done)
    )
    assert after == before


def test_a_projection_contradicts_a_polyhedron():
    with pytest.raises(ValueError, match="project moves points off the facets"):
        remesh(ball(2), uniform(ball(2), 0.5), POLYHEDRON, project=lambda points, tag: points)


def test_the_shape_is_checked_and_read_from_a_dict():
    with pytest.raises(ValueError, match='"smooth", "polyhedron", "faceted", got \'round\''):
        RemeshOptions(shape="round")
    options = AdaptOptions.from_dict({"shape": "polyhedron", "target_complexity": 10})
    assert options.remesh.shape == "polyhedron"


FACETED = RemeshOptions(shape="faceted")


def of_floats(mesh):
    """A turned mesh in single precision, its sides tagged: they are planes to 1e-7 only."""
    c, s = math.cos(0.7), math.sin(0.7)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ [[1, 0, 0], [0, c, -s], [0, s, c]]
    middle = mesh.points[mesh.facets].mean(axis=1)
    side = 2 * np.abs(middle - 0.5).argmax(axis=1)
    side += middle[np.arange(len(middle)), side // 2] > 0.5
    points = (mesh.points @ turn.T).astype(np.float32)
    return Mesh(points=points, cells=mesh.cells, facets=mesh.facets, facet_tags=side + 1)


def test_facets_of_floats_are_planes_when_faceted_and_nets_of_ridges_when_not():
    mesh = of_floats(cube(4))
    faceted, exact = (
        remesh(mesh, uniform(mesh, 0.3), options) for options in (FACETED, POLYHEDRON)
    )
    assert validate(faceted.mesh) == []
    assert faceted.report.counts["curved"] == 0
    assert len(faceted.mesh.corners) <= 8
    assert faceted.mesh.n_points < exact.mesh.n_points
    assert faceted.report.statistics["edge_unit"] > exact.report.statistics["edge_unit"]
    np.testing.assert_allclose(measures(faceted.mesh), measures(mesh), rtol=3e-7)


def test_faceted_is_a_polyhedron_where_the_plane_is_concerned():
    geometry = annulus(2)
    new = remesh(geometry, uniform(geometry, 0.3), FACETED).mesh
    assert validate(new) == []
    np.testing.assert_allclose(measures(new), measures(geometry), rtol=1e-12)
