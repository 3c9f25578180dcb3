"""The walk that proves a star at once gives the answers of the walk of every cell on its own."""

import cases
import numpy as np
import pytest
import tetrahedra
from meshes import cube, square
from scipy.spatial import Delaunay

from anistar import _core_for_tests
from anistar.judging.certificate import certify
from anistar.judging.metric_mesh import MetricMesh
from anistar.meshes.mesh import Mesh
from anistar.meshes.validation import validate

RENEWED = {2: _core_for_tests.renewed_bits2, 3: _core_for_tests.renewed_bits3}


def cell_by_cell(mesh, metric):
    """(m, d + 1): the exact walk of the definition, for every cell and each of its vertices."""
    core = MetricMesh.of(mesh, metric).core()
    return np.array(
        [
            [core.violator(cell=c, metric=metric[v]) < 0 for v in cell]
            for c, cell in enumerate(mesh.cells)
        ]
    )


def assert_agrees(mesh, metric):
    """Compare all answers; returns how many of them are yes."""
    found = certify(mesh, metric).delaunay
    assert np.array_equal(found, cell_by_cell(mesh, metric))
    return found.mean()


def lattice(rng, n, spread):
    """A cube of n^3 cubes and a metric at every vertex, `spread` from one of small integers."""
    base = cube(n)
    points = np.rint(base.points * n)
    M = np.diag(rng.integers(1, 4, 3).astype(float))
    noise = rng.normal(size=(len(points), 3, 3)) * spread
    metric = M + noise @ noise.transpose(0, 2, 1)
    faces = np.unique(np.sort(base.cells[:, tetrahedra.FACES].reshape(-1, 3), axis=1), axis=0)
    slits = faces[rng.uniform(size=len(faces)) < 0.05]
    return Mesh(points=points, cells=base.cells, facets=slits), metric


@pytest.mark.parametrize("spread", [0, 0.3, 1])
def test_on_lattices_with_slits_all_answers_are_those_of_single_walks(spread):
    rng = np.random.default_rng(1)
    passing = [assert_agrees(*lattice(rng, 3, spread)) for _ in range(2)]
    assert all(part > 0 for part in passing)
    assert spread == 0 or min(passing) < 1


@pytest.mark.parametrize("kind", ["smooth", "hopeless"])
def test_among_random_points_all_answers_are_those_of_single_walks(kind):
    rng = np.random.default_rng(7)
    points = np.concatenate(
        [tetrahedra.CORNERS, rng.dirichlet(np.ones(4), 120) @ tetrahedra.CORNERS]
    )
    cells = tetrahedra.oriented(points, Delaunay(points).simplices)
    metric = tetrahedra.random_metric(rng, points, kind)
    assert 0 < assert_agrees(Mesh(points=points, cells=cells), metric) < 1


@pytest.mark.parametrize("exponent", [-9, 0, 9])
@pytest.mark.parametrize("shift", [0, 1e6])
def test_lattices_that_were_moved_and_scaled_have_the_answers_of_single_walks(exponent, shift):
    rng = np.random.default_rng(2)
    mesh, metric = lattice(rng, 2, 0.2)
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    axes *= np.sign(np.linalg.det(axes))
    points = mesh.points @ axes.T * 10.0**exponent + shift * 10.0**exponent
    turned = axes @ metric @ axes.T * 100.0**-exponent
    moved = Mesh(points=points, cells=mesh.cells, facets=mesh.facets)
    assert_agrees(moved, 0.5 * (turned + turned.transpose(0, 2, 1)))


@pytest.mark.parametrize("thinness", [1e-3, 1e-6, 1e-9])
def test_needles_have_the_answers_of_single_walks(thinness):
    rng = np.random.default_rng(3)
    passing = []
    for seed in range(12):
        base, _ = tetrahedra.walled_case(seed)
        mesh = Mesh(points=base.points * [1, thinness, 1], cells=base.cells, facets=base.facets)
        if validate(mesh) != []:
            continue
        sizes = np.array([1, max(thinness, 1e-6), 1])
        noise = rng.normal(size=(mesh.n_points, 3, 3)) * 0.3
        metric = (np.eye(3) + noise @ noise.transpose(0, 2, 1)) / np.outer(sizes, sizes)
        passing.append(assert_agrees(mesh, metric))
    assert len(passing) > 6
    assert 0 < np.mean(passing) < 1


def two_tetrahedra(shared):
    """A tetrahedron and its image at the vertex, or edge, that they share."""
    a = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
    if shared == "vertex":
        points, cells = np.concatenate([a, -a[1:]]), [[0, 1, 2, 3], [0, 4, 6, 5]]
    else:
        points = np.concatenate([a, [[0, -1, 0], [0, 0, -1]]])
        cells = [[0, 1, 2, 3], [0, 1, 4, 5]]
    return Mesh(points=points, cells=np.array(cells, dtype=np.int32))


@pytest.mark.parametrize("shared", ["vertex", "edge"])
def test_bodies_that_touch_do_not_see_each_other(shared):
    mesh = two_tetrahedra(shared)
    assert validate(mesh) == []
    metric = tetrahedra.random_metric(np.random.default_rng(4), mesh.points, "hopeless")
    assert certify(mesh, metric).is_certified
    assert_agrees(mesh, metric)


