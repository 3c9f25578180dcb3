"""From any start the remesher comes to the same kind of mesh, and stays there."""

import json

import numpy as np
import pytest
from meshes import cube
from remesh3d.domains import changed, jittered_cube, layer, turning, uniform
from scipy.spatial import Delaunay

from anistar import Mesh, RemeshOptions, remesh, validate
from anistar.judging.quality import mean_ratios
from anistar.remeshing.report.bad_cells import worst_cells

OPTIONS = RemeshOptions(agreement=False)


def steep(mesh):
    """A layer about one edge thick, which a coarse mesh does not see."""
    return layer(mesh, h=0.3, thin=0.03)


def bent(mesh):
    """Stretched along a direction that turns with x, at moderate cost."""
    return turning(mesh, h=0.3, ratio=5.0)


def flat_cells(mesh):
    """Thin along x everywhere: what neither of the metrics below asks for."""
    return uniform(mesh, 0.4) + np.diag([1 / 0.05**2 - 1 / 0.4**2, 0, 0])


def adapted(mesh, metric, passes, reference=None):
    reference = mesh if reference is None else reference
    for _ in range(passes):
        done = remesh(mesh, metric(mesh), OPTIONS, geometry=reference)
        assert validate(done.mesh, reference=reference) == []
        assert len(np.unique(done.mesh.cells)) == done.mesh.n_points
        mesh = done.mesh
    return done


def flattened_cube(n=4, by=1e-4):
    """The cube with inner points brought onto a facet opposite, one at a time: slivers."""
    mesh = cube(n)
    points = mesh.points.copy()
    is_inner = np.all((points > 0) & (points < 1), axis=1)
    taken = np.zeros(len(points), dtype=bool)
    for cell in mesh.cells:
        if taken[cell].any() or not is_inner[cell[0]]:
            continue
        centre = points[cell[1:]].mean(axis=0)
        trial = points.copy()
        trial[cell[0]] = centre + by * (points[cell[0]] - centre)
        try:
            changed(mesh, points=trial)
        except ValueError:
            continue
        points = trial
        taken[cell] = True
    return changed(mesh, points=points)


def of_another_mesher(n=4, seed=0):
    """The Delaunay tetrahedra that qhull makes of scattered points of the cube."""
    base = cube(n)
    points = base.points.copy()
    is_free = (points > 0) & (points < 1)
    points += is_free * np.random.default_rng(seed).uniform(-0.3 / n, 0.3 / n, points.shape)
    cells = Delaunay(points).simplices
    volumes = np.linalg.det(points[cells[:, 1:]] - points[cells[:, :1]])
    cells = np.where((volumes < 0)[:, None], cells[:, [0, 1, 3, 2]], cells)
    bare = Mesh(points=points, cells=cells[abs(volumes) > 1e-13])  # none flat in a face
    on = points[bare.facets]
    sides = [(on[:, :, k] == value).all(axis=1) for k in range(3) for value in (0.0, 1.0)]
    return changed(bare, facet_tags=1 + np.argmax(sides, axis=0), names=base.names)


STARTS = {
    "coarse": lambda: cube(2),
    "fine": lambda: cube(8),
    "jittered": jittered_cube,
    "slivers": flattened_cube,
    "another mesher": of_another_mesher,
    "another metric": lambda: adapted(cube(4), flat_cells, 2).mesh,
}


@pytest.mark.parametrize("metric", [steep, bent], ids=["layer", "turning"])
def test_every_start_leads_to_the_same_kind_of_mesh(metric):
    counts = []
    for start in STARTS.values():
        done = adapted(start(), metric, 3, reference=cube(4))
        statistics = done.report.statistics
        assert statistics["q_min"] > 0.2
        assert statistics["edge_unit"] > 0.88
        assert done.report.n_bad_cells == 0
        counts.append(done.report.n_points)
    assert max(counts) < 1.12 * min(counts)


def test_slivers_are_repaired():
    start = flattened_cube()
    M = uniform(start, 0.25)
    assert mean_ratios(start, M).min() < 0.01
    done = remesh(start, M, OPTIONS)
    assert validate(done.mesh, reference=start) == []
    assert done.report.statistics["q_min"] > 0.3


def test_ten_passes_do_not_drift():
    first = adapted(cube(4), bent, 3)
    last = adapted(first.mesh, bent, 7, reference=cube(4))
    assert last.report.n_points == pytest.approx(first.report.n_points, rel=0.06)
    for key in ("q_mean", "edge_unit"):
        assert last.report.statistics[key] > first.report.statistics[key] - 0.02
    assert last.report.statistics["q_min"] > 0.3


def test_a_metric_stretched_1e5_times_along_no_axis_is_met():
    Q, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    Q = Q * np.linalg.det(Q)
    base = cube(3)
    stretch = np.diag([1.0, 1.0, 1e-4])
    start = changed(base, points=base.points @ stretch @ Q.T)
    M = Q @ np.diag([1.0, 1.0, 1e8]) @ Q.T / 0.2**2
    done = remesh(start, np.broadcast_to((M + M.T) / 2, (start.n_points, 3, 3)).copy(), OPTIONS)
    assert validate(done.mesh, reference=start) == []
    assert done.report.statistics["q_min"] > 0.4
    assert done.report.statistics["edge_unit"] > 0.9


def test_cells_left_bad_are_named():
    base = cube(2)
    plate = changed(base, points=base.points * [1.0, 1.0, 1e-6])
    done = remesh(plate, uniform(plate, 0.4), OPTIONS)
    report = done.report
    count, _ = worst_cells(done.mesh, done.metric)
    assert report.n_bad_cells == count > 0
    worst = report.bad_cells[0]
    assert worst.quality == pytest.approx(report.statistics["q_min"])
    assert np.all((np.array(worst.place) > 0) & (np.array(worst.place) < [1, 1, 1e-6]))
    written = json.loads(json.dumps(report.as_dict()))
    assert written["bad_cells"][0]["cell"] == worst.cell
    assert len(report.bad_cells) == min(count, 10)


def test_a_good_mesh_names_nothing():
    report = remesh(cube(2), uniform(cube(2), 0.5), OPTIONS).report
    assert (report.n_bad_cells, report.bad_cells) == (0, ())
