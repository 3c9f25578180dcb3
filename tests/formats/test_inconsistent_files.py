"""Files that can be parsed but do not fit together."""

import struct
import sys

import numpy as np
import pytest
from meshes import square

from anistar import Mesh, formats
from anistar.base.errors import FormatError
from anistar.runs.file_solver import FileSolver

HEAD = "MeshVersionFormatted 2\nDimension 2\n"
POINTS = "Vertices\n5\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n9 9 0\n"
CELLS = "Triangles\n2\n1 2 3 0\n1 3 4 0\n"


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("Edges\n2\n1 2 0\n2 5 0\n", "1 has point 4, which belongs to no cell"),
        ("Tetrahedra\n1\n1 2 3 4 0\n", "tetrahedra need three coordinates, the points have 2"),
    ],
)
def test_entities_that_do_not_belong_to_the_mesh_are_named(tmp_path, more, message):
    path = tmp_path / "m.mesh"
    path.write_text(HEAD + POINTS + CELLS + more + "End\n")
    with pytest.raises(FormatError, match=message):
        formats.read(path)


def test_a_file_with_two_tensor_fields_must_say_which_is_the_metric(tmp_path):
    mesh = square(2)
    tensors = np.tile(np.eye(2), (mesh.n_points, 1, 1))
    formats.write(tmp_path / "two.vtu", mesh, {"a": tensors, "b": 2 * tensors})
    with pytest.raises(FormatError, match=r"two\.vtu: 2 tensor fields at points, one or one call"):
        formats.read_metric(tmp_path / "two.vtu", mesh)
    formats.write(tmp_path / "named.vtu", mesh, {"a": tensors, "metric": 2 * tensors})
    assert np.array_equal(formats.read_metric(tmp_path / "named.vtu", mesh), 2 * tensors)


def test_a_solution_with_two_fields_is_no_metric(tmp_path):
    mesh = square(2)
    formats.write(tmp_path / "m.sol", mesh, {"u": np.ones(9), "v": np.ones(9)})
    with pytest.raises(FormatError, match="a metric is one field at the points, not 2"):
        formats.read_metric(tmp_path / "m.sol", mesh)


def test_a_binary_file_whose_chain_turns_back_is_refused(tmp_path):
    path = tmp_path / "m.meshb"
    path.write_bytes(struct.pack("<iiiiiiii", 1, 2, 3, 8, 2, 54, 0, 0))
    with pytest.raises(FormatError, match="the offset 8 points back: the file is damaged"):
        formats.read(path)


def test_a_binary_file_without_a_dimension_is_refused(tmp_path):
    path = tmp_path / "m.meshb"
    path.write_bytes(struct.pack("<iiii", 1, 2, 54, 0))
    with pytest.raises(FormatError, match="it has no Dimension"):
        formats.read(path)


def test_a_solver_that_returns_another_mesh_is_told_so(tmp_path, monkeypatch):
    formats.write(tmp_path / "other.vtu", square(3), {"u": np.zeros(16)})
    script = tmp_path / "solve.py"
    script.write_text("import shutil, sys; shutil.copy('other.vtu', sys.argv[2])")
    monkeypatch.chdir(tmp_path)
    command = f"{sys.executable} solve.py {{mesh}} {{solution}}"
    solver = FileSolver(command, tmp_path, kind="vtu")
    with pytest.raises(FormatError, match="has 16 points and 18 cells in 2D, the mesh has 9 and 8"):
        solver(square(2), {})


def test_what_a_solver_is_not_told_of_the_mesh_is_said_once(tmp_path, monkeypatch, caplog):
    mesh = Mesh(**square(2).arrays() | {"z": 0.5})
    formats.write(tmp_path / "solved.vtu", mesh, {"u": np.zeros(9)})
    (tmp_path / "solve.py").write_text("import shutil, sys; shutil.copy('solved.vtu', sys.argv[2])")
    monkeypatch.chdir(tmp_path)
    solver = FileSolver(f"{sys.executable} solve.py {{mesh}} {{solution}}", ".", kind="su2")
    for _ in range(2):
        assert solver(mesh, {})["u"].values.shape == (9,)
    told = [text for text in caplog.messages if "height" in text]
    assert told == ["step_000.su2: this format does not carry the height z = 0.5"]


def test_an_unknown_kind_of_solver_file_is_named(tmp_path):
    with pytest.raises(ValueError, match=r"file kind must be one of mesh, .*, not 'hdf'"):
        FileSolver("solve {mesh} {solution}", tmp_path, kind="hdf")
