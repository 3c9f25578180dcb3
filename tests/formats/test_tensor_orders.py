import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from anistar.formats.tensor_orders import from_components, to_components

TENSOR = np.array([[[1.0, 0.12, 0.13], [0.12, 2.0, 0.23], [0.13, 0.23, 3.0]]])
# Six distinct values: with an identity or a diagonal matrix every mistake goes unnoticed.
EXPECTED = {
    "medit": [1, 0.12, 2, 0.13, 0.23, 3],
    "mmg_api": [1, 0.12, 0.13, 2, 0.23, 3],
    "xdmf": [1, 0.12, 0.13, 2, 0.23, 3],
    "vtk": [1, 2, 3, 0.12, 0.23, 0.13],
    "omega_h": [1, 2, 3, 0.12, 0.23, 0.13],
}


@pytest.mark.parametrize("order", EXPECTED)
def test_each_order_places_six_distinct_values(order):
    assert to_components(TENSOR, order)[0].tolist() == EXPECTED[order]
    assert from_components(np.array([EXPECTED[order]]), order).tolist() == TENSOR.tolist()


@pytest.mark.parametrize(
    ("order", "expected"),
    [("medit", [1, 0.12, 2]), ("mmg_api", [1, 0.12, 2]), ("omega_h", [1, 2, 0.12])],
)
def test_each_planar_order_places_three_distinct_values(order, expected):
    assert to_components(TENSOR[:, :2, :2], order)[0].tolist() == expected
    assert from_components(np.array([expected]), order).tolist() == TENSOR[:, :2, :2].tolist()


@settings(derandomize=True, max_examples=50)
@given(
    values=st.lists(st.floats(-1e6, 1e6), min_size=6, max_size=6, unique=True),
    order=st.sampled_from(sorted(EXPECTED)),
)
def test_components_come_back_from_every_order(values, order):
    components = np.array([values])
    assert to_components(from_components(components, order), order).tolist() == [values]


def test_a_tensor_that_is_not_symmetric_is_named():
    tensors = np.repeat(TENSOR, 3, axis=0)
    tensors[2, 0, 1] += 1e-3
    with pytest.raises(ValueError, match=r"tensor 2 is not symmetric: off by 0\.001"):
        to_components(tensors, "medit")


@pytest.mark.parametrize(
    ("columns", "order", "message"),
    [
        (5, "medit", "3 or 6 components, not 5"),
        (6, "abaqus", "no tensor order 'abaqus' in 3D"),
        (3, "vtk", "no tensor order 'vtk' in 2D"),
    ],
)
def test_an_unknown_order_or_width_is_refused(columns, order, message):
    with pytest.raises(ValueError, match=message):
        from_components(np.zeros((1, columns)), order)
