"""When a mesh is kept although the metric has changed."""

import numpy as np
import pytest
from meshes import cube, square

import anistar
from anistar import KeepOptions, needs_adaptation


def made_for(size, make=square, n=8):
    """A mesh for one size in all directions, and that metric."""
    mesh = make(n)
    metric = np.tile(np.eye(mesh.dim) / size**2, (mesh.n_points, 1, 1))
    done = anistar.remesh(mesh, metric)
    assert anistar.validate(done.mesh) == []
    return done.mesh, done.metric


@pytest.mark.parametrize(("make", "size"), [(square, 0.05), (cube, 0.16)])
def test_a_new_mesh_is_kept_and_one_for_another_metric_is_not(make, size):
    mesh, metric = made_for(size, make)
    assert not needs_adaptation(mesh, metric)
    assert not needs_adaptation(mesh, 1.2 * metric)
    assert needs_adaptation(mesh, 6 * metric)
    assert needs_adaptation(mesh, metric / 4)  # four or eight times the points it needs


def test_short_edges_alone_decide_nothing():
    """Half of the edges become ten times too short where little was needed anyway."""
    mesh, metric = made_for(0.05)
    coarse = mesh.points[:, 0] < 0.5
    asked = np.where(coarse[:, None, None], metric / 100, metric)
    assert not needs_adaptation(mesh, asked, KeepOptions(over=np.inf))
    assert needs_adaptation(mesh, asked)  # they are many: 1.9 times the points it needs
    assert not needs_adaptation(mesh, asked, KeepOptions(over=1.5))


def test_points_that_a_feature_has_left_count_with_the_edges_where_it_went():
    mesh, metric = made_for(0.05)
    x = mesh.points[:, 0, None, None]
    left = np.where(x < 0.4, metric / 4, metric)
    moved = np.where(x > 0.9, 3 * metric, left)
    assert not needs_adaptation(mesh, left)
    assert needs_adaptation(mesh, moved)
    assert not needs_adaptation(mesh, moved, KeepOptions(misplaced=1.0))
    assert not needs_adaptation(mesh, np.where(x > 0.9, 3 * metric, metric))


def test_long_edges_decide_by_their_share_and_by_the_longest():
    mesh, metric = made_for(0.05)
    corner = (np.square(mesh.points).sum(axis=1) < 0.2**2)[:, None, None]
    finer = np.where(corner, 9 * metric, metric)  # 3 % of the area
    assert not needs_adaptation(mesh, finer, KeepOptions(longest=5.0))
    assert needs_adaptation(mesh, finer, KeepOptions(longest=3.0))
    assert needs_adaptation(mesh, finer, KeepOptions(longest=5.0, under=0.01))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"under": -0.1}, r"under must be in \[0, 1\], got -0\.1"),
        ({"misplaced": 2.0}, r"misplaced must be in \[0, 1\], got 2\.0"),
        ({"over": -1.0}, r"over must be at least 0, got -1\.0"),
        ({"over": np.nan}, "over must be at least 0, got nan"),
        ({"longest": 1.0}, r"longest must be above sqrt\(2\), got 1\.0"),
    ],
)
def test_a_bad_bound_is_named(options, message):
    with pytest.raises(ValueError, match=message):
        KeepOptions(**options)


def test_something_else_than_options_is_refused():
    mesh, metric = made_for(0.2)
    with pytest.raises(TypeError, match="keep must be KeepOptions, not float"):
        needs_adaptation(mesh, metric, 0.8)
