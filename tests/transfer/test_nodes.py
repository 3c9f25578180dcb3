import numpy as np
import pytest
from hypothesis import given, settings
from meshes import cube, square
from pairs import jittered, linear, pairs, with_regions

from anistar import Field, transfer
from anistar.transfer import integral, node_positions
from anistar.transfer.values.nodes import n_nodes, node_basis, node_coordinates


def quadratic(x):
    return linear(x) + x[..., 0] * x[..., 1] - 2 * x[..., -1] ** 2


@given(pairs())
@settings(max_examples=20)
def test_quadratic_fields_are_interpolated_exactly(pair):
    source, target = pair
    field = Field(quadratic(node_positions(source, 2)), "cell_nodes")
    carried = transfer(source, {"u": field}, target).fields["u"]
    assert np.abs(carried.values - quadratic(node_positions(target, 2))).max() < 1e-12


@pytest.mark.parametrize("mesh", [jittered(2, 4, 0), jittered(3, 2, 0)])
def test_the_integral_of_a_quadratic_field_is_exact(mesh):
    field = Field(quadratic(node_positions(mesh, 2)), "cell_nodes")
    x_y, z_z = 1 / 4, 1 / 3
    exact = 0.7 + (1.5 - 2.0) / 2 + (0.125 if mesh.dim == 3 else 0) + x_y - 2 * z_z
    assert integral(mesh, field) == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("order", [1, 2])
def test_each_basis_function_is_one_at_its_node_and_zero_at_the_others(dim, order):
    count = n_nodes(dim, order)
    assert np.allclose(node_basis(node_coordinates(dim, count), count), np.eye(count))


def test_nodes_of_a_cell_take_the_values_of_their_side():
    source, target = with_regions(square(4)), square(2)
    values = np.where(source.cell_tags == 7, 3.0, -1.0)
    field = Field(np.repeat(values[:, None], 3, axis=1), "cell_nodes")
    carried = transfer(source, {"q": field}, target).fields["q"].values
    right = target.points[target.cells].mean(axis=1)[:, 0] > 0.5
    assert np.array_equal(carried, np.where(right, 3.0, -1.0)[:, None] * np.ones(3))


def test_continuous_quadratic_fields_stay_continuous():
    source, target = jittered(2, 4, 0), jittered(2, 5, 1)
    random = np.random.default_rng(0).normal(size=source.n_points)
    corners = random[source.cells]
    middles = [np.cos(corners[:, i] + corners[:, j]) for i, j in ((0, 1), (0, 2), (1, 2))]
    field = Field(np.concatenate([corners, np.stack(middles, axis=1)], axis=1), "cell_nodes")
    carried = transfer(source, {"u": field}, target).fields["u"].values[:, :3]
    for v in range(target.n_points):
        values = carried[target.cells == v]
        assert np.ptp(values) < 1e-12


def test_nodes_outside_are_named_by_their_cell():
    target = square(2)
    source = jittered(2, 3, 0)
    shrunk = type(source)(points=0.9 * source.points, cells=source.cells)
    field = Field(np.ones((source.n_cells, 3)), "cell_nodes")
    with pytest.raises(ValueError, match=r"a point of cell \d at \(1, 1\) lies 0.141 outside the"):
        transfer(shrunk, {"q": field}, target)
    carried = transfer(shrunk, {"q": field}, target, outside="nan").fields["q"].values
    assert np.isnan(carried).any()
    assert not np.isnan(carried).all()


def test_the_order_of_nodes_is_checked():
    with pytest.raises(ValueError, match="order of the nodes must be 1 or 2, not 3"):
        node_positions(square(1), 3)


@pytest.mark.parametrize(
    ("shape", "message"),
    [
        ((8, 4), "field 'q' has 4 nodes in each cell; a 2D mesh takes 3 .P1. or 6 .P2."),
        ((7, 3), "field 'q' has 7 values, the mesh has 8 cells"),
        ((8, 3, 3), "of kind vector has shape"),
    ],
)
def test_values_at_nodes_of_the_wrong_shape_are_named(shape, message):
    with pytest.raises(ValueError, match=message):
        transfer(square(2), {"q": Field(np.ones(shape), "cell_nodes")}, square(2))


def test_labels_do_not_live_at_nodes():
    with pytest.raises(ValueError, match="a label lives on points or cells, not on cell_nodes"):
        Field(np.ones((8, 3), int), "cell_nodes", "label")


def test_node_fields_in_three_dimensions_have_four_or_ten_values():
    assert node_positions(cube(1), 1).shape == (6, 4, 3)
    assert node_positions(cube(1), 2).shape == (6, 10, 3)
