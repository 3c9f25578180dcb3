import numpy as np
import pytest
from hypothesis import given, settings
from meshes import cube, square
from pairs import centroids, jittered, pairs, seeds, with_regions

from anistar import transfer_quadrature

RULES = {
    2: np.array([[4, 1, 1], [1, 4, 1], [1, 1, 4]]) / 6,
    3: np.full((1, 4), 1 / 4),
}


def places(mesh, rule):
    return np.einsum("qk,mkd->mqd", rule, mesh.points[mesh.cells])


@given(pairs(), seeds)
@settings(max_examples=20)
def test_each_point_takes_the_state_that_is_nearest_in_its_metric(pair, seed):
    source, target = pair
    rule = RULES[source.dim]
    random = np.random.default_rng(seed)
    turn = np.linalg.qr(random.normal(size=(source.dim, source.dim)))[0]
    tensor = turn @ np.diag(10.0 ** random.uniform(-1, 3, source.dim)) @ turn.T
    tensor = (tensor + tensor.T) / 2
    x, y = places(source, rule).reshape(-1, source.dim), places(target, rule)
    states = np.arange(len(x)).reshape(source.n_cells, len(rule))
    metric = np.tile(tensor, (target.n_points, 1, 1))
    taken = transfer_quadrature(source, states, target, rule=rule, metric=metric)
    offset = y.reshape(-1, 1, source.dim) - x[None]
    distance = np.einsum("abi,ij,abj->ab", offset, tensor, offset)
    found = distance[np.arange(len(distance)), taken.ravel()]
    assert np.all(found <= distance.min(axis=1) * (1 + 1e-9))


def test_states_of_any_shape_and_type_are_copied_whole():
    source, target = square(3), square(4)
    states = np.array(["elastic", "plastic"])[(centroids(source)[:, 0] > 0.5).astype(int)]
    states = np.repeat(states[:, None], 3, axis=1)
    taken = transfer_quadrature(source, states, target, rule=RULES[2])
    assert taken.shape == (target.n_cells, 3)
    assert set(np.unique(taken)) == {"elastic", "plastic"}
    tensors = np.random.default_rng(0).normal(size=(source.n_cells, 3, 3, 3))
    one_point = np.full((1, 3), 1 / 3)
    taken = transfer_quadrature(source, tensors, target, rule=RULES[2], target_rule=one_point)
    assert taken.shape == (target.n_cells, 1, 3, 3)
    assert np.isin(taken, tensors).all()


def test_the_same_mesh_keeps_every_state():
    mesh = jittered(2, 5, 0)
    states = np.random.default_rng(0).normal(size=(mesh.n_cells, 3, 4))
    assert np.array_equal(transfer_quadrature(mesh, states, mesh, rule=RULES[2]), states)


def test_states_do_not_cross_an_interface():
    source, target = with_regions(square(4)), with_regions(square(6))
    states = np.repeat(source.cell_tags[:, None], 3, axis=1)
    taken = transfer_quadrature(source, states, target, rule=RULES[2])
    assert np.array_equal(taken, np.repeat(target.cell_tags[:, None], 3, axis=1))


def test_a_metric_decides_which_neighbour_is_near():
    # Rows of points above each other: with a metric that is stiff across, along wins.
    source, target = square(4), square(5)
    rule = np.full((1, 3), 1 / 3)
    states = np.round(centroids(source)[:, 1] * 4 * 3).astype(int)[:, None]
    stiff = np.tile(np.diag([1e-6, 1.0]), (target.n_points, 1, 1))
    taken = transfer_quadrature(source, states, target, rule=rule, metric=stiff)
    heights = np.unique(centroids(source)[:, 1])
    wanted = heights[np.argmin(np.abs(centroids(target)[:, 1, None] - heights), axis=1)]
    near_tie = np.abs(np.sort(np.abs(centroids(target)[:, 1, None] - heights))[:, :2]) @ [-1, 1]
    decided = near_tie > 1e-3
    assert np.array_equal(taken[decided, 0], np.round(wanted * 12).astype(int)[decided])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"rule": np.ones((2, 4))}, r"rule must have shape \(q, 3\), not \(2, 4\)"),
        ({"rule": [[0.5, 0.5, 0.5]]}, "rule must hold barycentric coordinates"),
        ({"rule": [[2.0, -1.0, 0.0]]}, "smallest -1, sums off by 0"),
        ({"rule": RULES[2]}, r"values of shape \(18, 1\) do not fit 18 cells with 3 quadrature"),
        ({"outside": "nan"}, "outside must be raise or nearest for states, not 'nan'"),
    ],
)
def test_bad_input_is_named(arguments, message):
    given_ = {"rule": np.full((1, 3), 1 / 3), **arguments}
    with pytest.raises(ValueError, match=message):
        transfer_quadrature(square(3), np.ones((18, 1)), square(2), **given_)


def test_meshes_of_different_dimensions_are_refused():
    with pytest.raises(ValueError, match="cannot transfer from a 2D mesh to a 3D mesh"):
        transfer_quadrature(square(2), np.ones((8, 1)), cube(1), rule=np.full((1, 3), 1 / 3))
