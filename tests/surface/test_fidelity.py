"""How far new meshes are from the geometry they were given, and what is said about it."""

import logging

import numpy as np
import pytest
from meshes import annulus, cube, l_shape
from smooth_shapes import ball, bent_block

import anistar
from anistar import RemeshOptions, _core
from anistar.base.telling import telling_once
from anistar.meshes.mesh import Mesh
from anistar.remeshing.report.fidelity import measures_of, smooth_shape


def remeshed(mesh, h, options=None, **more):
    M = np.tile(np.eye(mesh.dim) / h**2, (mesh.n_points, 1, 1))
    done = anistar.remesh(mesh, M, options, **more)
    assert anistar.validate(done.mesh) == []
    return done


def creased(dim, crease):
    """A block with a wavy top that turns down by about `crease` degrees along its middle."""
    if dim == 3:
        base = cube(8)
    else:
        x = np.linspace(0, 1, 11)
        points = np.stack(np.meshgrid(x, [0.0, 1.0], indexing="ij"), -1).reshape(-1, 2)
        left = 2 * np.arange(10)[:, None] + np.array([[0, 2, 3], [0, 3, 1]])[:, None]
        base = Mesh(points=points, cells=left.reshape(-1, 3))
    points = base.points.copy()
    x = points[:, 0]
    top = 1 + 0.05 * np.sin(3 * x) - np.tan(np.radians(crease)) * np.maximum(x - 0.5, 0)
    points[:, -1] *= top
    bare = Mesh(points=points, cells=base.cells)
    is_top = (points[bare.facets][..., -1] > 0.3).all(axis=1)
    is_side = np.ptp(points[bare.facets], axis=1).min(axis=1) < 1e-12
    return Mesh(
        **{
            **bare.arrays(),
            "facet_tags": np.where(is_top & ~is_side, 8, 3),
            "names": {(dim - 1, 8): "top"},
        }
    )


@pytest.mark.parametrize("dim", [2, 3])
def test_the_nearest_facet_is_that_of_brute_force(dim):
    rng = np.random.default_rng(dim)
    points, queries = rng.random((60, dim)), 3 * rng.random((200, dim)) - 1
    facets = np.stack([rng.permutation(60)[:dim] for _ in range(80)]).astype(np.int32)
    nearest = _core.nearest_facets2 if dim == 2 else _core.nearest_facets3
    rows, distances = nearest(points, facets, queries)
    # many samples of each facet, so that no distance is missed by more than their spacing
    weights = rng.dirichlet(np.full(dim, 0.7), 1500)
    samples = np.einsum("sk,fkd->fsd", weights, points[facets])
    for query, row, distance in zip(queries[:40], rows[:40], distances[:40], strict=True):
        sampled = np.linalg.norm(samples - query, axis=2).min(axis=1)
        assert distance <= sampled.min() + 1e-12
        assert distance == pytest.approx(sampled[row], abs=0.05)


def test_the_smooth_shape_of_polygons_is_the_circle():
    shape = smooth_shape(annulus(4), RemeshOptions())
    assert shape.measures.facets == pytest.approx({1: 2 * np.pi, 2: np.pi}, rel=1e-4)
    assert shape.measures.cells[0] == pytest.approx(0.75 * np.pi, rel=1e-4)


def test_the_smooth_shape_of_polyhedra_is_the_sphere_and_the_tube():
    shape = smooth_shape(ball(3), RemeshOptions())
    assert shape.measures.facets[7] == pytest.approx(4 * np.pi, rel=1e-3)
    assert shape.measures.cells[0] == pytest.approx(4 / 3 * np.pi, rel=1e-3)
    tube = bent_block(4)
    ridge = tube.facets[tube.facet_tags == 2][:, :2]
    rim = ridge[(np.ptp(tube.points[ridge][..., 2], axis=1) == 0)]
    rim = rim[tube.points[rim][:, 0, 2] == 0]
    with_ridge = Mesh(**{**tube.arrays(), "edges": rim, "edge_tags": np.full(len(rim), 5)})
    shape = smooth_shape(with_ridge, RemeshOptions())
    assert shape.measures.facets == pytest.approx(
        {1: np.pi / 4, 2: np.pi / 2, 3: 1 + 0.375 * np.pi}, rel=1e-3
    )
    assert shape.measures.cells[0] == pytest.approx(0.1875 * np.pi, rel=1e-3)
    # each end of the arc that a given ridge stops at has the tangent of the circle
    assert shape.measures.edges[5] == pytest.approx(len(rim) / 4 * np.pi / 2, rel=1e-3)


def test_frozen_facets_are_their_own_shape():
    mesh = annulus(3)
    shape = smooth_shape(mesh, RemeshOptions(frozen_tags=[2]))
    given = measures_of(mesh).facets[2]
    assert shape.measures.facets[2] == pytest.approx(given, rel=1e-12)
    assert smooth_shape(ball(2), RemeshOptions(frozen_tags=[7])) is None


