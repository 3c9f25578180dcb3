"""What beginners do, and what they are told."""

import numpy as np
import pytest
from meshes import square

import anistar
from anistar import LoopOptions, Mesh, MetricOptions, RemeshOptions


def test_a_mesh_is_made_of_points_and_cells_by_position():
    mesh = square()
    again = Mesh(mesh.points, mesh.cells)
    assert anistar.validate(again) == []
    with pytest.raises(TypeError, match="takes 3 positional arguments but 4"):
        Mesh(mesh.points, mesh.cells, mesh.cell_tags)


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (
            lambda: LoopOptions((100, 200)),
            TypeError,
            r"LoopOptions takes its options by name, got \(100, 200\) without one; the names "
            "are adapt, complexities,",
        ),
        (
            lambda: MetricOptions(target_complexty=9),
            TypeError,
            "MetricOptions has no option 'target_complexty': did you mean 'target_complexity'",
        ),
        (
            lambda: RemeshOptions(xyz=9),
            TypeError,
            "RemeshOptions has no option 'xyz': known: agreement, callback,",
        ),
        (
            lambda: MetricOptions(target_complexity="1000"),
            TypeError,
            "target_complexity must be a number, got '1000'",
        ),
        (
            lambda: LoopOptions(target_error="1e-3"),
            TypeError,
            "target_error must be a number, got '1e-3'",
        ),
        (
            lambda: RemeshOptions(max_seconds="3"),
            TypeError,
            "max_seconds must be a number, got '3'",
        ),
        (
            lambda: MetricOptions(size_at=0.1),
            TypeError,
            "size_at must be like {'wall': 0.02}, got 0.1",
        ),
        (
            lambda: anistar.Field(np.ma.masked_less(np.arange(5.0), 2)),
            ValueError,
            "2 values are masked, the first is value 0: give what is to stand there",
        ),
        (
            lambda: adapted(np.ma.masked_equal(np.arange(25.0), 7)),
            ValueError,
            "field 'u': 1 values are masked, the first is value 7",
        ),
        (
            lambda: adapted(np.arange(25)),
            ValueError,
            r"the fields are: u \(label, points\); whole numbers are labels, give them",
        ),
        (
            lambda: anistar.adapt(square(), {"u": np.arange(25) > 7}, target_complexity=9),
            ValueError,
            "no scalar or vector .* whole numbers are labels, give them as floats",
        ),
        (
            lambda: anistar.metric.recover_hessian(
                square(), np.ma.masked_equal(np.arange(25.0), 7)
            ),
            ValueError,
            "1 values are masked, the first is value 7",
        ),
    ],
)
def test_a_mistake_is_named(call, error, message):
    with pytest.raises(error, match=message):
        call()


def adapted(values):
    return anistar.adapt(square(), values, target_complexity=9)


def test_a_mask_that_hides_nothing_does_no_harm():
    values = np.ma.MaskedArray(np.tanh(9 * square(8).points[:, 0]), mask=False)
    done = anistar.adapt(square(8), values, target_complexity=60)
    assert anistar.validate(done.mesh) == []


def test_a_field_without_features_is_told(caplog):
    done = anistar.adapt(
        square(), {"a": np.ones(25), "b": square().points[:, 0]}, p=2.0, target_complexity=50
    )
    assert anistar.validate(done.mesh) == []
    assert "no second derivative above the noise in a, b: the mesh is uniform" in caplog.text
    caplog.clear()
    anistar.adapt(square(8), np.tanh(9 * square(8).points[:, 0]), target_complexity=60)
    assert caplog.text == ""
