"""How near the result is to a mesh of unit equilateral triangles in the metric."""

import numpy as np
import pytest
from meshes import rectangle_with_jitter, square
from shapes import arc_metric, linear_metric, rotating_metric, uniform

from anistar.judging.quality import quality
from anistar.meshes.mesh import Mesh
from anistar.meshes.topology import cell_volumes
from anistar.meshes.validation import validate
from anistar.remeshing.remesh import remesh


def angles_of(mesh):
    """The (m, 3) angles of the cells, in degrees."""
    corners = mesh.points[mesh.cells]
    u, v = np.roll(corners, -1, axis=1) - corners, np.roll(corners, -2, axis=1) - corners
    cosine = (u * v).sum(axis=2) / np.linalg.norm(u, axis=2) / np.linalg.norm(v, axis=2)
    return np.degrees(np.arccos(cosine))


@pytest.mark.parametrize("h", [0.1, 0.05, 0.03])
def test_the_identity_on_the_unit_square_gives_nearly_equilateral_triangles(h):
    mesh = square(8)
    done = remesh(mesh, uniform(mesh, h))
    assert validate(done.mesh, mesh) == []
    angles = angles_of(done.mesh)
    assert np.abs(angles - 60).mean() < 8
    assert angles.min() > 34
    assert angles.max() < 105
    inner = np.setdiff1d(np.arange(done.mesh.n_points), done.mesh.facets)
    degree = np.bincount(done.mesh.cells.ravel())[inner]
    assert (degree == 6).mean() > 0.55
    assert set(degree.tolist()) <= {4, 5, 6, 7, 8}
    assert np.median(cell_volumes(done.mesh.points, done.mesh.cells)) == pytest.approx(
        np.sqrt(3) / 4 * h**2, rel=0.1
    )


@pytest.mark.parametrize(
    ("make", "unit", "longest", "worst"),
    [
        (arc_metric, 0.995, 1.5, 0.6),
        (linear_metric, 0.995, 1.5, 0.6),
        (rotating_metric, 0.995, 1.5, 0.5),
    ],
)
def test_edges_are_unit_and_cells_well_shaped_in_the_metric(make, unit, longest, worst):
    mesh = square(60)
    done = remesh(mesh, make(mesh, 2000))
    assert validate(done.mesh, mesh) == []
    figures = done.report.statistics
    assert figures["edge_unit"] > unit
    assert figures["edge_max"] < longest
    assert figures["q_min"] > worst
    assert figures["q_mean"] > 0.94
    assert figures["edge_mean"] == pytest.approx(1, abs=0.03)


def test_the_report_has_the_figures_that_quality_computes():
    mesh = square(40)  # of a metric whose density varies: Q takes the densest corner
    done = remesh(mesh, arc_metric(mesh, 800))
    assert validate(done.mesh, mesh) == []
    figures, expected = done.report.statistics, quality(done.mesh, done.metric)
    assert figures["edge_unit"] == pytest.approx(expected.unit_edges, rel=1e-12)
    assert figures["edge_min"] == pytest.approx(expected.shortest_edge, rel=1e-8)
    assert figures["edge_mean"] == pytest.approx(expected.mean_edge, rel=1e-8)
    assert figures["edge_max"] == pytest.approx(expected.longest_edge, rel=1e-8)
    assert figures["q_min"] == pytest.approx(expected.worst_quality, rel=1e-12)
    assert figures["q_mean"] == pytest.approx(expected.mean_quality, rel=1e-12)
    assert sum(figures["edge_histogram"]) == expected.edges
    assert sum(figures["q_histogram"]) == done.report.n_cells


def test_cells_a_million_times_longer_than_wide_are_as_good_as_equilateral_ones():
    # An affine map carries metric and mesh along; nothing but round-off may tell them apart.
    mesh = rectangle_with_jitter(8)
    flat = Mesh(points=mesh.points * [1.0, 1e-6], cells=mesh.cells)
    M = uniform(mesh, 0.05)
    plain = remesh(mesh, M)
    done = remesh(flat, M / np.outer([1.0, 1e-6], [1.0, 1e-6]))
    assert validate(done.mesh, flat) == []
    assert done.report.n_points == pytest.approx(plain.report.n_points, rel=0.02)
    assert done.report.statistics["edge_unit"] > 0.99
    assert done.report.statistics["q_min"] > 0.7