@pytest.mark.parametrize("n", [8, 16, 64])
def test_the_sag_of_a_circle_is_that_of_its_chords(n):
    circle = annulus(n // 4)
    shape = smooth_shape(circle, RemeshOptions())
    outer = circle.facet_tags == 1
    chords = np.linalg.norm(np.diff(circle.points[circle.facets[outer]], axis=1), axis=2)
    exact = 1 - np.sqrt(1 - chords.ravel() ** 2 / 4)
    assert shape.sag[outer] == pytest.approx(exact, rel=0.02)


@pytest.mark.parametrize("n", [3, 6, 12])
def test_the_sag_of_a_tube_is_that_of_its_chords(n):
    tube = bent_block(n)
    shape = smooth_shape(tube, RemeshOptions())
    for tag, radius in ((1, 0.5), (2, 1.0)):
        exact = radius * (1 - np.cos(np.pi / 4 / n))
        assert shape.sag[tube.facet_tags == tag] == pytest.approx(exact, rel=0.03)


@pytest.mark.parametrize(
    "make",
    [
        lambda: annulus(4),
        lambda: annulus(12),
        lambda: ball(2),
        lambda: ball(4),
        lambda: bent_block(3),
        lambda: bent_block(8),
    ],
)
def test_new_vertices_of_smooth_bodies_keep_within_the_sag(make):
    mesh = make()
    for h in (0.2, 0.5):
        deviations = remeshed(mesh, h).report.deviations
        assert {it.tag for it in deviations} == set(mesh.facet_tags.tolist())
        assert all(it.distance_there <= 1.2 * it.sag_there for it in deviations)
        assert all(it.distance <= 1.2 * it.sag for it in deviations)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("crease", [25, 38])
def test_a_crease_that_is_taken_for_smooth_is_told(dim, crease, caplog):
    mesh = creased(dim, crease)
    done = remeshed(mesh, 0.04 if dim == 2 else 0.12, RemeshOptions(ridge_angle=150))
    told = next(text for text in done.report.warnings if text.startswith("facet tag 8 (top): near"))
    assert "taken for smooth" in told
    (top,) = (it for it in done.report.deviations if it.tag == 8)
    assert abs(top.place[0] - 0.5) < 0.2
    assert top.distance_there > 1.5 * top.sag_there
    assert told in caplog.messages
    as_ridge = remeshed(mesh, 0.04 if dim == 2 else 0.12, RemeshOptions(ridge_angle=crease - 8.0))
    assert not any("taken for smooth" in text for text in as_ridge.report.warnings)


def test_a_change_of_more_than_one_percent_is_told_with_the_smooth_shape(caplog):
    done = remeshed(ball(2), 0.25)
    (volume,) = (it for it in done.report.tags if it.dim == 3)
    assert volume.change > 0.04
    assert abs(volume.change_from_smooth) < 0.03
    (told,) = (text for text in done.report.warnings if text.startswith("volume of tag 0: +"))
    assert f"{volume.change:+.1%} against the given mesh" in told
    assert f"{volume.change_from_smooth:+.1%} against the smooth shape" in told
    assert told in caplog.messages


@pytest.mark.parametrize(("h", "advice"), [(0.1, 'shape="polyhedron"'), (1.0, "hausdorff_number")])
def test_the_advice_is_to_keep_what_is_given_or_to_follow_what_is_curved(h, advice):
    fine, coarse = ball(2), ball(6)
    report = remeshed(fine if h < 0.5 else coarse, h).report
    (told,) = (text for text in report.warnings if text.startswith("volume of tag 0: "))
    assert advice in told


def test_a_loop_tells_of_each_subject_once(caplog):
    mesh = ball(2)
    with telling_once():
        reports = [remeshed(mesh, h).report for h in (0.25, 0.3)]
    subjects = [text.partition(":")[0] for text in caplog.messages]
    assert "volume of tag 0" in subjects
    assert len(subjects) == len(set(subjects))
    assert all(any("volume" in text for text in report.warnings) for report in reports)
    remeshed(mesh, 0.25)
    assert len(caplog.messages) == len(subjects) + len(reports[0].warnings)


@pytest.mark.parametrize("make", [lambda: l_shape(3), lambda: cube(3)])
def test_nothing_is_told_of_straight_domains(make, caplog):
    caplog.set_level(logging.DEBUG)
    report = remeshed(make(), 0.2).report
    assert report.deviations == ()
    assert report.warnings == ()
    assert caplog.messages == []
    assert all(it.smooth == it.before for it in report.tags)


def test_a_projection_is_the_shape_and_is_not_compared():
    def onto_unit_circle(points, tag):
        return points / np.linalg.norm(points, axis=1)[:, None] if tag == 1 else points

    report = remeshed(annulus(2), 0.1, project=onto_unit_circle).report
    assert report.deviations == ()
    assert not any("taken for smooth" in text for text in report.warnings)


def test_the_report_is_plain():
    as_json = remeshed(annulus(3), 0.3).report.as_dict()
    assert {type(text) for text in as_json["warnings"]} <= {str}
    for it in as_json["deviations"]:
        assert set(it) == {
            *("tag", "name", "distance", "sag"),
            *("place", "distance_there", "sag_there"),
        }
        assert type(it["place"]) is list
