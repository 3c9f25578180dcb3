import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from meshes import cube, rectangle_with_jitter, square

from anistar.base.report import to_json
from anistar.meshes.fields import Field
from anistar.meshes.mesh import Mesh
from anistar.meshes.topology import cell_volumes
from anistar.transfer import TransferOptions, integral, transfer

LINEAR = np.array([[1.5, -2.0, 0.25], [0.5, 3.0, -1.0]])


def linear(points):
    return 0.7 + points @ LINEAR[0, : points.shape[1]]


def shrunk(mesh, factor=0.999):
    """The same mesh, pulled towards its middle so that it lies inside."""
    middle = mesh.points.mean(axis=0)
    return Mesh(points=middle + factor * (mesh.points - middle), cells=mesh.cells)


@settings(derandomize=True, max_examples=20, deadline=None)
@given(st.integers(2, 9), st.integers(2, 9), st.integers(0, 5))
def test_linear_fields_are_carried_exactly(n, m, seed):
    source, target = rectangle_with_jitter(n, seed), square(m)
    x = source.points
    fields = {"u": linear(x), "v": np.stack([x[:, 0], linear(x)], 1)}
    carried = transfer(source, fields, target).fields
    assert np.abs(carried["u"] - linear(target.points)).max() < 1e-13
    assert np.abs(carried["v"][:, 0] - target.points[:, 0]).max() < 1e-13


def test_linear_fields_are_carried_exactly_in_three_dimensions():
    source = cube(3)
    target = shrunk(source, 0.8)
    carried = transfer(source, {"u": linear(source.points)}, target).fields["u"]
    assert np.abs(carried - linear(target.points)).max() < 1e-13


def test_values_keep_within_their_bounds():
    source, target = square(5), rectangle_with_jitter(8)
    u = np.random.default_rng(1).uniform(-1, 1, source.n_points)
    carried = transfer(source, {"u": u}, target).fields["u"]
    assert u.min() <= carried.min()
    assert carried.max() <= u.max()


def test_fields_come_back_in_the_form_they_were_given():
    mesh = square(3)
    fields = {"bare": np.ones(mesh.n_points), "field": Field(np.ones(mesh.n_points))}
    carried = transfer(mesh, fields, square(2)).fields
    assert isinstance(carried["bare"], np.ndarray)
    assert isinstance(carried["field"], Field)


def test_cell_values_are_those_of_the_cell_that_holds_the_centroid():
    source, target = square(4), square(8)
    left = source.points[source.cells].mean(axis=1)[:, 0] < 0.5
    fields = {
        "k": Field(np.where(left, 1, 2), "cells"),
        "q": Field(np.where(left, -1.0, 3.0), "cells"),
    }
    carried = transfer(source, fields, target).fields
    is_left = target.points[target.cells].mean(axis=1)[:, 0] < 0.5
    assert carried["k"].kind == "label"
    assert np.array_equal(carried["k"].values, np.where(is_left, 1, 2))
    assert np.array_equal(carried["q"].values, np.where(is_left, -1.0, 3.0))


def test_a_point_label_is_the_one_with_most_weight_and_never_a_mean():
    triangle = Mesh(points=[[0, 0], [1, 0], [0, 1]], cells=[[0, 1, 2]])
    inside = Mesh(points=[[0.3, 0.3], [0.9, 0.05], [0.02, 0.02]], cells=[[0, 2, 1]])
    carried = transfer(triangle, {"k": np.array([1, 5, 5])}, inside).fields["k"]
    # At the first point the two corners with label 5 together weigh .6, the third .4.
    assert carried.tolist() == [5, 5, 1]


def test_tensors_are_interpolated_in_their_logarithms_on_request():
    segment = Mesh(points=[[0, 0], [1, 0], [0, 1]], cells=[[0, 1, 2]])
    middle = Mesh(points=[[0.5, 0.0], [0.5, 0.1], [0.4, 0.1]], cells=[[0, 1, 2]])
    M = np.array([np.eye(2), 100 * np.eye(2), np.eye(2)])
    plain = transfer(segment, {"M": M}, middle).fields["M"]
    logarithmic = transfer(segment, {"M": M}, middle, TransferOptions(log_euclidean=True)).fields[
        "M"
    ]
    assert plain[0, 0, 0] == pytest.approx(50.5)
    assert logarithmic[0, 0, 0] == pytest.approx(10.0)


