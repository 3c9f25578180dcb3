"""Cases that once gave a wrong mesh, each with what was wrong."""

import numpy as np
import pytest
from meshes import grid, square, two_region_cube, two_regions

import anistar
from anistar.meshes.mesh import Mesh
from anistar.meshes.topology import cell_volumes, measure_by_tag
from anistar.remeshing.remesh import RemeshOptions


def sizes(mesh, h):
    return np.broadcast_to(np.eye(2) / h**2, (mesh.n_points, 2, 2)).copy()


def mapped(to_plane, nu, nv, *, closed=False, cell_tags=None):
    """A grid of (u, v) in the unit square, mapped to the plane; closed joins u = 0 and u = 1."""
    points, cells = grid(nu, nv)
    plane = np.stack(to_plane(points[:, 0], points[:, 1]), axis=1)
    if closed:
        row = np.arange(len(points))
        cells = np.where(row % (nu + 1) == nu, row - nu, row)[cells]
        keep = row % (nu + 1) != nu
        plane, cells = plane[keep], (np.cumsum(keep) - 1)[cells]
    a, b, c = (plane[cells[:, i]] for i in range(3))
    clockwise = (b - a)[:, 0] * (c - a)[:, 1] < (b - a)[:, 1] * (c - a)[:, 0]
    cells = np.where(clockwise[:, None], cells[:, [0, 2, 1]], cells)
    return Mesh(points=plane, cells=cells, cell_tags=cell_tags)


def spiral(gap, n=40):
    """A band of two turns; `gap` parts the turns."""

    def to_plane(u, v):
        radius, angle = 1 + 2 * u + v * (1 - gap), 4 * np.pi * u
        return radius * np.cos(angle), radius * np.sin(angle)

    return mapped(to_plane, n, 2)


@pytest.mark.parametrize("h", [0.8, 2.0, 5.0])
@pytest.mark.parametrize("gap", [0.2, 0.05, 0.005])
def test_boundary_edges_across_a_thin_gap_never_run_into_one_another(gap, h):
    # collapses, slides and splits looked at their own cells only, all of which stayed positive
    mesh = spiral(gap)
    done = anistar.remesh(mesh, sizes(mesh, h), RemeshOptions(hausdorff_number=0.3))
    assert anistar.validate(done.mesh) == []


@pytest.mark.parametrize("gap", [0.1, 0.01, 0.001])
def test_a_ring_never_takes_in_a_disc_inside_it(gap):
    # no edge of the ring need cross the disc's when a collapse fills the hole around it
    def disc(u, v):
        radius = 1e-2 + (1 - gap) * v
        return radius * np.cos(2 * np.pi * u), radius * np.sin(2 * np.pi * u)

    def ring(u, v):
        return (1.02 + v) * np.cos(2 * np.pi * u), (1.02 + v) * np.sin(2 * np.pi * u)

    inner, outer = (mapped(shape, 24, 2, closed=True) for shape in (disc, ring))
    mesh = Mesh(
        points=np.concatenate([inner.points, outer.points]),
        cells=np.concatenate([inner.cells, outer.cells + inner.n_points]),
        cell_tags=np.repeat([1, 2], [inner.n_cells, outer.n_cells]),
    )
    for h in (0.2, 1.0, 4.0):
        done = anistar.remesh(mesh, sizes(mesh, h), RemeshOptions(hausdorff_number=0.3))
        assert anistar.validate(done.mesh) == []
        assert set(done.mesh.cell_tags.tolist()) == {1, 2}


def wavy_interface(n=16, height=0.02):
    """The unit square in two regions with an interface y = 1/2 + waves."""

    def to_plane(u, v):
        return u, v + height * np.sin(6 * np.pi * u) * np.sin(np.pi * v)

    points, cells = grid(n, 8)
    middle = points[cells].mean(axis=1)
    return mapped(to_plane, n, 8, cell_tags=np.where(middle[:, 1] < 0.5, 1, 2))


@pytest.mark.parametrize("seed", [1, 4, 8])
def test_a_curve_that_comes_to_run_along_an_edge_stays_a_curve(seed):
    # a collapse made the merged curve edge one of the cavity's own edges, without its constraint
    mesh = wavy_interface()
    h = 10 ** np.random.default_rng(seed).uniform(-2, 0.5, (mesh.n_points, 2))
    M = np.einsum("ki,ij->kij", 1 / h**2, np.eye(2))
    done = anistar.remesh(mesh, M, RemeshOptions(hausdorff_number=0.3))
    assert anistar.validate(done.mesh) == []


