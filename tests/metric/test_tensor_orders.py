import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import anistar
from anistar.metric import from_components, to_components

TENSOR = np.array([[[1.0, 0.12, 0.13], [0.12, 2.0, 0.23], [0.13, 0.23, 3.0]]])
# Six distinct values: with an identity or a diagonal matrix every mistake goes unnoticed.
EXPECTED = {
    "medit": [1, 0.12, 2, 0.13, 0.23, 3],
    "mmg_api": [1, 0.12, 0.13, 2, 0.23, 3],
    "xdmf": [1, 0.12, 0.13, 2, 0.23, 3],
    "vtk": [1, 2, 3, 0.12, 0.23, 0.13],
    "omega_h": [1, 2, 3, 0.12, 0.23, 0.13],
    "underworld": [1, 2, 3, 0.12, 0.13, 0.23],
    "full": [1, 0.12, 0.13, 0.12, 2, 0.23, 0.13, 0.23, 3],
}


@pytest.mark.parametrize("order", EXPECTED)
def test_each_order_places_six_distinct_values(order):
    assert to_components(TENSOR, order)[0].tolist() == EXPECTED[order]
    assert from_components(np.array([EXPECTED[order]]), order).tolist() == TENSOR.tolist()


@pytest.mark.parametrize(
    ("order", "expected"),
    [
        ("medit", [1, 0.12, 2]),
        ("mmg_api", [1, 0.12, 2]),
        ("omega_h", [1, 2, 0.12]),
        ("underworld", [1, 2, 0.12]),
        ("full", [1, 0.12, 0.12, 2]),
    ],
)
def test_each_planar_order_places_three_distinct_values(order, expected):
    assert to_components(TENSOR[:, :2, :2], order)[0].tolist() == expected
    assert from_components(np.array([expected]), order).tolist() == TENSOR[:, :2, :2].tolist()


@settings(derandomize=True, max_examples=50)
@given(
    values=st.lists(st.floats(-1e6, 1e6), min_size=6, max_size=6, unique=True),
    order=st.sampled_from(sorted(set(EXPECTED) - {"full"})),
)
def test_components_come_back_from_every_order(values, order):
    components = np.array([values])
    assert to_components(from_components(components, order), order).tolist() == [values]


def test_a_tensor_that_is_not_symmetric_is_named():
    tensors = np.repeat(TENSOR, 3, axis=0)
    tensors[2, 0, 1] += 1e-3
    with pytest.raises(ValueError, match=r"tensor 2 is not symmetric: off by 0\.001"):
        to_components(tensors, "medit")
    with pytest.raises(ValueError, match="tensor 2 is not symmetric"):
        from_components(tensors.reshape(3, 9), "full")


def test_a_metric_vector_of_petsc_is_full_matrices_in_a_row():
    tensors = np.repeat(TENSOR, 4, axis=0) * np.arange(1.0, 5.0)[:, None, None]
    vector = to_components(tensors, "full").ravel()
    assert vector[9:18].tolist() == [2, 0.24, 0.26, 0.24, 4, 0.46, 0.26, 0.46, 6]
    assert np.array_equal(from_components(vector.reshape(-1, 9), "full"), tensors)


def test_mmg_reads_our_solution_file_as_the_metric_we_meant(tmp_path):
    mmgpy = pytest.importorskip("mmgpy")
    mesh = anistar.Mesh(
        points=np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float),
        cells=np.array([[0, 1, 2, 3]]),
    )
    M = np.repeat(TENSOR, 4, axis=0) * np.arange(1.0, 5.0)[:, None, None]
    anistar.formats.write_metric(tmp_path / "ours.sol", mesh, M)
    theirs = mmgpy.MmgMesh3D()
    theirs.set_mesh_size(vertices=4, tetrahedra=1)
    theirs.set_vertices(np.array(mesh.points), np.zeros(4, np.int64))
    theirs.set_tetrahedra(np.array(mesh.cells), np.ones(1, np.int64))
    theirs.load_sol(tmp_path / "ours.sol")
    np.testing.assert_allclose(theirs["tensor"], to_components(M, "mmg_api"), rtol=1e-14)
    theirs.save_sol(tmp_path / "theirs.sol")
    back = anistar.formats.read_metric(tmp_path / "theirs.sol", mesh)
    np.testing.assert_allclose(back, M, rtol=1e-14)


@pytest.mark.parametrize("suffix", [".sol", ".solb"])
@pytest.mark.parametrize("dim", [2, 3])
def test_a_metric_survives_its_file(tmp_path, suffix, dim):
    corners = np.vstack([np.zeros(dim), np.eye(dim)])
    mesh = anistar.Mesh(points=corners, cells=np.arange(dim + 1)[None])
    M = np.repeat(TENSOR[:, :dim, :dim], dim + 1, axis=0) * np.arange(1.0, dim + 2)[:, None, None]
    path = tmp_path / f"metric{suffix}"
    anistar.formats.write_metric(path, mesh, M)
    assert np.array_equal(anistar.formats.read_metric(path, mesh), M)
    anistar.write(tmp_path / "mesh.vtu", mesh, {"metric": anistar.Field(M, kind="tensor")})
    assert np.array_equal(anistar.formats.read_metric(tmp_path / "mesh.vtu", mesh), M)


@pytest.mark.parametrize(
    ("columns", "order", "message"),
    [
        (5, "medit", "3 or 6 components in the order 'medit', not 5"),
        (6, "full", "4 or 9 components in the order 'full', not 6"),
        (6, "abaqus", "no tensor order 'abaqus' in 3D"),
        (3, "vtk", "no tensor order 'vtk' in 2D"),
    ],
)
def test_an_unknown_order_or_width_is_refused(columns, order, message):
    with pytest.raises(ValueError, match=message):
        from_components(np.zeros((1, columns)), order)
