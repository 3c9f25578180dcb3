import numpy as np
import pytest
from meshes import cube, rectangle_with_jitter, square

from anistar.judging.quality import mean_ratios, metric_lengths, quality
from anistar.meshes.mesh import Mesh


def equilateral():
    return Mesh(points=[[0, 0], [1, 0], [0.5, np.sqrt(3) / 2]], cells=[[0, 1, 2]])


def constant(mesh, M):
    return np.tile(M, (mesh.n_points, 1, 1))


def test_the_equilateral_triangle_is_perfect():
    mesh = equilateral()
    assert quality(mesh).unit_edges is None
    figures = quality(mesh, np.tile(np.eye(2), (mesh.n_points, 1, 1)))
    assert figures.worst_quality == pytest.approx(1.0)
    assert figures.unit_edges == 1.0
    assert figures.longest_edge == pytest.approx(1.0)


def test_the_regular_tetrahedron_is_perfect():
    corners = [[1, 1, 1], [-1, 1, -1], [1, -1, -1], [-1, -1, 1]]
    mesh = Mesh(points=np.array(corners) / np.sqrt(8), cells=[[0, 1, 2, 3]])
    assert quality(mesh).worst_quality == pytest.approx(1.0)
    assert quality(mesh).mean_edge == pytest.approx(1.0)


def test_stretching_mesh_and_metric_together_changes_nothing():
    mesh, stretch = rectangle_with_jitter(4), np.array([[3.0, 1.0], [0.0, 0.1]])
    moved = Mesh(points=mesh.points @ stretch.T, cells=mesh.cells)
    inverse = np.linalg.inv(stretch)
    before = quality(mesh, constant(mesh, 25 * np.eye(2))).as_dict()
    after = quality(moved, constant(moved, 25 * inverse.T @ inverse)).as_dict()
    assert after == pytest.approx(before)


def test_the_length_in_a_varying_metric_is_the_logarithmic_mean_of_the_ends():
    mesh = equilateral()
    M = np.array([np.eye(2), 16 * np.eye(2), np.eye(2)])
    lengths = metric_lengths(mesh, M, np.array([[0, 1], [0, 2]], np.int32))
    assert lengths == pytest.approx([3 / np.log(4), 1.0])


def test_the_length_has_no_jump_where_the_ends_nearly_agree():
    mesh, edge = equilateral(), np.array([[0, 1]], np.int32)
    near, nearer = (
        metric_lengths(mesh, np.array([np.eye(2), (1 + e) ** 2 * np.eye(2), np.eye(2)]), edge)[0]
        for e in (2.1e-6, 1.9e-6)
    )
    assert near - nearer == pytest.approx(1e-7, rel=1e-2)


def test_quality_is_that_of_the_corner_with_the_densest_metric():
    mesh = equilateral()
    M = np.array([np.eye(2), np.diag([400.0, 1.0]), np.eye(2)])
    alone = constant(mesh, np.diag([400.0, 1.0]))
    assert mean_ratios(mesh, M) == pytest.approx(mean_ratios(mesh, alone))


@pytest.mark.parametrize("mesh", [square(3), cube(2)], ids=["square", "cube"])
def test_scaling_the_metric_scales_lengths_and_leaves_quality(mesh):
    one, four = (quality(mesh, constant(mesh, s * np.eye(mesh.dim))) for s in (1.0, 16.0))
    assert four.longest_edge == pytest.approx(4 * one.longest_edge)
    assert four.worst_quality == pytest.approx(one.worst_quality)
    assert four.edges == one.edges


@pytest.mark.parametrize("seed", range(4))
def test_a_tetrahedron_that_fits_a_nearly_singular_metric_is_perfect(seed):
    # the determinant that the entries give is round-off there, of either sign
    corners = np.array([[1, 1, 1], [-1, 1, -1], [1, -1, -1], [-1, -1, 1]]) / np.sqrt(8)
    turn = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    sizes = np.array([1.0, 1e6, 1e6])
    mesh = Mesh(points=corners * sizes @ turn.T, cells=[[0, 1, 2, 3]])
    M = constant(mesh, turn / sizes**2 @ turn.T)
    assert mean_ratios(mesh, 0.5 * (M + M.transpose(0, 2, 1))) == pytest.approx(1.0, abs=0.02)