def test_a_hub_of_very_many_cells_is_decided_as_any_other():
    n = 1500
    angle = 2 * np.pi * np.arange(n) / n
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    ring *= np.random.default_rng(5).uniform(1, 1 + 2e-5, n)[:, None]
    points = np.concatenate([[[0, 0]], ring])
    k = np.arange(n)
    cells = np.stack([0 * k, 1 + k, 1 + (k + 1) % n], axis=1).astype(np.int32)
    mesh = Mesh(points=points, cells=cells)
    metric = np.tile(np.eye(2), (n + 1, 1, 1))
    found = certify(mesh, metric).delaunay
    assert 0 < found.mean() < 1
    some = np.random.default_rng(6).choice(n, 50)
    core = MetricMesh.of(mesh, metric).core()
    expected = [core.violator(cell=int(c), metric=metric[0]) < 0 for c in some]
    assert np.array_equal(found[some, 0], expected)


@pytest.mark.parametrize("seed", range(3))
def test_threads_give_the_same_answers(seed):
    mesh, metric = lattice(np.random.default_rng(seed), 6, 0.5)
    one, two = (certify(mesh, metric, threads=n).delaunay for n in (1, 2))
    assert np.array_equal(one, two)
    assert 0 < one.mean() < 1


def bits_of(mesh, metric):
    n = mesh.cells.shape[1]
    return certify(mesh, metric).delaunay @ (1 << np.arange(n)).astype(np.uint8)


def in_place(cells, new):
    """The new cells with those that stay where they were, and the others in the gaps first."""
    there = {tuple(cell): c for c, cell in enumerate(cells.tolist())}
    out = np.full((len(new), cells.shape[1]), -1, dtype=np.int32)
    others = []
    for cell in new.tolist():
        if tuple(cell) in there:
            out[there[tuple(cell)]] = cell
        else:
            others.append(cell)
    if others:
        out[out[:, 0] < 0] = others
    return out


def random_change(d, seed):
    """Points, cells and a metric, and the points and cells after a swap and some moves."""
    rng = np.random.default_rng(seed)
    if d == 2:
        points, cells = cases.triangulated_square(rng, 60, np.eye(2))
        metric = cases.random_metric(rng, points, "smooth")
        new = cases.shuffled(rng, points, cells, 2)
    else:
        points = np.concatenate(
            [tetrahedra.CORNERS, rng.dirichlet(np.ones(4), 40) @ tetrahedra.CORNERS]
        )
        metric = tetrahedra.random_metric(rng, points, "smooth")
        cells = tetrahedra.oriented(points, Delaunay(points).simplices)
        new = in_place(cells, tetrahedra.flipped(rng, points, cells, 1))
    new_points = points.copy()
    inner = rng.choice(np.arange(d + 1 + (d == 2), len(points)), 2)
    for v in inner:
        new_points[v] += rng.normal(size=d) * 0.03
        edges = new_points[new[:, 1:]] - new_points[new[:, :1]]
        if (np.linalg.det(edges) <= 1e-9).any():
            new_points[v] = points[v]
    return points, cells.astype(np.int32), metric, new_points, new.astype(np.int32)


@pytest.mark.parametrize("d", [2, 3])
def test_renewed_answers_are_those_found_from_scratch(d):
    changed = far = 0
    for seed in range(80):
        points, cells, metric, new_points, new_cells = random_change(d, seed)
        before, after = Mesh(points=points, cells=cells), Mesh(points=new_points, cells=new_cells)
        renewed = RENEWED[d](
            points, cells, metric, before.facets, new_points, new_cells, 1 + seed % 2
        )
        expected = bits_of(after, metric)
        assert np.array_equal(renewed, expected)
        stays = (cells == new_cells[: len(cells)]).all(axis=1)
        stays &= (points == new_points).all(axis=1)[cells].all(axis=1)
        differs = bits_of(before, metric) != expected[: len(cells)]
        changed += differs.any()
        far += (differs & stays).any()
    assert changed > 20
    assert far > 5


@pytest.mark.parametrize("turn", range(3))
@pytest.mark.parametrize("grid", [square(12), cube(3)], ids=["2D", "3D"])
def test_boxes_whose_corners_lie_on_one_ball_but_for_the_last_bit(grid, turn):
    """Rounded arithmetic tells nothing there: every answer hangs on its error bounds."""
    d = grid.dim
    rng = np.random.default_rng(turn)
    Q = np.linalg.qr(rng.normal(size=(d, d)))[0]
    Q[0] *= np.sign(np.linalg.det(Q))
    mesh = Mesh(points=(grid.points + 0.3) @ Q.T, cells=grid.cells)
    metric = np.tile(np.eye(d), (mesh.n_points, 1, 1))
    found = certify(mesh, metric).delaunay
    assert 0.1 < found.mean() < 0.9
    assert np.array_equal(found, cell_by_cell(mesh, metric))
