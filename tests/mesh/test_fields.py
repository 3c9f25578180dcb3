import numpy as np
import pytest
from meshes import square

from anistar.meshes.fields import Field, as_fields


def test_bare_arrays_live_on_points_and_their_kind_is_deduced():
    mesh = square(2)
    n = mesh.n_points
    fields = as_fields(
        mesh,
        {
            "u": np.zeros(n, np.float32),
            "v": np.zeros((n, 2)),
            "T": np.zeros((n, 2, 2)),
            "k": np.arange(n),
            "flag": np.ones(n, bool),
        },
    )
    assert [field.kind for field in fields.values()] == [
        "scalar", "vector", "tensor", "label", "label"
    ]  # fmt: skip
    assert {field.on for field in fields.values()} == {"points"}
    assert fields["u"].values.dtype == np.float64


def test_a_cell_field_is_measured_against_the_cells():
    mesh = square(2)
    assert as_fields(mesh, {"k": Field(np.zeros(8), "cells")})["k"].on == "cells"
    with pytest.raises(ValueError, match="field 'k' has 9 values, the mesh has 8 cells"):
        as_fields(mesh, {"k": Field(np.zeros(9), "cells")})


def test_no_fields_are_an_empty_dict():
    assert as_fields(square(1), None) == {}


@pytest.mark.parametrize(
    ("values", "error", "message"),
    [
        (np.zeros(8), ValueError, "field 'u' has 8 values, the mesh has 9 points"),
        (np.zeros((9, 3)), ValueError, "field 'u' of kind vector has shape"),
        (np.zeros((9, 2, 3)), ValueError, "field 'u' of kind tensor has shape"),
        (np.zeros((9, 2, 2, 2)), ValueError, "field 'u': field values must be"),
        (np.zeros(9, complex), TypeError, "field 'u': field values must be real"),
        (["a"] * 9, TypeError, "field 'u': field values must be real"),
    ],
)
def test_a_wrong_field_is_named(values, error, message):
    with pytest.raises(error, match=message):
        as_fields(square(2), {"u": values})


def test_a_name_that_is_no_string_is_refused():
    with pytest.raises(TypeError, match="field names must be strings, not 3"):
        as_fields(square(2), {3: np.zeros(9)})


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"on": "edges"}, ValueError, "field location must be"),
        ({"kind": "spinor"}, ValueError, "field kind must be one of"),
        ({"kind": "vector"}, ValueError, "a vector field needs an array of 2"),
        ({"kind": "label"}, TypeError, "a label field needs integers"),
    ],
)
def test_a_wrong_description_is_refused(options, error, message):
    with pytest.raises(error, match=message):
        Field(np.zeros(4), **options)