def test_the_report_has_integrals_and_extrema_before_and_after():
    source, target = square(6), square(9)
    report = transfer(source, {"u": linear(source.points)}, target).report
    change = report.as_dict()["changes"]["u"]
    assert change["integral"]["before"] == pytest.approx(change["integral"]["after"], rel=1e-12)
    assert change["integral"]["after"][0] == pytest.approx(0.7 + 0.75 - 1.0)
    assert change["maximum"] == {"before": [pytest.approx(2.2)], "after": [pytest.approx(2.2)]}
    assert report.points_outside == 0
    assert report.seconds > 0


def test_the_report_of_every_method_is_json():
    mesh = square(3)
    fields = {"u": linear(mesh.points), "q": Field(np.ones((mesh.n_cells, 6)), "cell_nodes")}
    options = TransferOptions(l2_difference=True)
    told = json.loads(to_json(transfer(mesh, fields, square(4), options).report))
    assert told["changes"]["u"]["l2_difference"] == [pytest.approx(0, abs=1e-7)]
    assert told["changes"]["q"]["l2_difference"] is None
    assert told["coverage"]["cells"] == 0
    told = json.loads(to_json(transfer(mesh, {"u": fields["u"]}, square(4)).report))
    assert told["coverage"] is None
    assert told["changes"]["u"]["l2_difference"] is None
    assert told["changes"]["u"]["defects"]["0"] == [pytest.approx(0, abs=1e-14)]


def test_the_function_is_not_hidden_by_the_package_of_its_name():
    import anistar
    import anistar.transfer.options

    assert anistar.transfer is transfer


def test_the_integral_of_one_is_the_area():
    mesh = rectangle_with_jitter(5)
    area = cell_volumes(mesh.points, mesh.cells).sum()
    assert integral(mesh, Field(np.ones(mesh.n_points))) == pytest.approx(area)
    assert integral(mesh, Field(np.ones(mesh.n_cells), "cells")) == pytest.approx(area)


class TestPointsOutside:
    source = shrunk(square(4), 0.9)
    target = square(4)

    def test_raise_by_default_and_name_the_farthest(self):
        u = np.ones(self.source.n_points)
        with pytest.raises(ValueError, match=r"point \d+ at .* lies 0.0707 outside the source"):
            transfer(self.source, {"u": u}, self.target)

    def test_take_the_nearest_value_on_request(self):
        x = self.source.points[:, 0]
        done = transfer(self.source, {"x": x}, self.target, outside="nearest")
        assert done.fields["x"].min() == pytest.approx(0.05)
        assert done.report.points_outside == 16
        assert done.report.max_distance == pytest.approx(0.05 * np.sqrt(2))

    def test_become_nan_on_request(self):
        u = np.ones(self.source.n_points)
        carried = transfer(self.source, {"u": u}, self.target, outside="nan").fields["u"]
        assert np.isnan(carried).sum() == 16

    def test_cannot_become_nan_in_a_label(self):
        labels = {"k": np.ones(self.source.n_points, int)}
        with pytest.raises(ValueError, match="label field 'k' cannot hold NaN and 16 points"):
            transfer(self.source, labels, self.target, outside="nan")

    def test_within_the_tolerance_count_as_inside(self):
        u = np.ones(self.source.n_points)
        options = TransferOptions(tolerance=0.06)
        assert transfer(self.source, {"u": u}, self.target, options).report.points_outside == 0

    def test_are_looked_for_only_where_a_field_lives(self):
        # The centroids of the corner cells stay inside, though the corners do not.
        q = Field(np.arange(self.source.n_cells, dtype=float), "cells")
        assert len(transfer(self.source, {"q": q}, self.target).fields["q"].values) == 32


def test_a_method_that_does_not_exist_is_named_with_those_that_do():
    mesh = square(2)
    names = "interpolate, conservative, bounded"
    with pytest.raises(ValueError, match=f"method 'magic' does not exist; methods: {names}"):
        transfer(mesh, {}, mesh, method="magic")


@pytest.mark.parametrize(
    ("option", "message"),
    [
        ({"outside": "drop"}, "outside must be one of raise, nearest, nan, not 'drop'"),
        ({"tolerance": -1.0}, r"transfer tolerance must be at least 0, not -1\.0"),
    ],
)
def test_a_bad_option_is_named_with_its_bound(option, message):
    with pytest.raises(ValueError, match=message):
        TransferOptions(**option)


def test_a_field_of_the_wrong_length_is_named():
    with pytest.raises(ValueError, match="field 'u' has 3 values, the mesh has 9 points"):
        transfer(square(2), {"u": np.ones(3)}, square(2))


def test_meshes_of_different_dimensions_are_refused():
    with pytest.raises(ValueError, match="cannot transfer from a 2D mesh to a 3D mesh"):
        transfer(square(2), {}, cube(1))