@pytest.mark.parametrize("depth", [0.002, 0.01, 0.03])
def test_a_corner_near_a_coarse_curve_stays_inside(depth):
    # a chord cut it off, and it was dropped without a word
    def to_plane(u, v):
        radius = 1 - v * (1 - 1e-2)
        return radius * np.cos(2 * np.pi * u), radius * np.sin(2 * np.pi * u)

    base = mapped(to_plane, 64, 2, closed=True)
    angle = 2 * np.pi * (0.5 + np.arange(64)) / 64
    near = (1 - depth) * np.cos(np.pi / 64) * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points, cells = base.points.copy(), base.cells
    rim = np.flatnonzero(np.isclose(np.linalg.norm(points, axis=1), 1))
    new = []
    for cell in cells.tolist():
        if sum(v in rim for v in cell) == 2:  # put a point just inside its rim edge
            middle = points[[v for v in cell if v in rim]].mean(axis=0)
            k = len(points)
            at = near[np.argmin(np.linalg.norm(near - middle, axis=1))]
            points = np.concatenate([points, [at]])
            new += [[*(cell[:i]), k, *cell[i + 1 :]] for i in range(3)]
        else:
            new.append(cell)
    corners = np.arange(base.n_points, len(points), 7)
    mesh = Mesh(points=points, cells=new, corners=corners)
    done = anistar.remesh(mesh, sizes(mesh, 1.5), RemeshOptions(hausdorff_number=0.3))
    assert anistar.validate(done.mesh) == []
    assert len(done.mesh.corners) == len(corners)
    np.testing.assert_array_equal(
        np.unique(done.mesh.points[done.mesh.corners], axis=0), np.unique(points[corners], axis=0)
    )


@pytest.mark.parametrize("shift", [0.0, 137.3])
def test_no_cell_is_flat_beside_long_frozen_edges(shift):
    # cells were positive exactly, and of zero volume to validate
    angle = 0.7
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    base = square(2)
    mesh = Mesh(**{**base.arrays(), "points": base.points @ turn.T + shift})
    M = turn @ np.diag([20.0**2, 500.0**2]) @ turn.T
    options = RemeshOptions(frozen_tags=[1, 2, 3, 4])
    done = anistar.remesh(mesh, np.broadcast_to(M, (mesh.n_points, 2, 2)).copy(), options)
    assert anistar.validate(done.mesh, mesh) == []


def test_a_cut_beside_a_point_of_the_geometry_leaves_no_edge_without_length():
    # cut at .99999999999999978, a curve that retreated to the point at 1 "crossed" itself
    mesh = spiral(0.05)
    M = np.broadcast_to(np.diag([1 / 0.5**2, 1 / 2.0**2]), (mesh.n_points, 2, 2)).copy()
    done = anistar.remesh(mesh, M, RemeshOptions(hausdorff_number=0.3))
    assert anistar.validate(done.mesh) == []


def test_the_inside_is_refined_beside_frozen_edges():
    # the disc over a frozen edge was left empty
    mesh = square(1)
    done = anistar.remesh(mesh, sizes(mesh, 0.05), RemeshOptions(frozen_tags=[1, 2, 3, 4]))
    assert anistar.validate(done.mesh, mesh) == []
    assert done.mesh.n_facets == 4
    assert done.mesh.n_points > 350


def test_a_projection_never_makes_a_thin_ring_cross_itself():
    # chords that had retreated to the polyline were still projected, and crossed again
    thickness, n = 0.005347, 8
    radii = {1: 1 - thickness, 2: 1.0}

    def to_plane(u, v):
        radius = 1 - thickness + thickness * v
        return radius * np.cos(2 * np.pi * u), radius * np.sin(2 * np.pi * u)

    def project(points, tag):
        return radii[tag] * points / np.linalg.norm(points, axis=1)[:, None]

    base = mapped(to_plane, n, 2, closed=True)
    outer = np.linalg.norm(base.points[base.facets], axis=2).mean(axis=1) > 1 - thickness / 2
    mesh = Mesh(**{**base.arrays(), "facet_tags": np.where(outer, 2, 1)})
    h = 10 ** np.random.default_rng(2).uniform(-2, 0, mesh.n_points)
    options = RemeshOptions(ridge_angle=80.0, max_vertices=2000)
    done = anistar.remesh(mesh, np.eye(2) / h[:, None, None] ** 2, options, project=project)
    assert anistar.validate(done.mesh) == []


def test_a_mesh_is_never_refused_as_its_own_geometry():
    # a curve bulges from a coarse polygon by more than a tenth of the extent of the mesh
    points = [[0.0, -1.5], [1.1, -0.078], [1.0, 0.0], [-1.0, 0.0], [-1.1, -0.078]]
    mesh = Mesh(points=points, cells=[[0, 1, 2], [0, 2, 3], [0, 3, 4]])
    done = anistar.remesh(mesh, sizes(mesh, 0.1))
    assert anistar.validate(done.mesh) == []


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("tag", [-(2**31), -2, -1, 0])
def test_any_tag_is_a_region(dim, tag):
    # -1 was the core's mark for what lies outside
    given = (two_regions if dim == 2 else two_region_cube)()
    tags = np.where(given.cell_tags == given.cell_tags[0], tag, 7).astype(np.int32)
    mesh = Mesh(**{**given.arrays(), "cell_tags": tags, "names": {}})
    new = anistar.remesh(mesh, np.tile(np.eye(dim) / 0.2**2, (mesh.n_points, 1, 1))).mesh
    assert anistar.validate(new, mesh) == []
    before, after = (
        measure_by_tag(cell_volumes(m.points, m.cells), m.cell_tags) for m in (mesh, new)
    )
    assert after == pytest.approx(before)
