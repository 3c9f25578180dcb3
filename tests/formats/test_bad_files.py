import numpy as np
import pytest
from meshes import square, two_region_cube

from anistar import formats
from anistar.base.errors import FormatError

HEAD = "MeshVersionFormatted 2\nDimension 2\n"
POINTS = "Vertices\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
CELLS = "Triangles\n2\n1 2 3 0\n1 3 4 0\n"


@pytest.mark.parametrize("suffix", [".mesh", ".meshb", ".msh", ".vtu", ".vtk", ".xdmf"])
def test_a_truncated_file_is_refused_wherever_it_ends(tmp_path, suffix):
    path = tmp_path / f"m{suffix}"
    mesh = two_region_cube()
    formats.write(path, mesh, None if "mesh" in suffix else {"u": mesh.points})
    data = path.read_bytes()
    for end in np.linspace(0, len(data) - 9, 40).astype(int):
        path.write_bytes(data[:end])
        with pytest.raises(FormatError, match=f"m{suffix}"):
            formats.read(path)


@pytest.mark.parametrize("suffix", [".mesh", ".meshb", ".sol", ".solb", ".msh", ".vtu", ".nowhere"])
def test_noise_is_refused(tmp_path, suffix):
    path = tmp_path / f"m{suffix}"
    path.write_bytes(np.random.default_rng(0).integers(0, 256, 4000, np.uint8).tobytes())
    with pytest.raises(FormatError, match=f"m{suffix}"):
        formats.read(path)
    with pytest.raises(FormatError, match=f"m{suffix}"):
        formats.read_metric(path, square(1))


@pytest.mark.parametrize("suffix", [".mesh", ".meshb", ".msh", ".vtu"])
def test_damaged_bytes_never_raise_anything_else(tmp_path, suffix):
    path = tmp_path / f"m{suffix}"
    formats.write(path, square(2))
    data = np.frombuffer(path.read_bytes(), np.uint8)
    random = np.random.default_rng(1)
    refused = 0
    for _ in range(150):
        damaged = data.copy()
        damaged[random.integers(0, len(data), 3)] = random.integers(0, 256, 3)
        path.write_bytes(damaged.tobytes())
        try:
            formats.read(path)
        except FormatError:
            refused += 1
    assert refused > 30


@pytest.mark.parametrize("suffix", [".mesh", ".meshb", ".msh", ".vtu", ".xdmf"])
def test_a_missing_file_is_named(tmp_path, suffix):
    with pytest.raises(FormatError, match=f"cannot read .*m{suffix}: no such file"):
        formats.read(tmp_path / f"m{suffix}")


@pytest.mark.parametrize("suffix", [".mesh", ".meshb", ".msh", ".vtu", ".vtk", ".sol"])
def test_a_path_that_cannot_be_written_is_named_and_leaves_nothing(tmp_path, suffix):
    mesh = square(1)
    fields = {"u": np.zeros(4)}
    with pytest.raises(FormatError, match=f"cannot write .*m{suffix}: No such file or directory"):
        formats.write(tmp_path / "nowhere" / f"m{suffix}", mesh, fields)
    (tmp_path / f"m{suffix}").mkdir()
    with pytest.raises(FormatError, match=f"cannot write .*m{suffix}: it is a folder"):
        formats.write(tmp_path / f"m{suffix}", mesh, fields)
    assert [entry.name for entry in tmp_path.iterdir()] == [f"m{suffix}"]


def test_an_unknown_suffix_is_refused_and_leaves_nothing(tmp_path):
    with pytest.raises(FormatError, match=r"cannot write .*m\.nowhere: "):
        formats.write(tmp_path / "m.nowhere", square(1))
    assert list(tmp_path.iterdir()) == []


def test_an_error_of_meshio_names_the_path_and_not_the_temporary_one(tmp_path):
    with pytest.raises(FormatError) as caught:
        formats.write(tmp_path / "m.nowhere", square(1))
    assert "part" not in str(caught.value)


def test_a_failed_write_keeps_the_file_that_was_there(tmp_path):
    path = tmp_path / "m.sol"
    path.write_text("precious")
    skew = np.tile([[1.0, 2.0], [3.0, 4.0]], (4, 1, 1))
    with pytest.raises(FormatError, match="not symmetric"):
        formats.write(path, square(1), {"T": skew})
    assert path.read_text() == "precious"


def test_a_field_of_the_wrong_length_is_named_before_anything_is_written(tmp_path):
    with pytest.raises(ValueError, match="field 'u' has 3 values, the mesh has 4 points"):
        formats.write(tmp_path / "m.vtu", square(1), {"u": np.zeros(3)})
    assert list(tmp_path.iterdir()) == []


def test_a_solution_file_is_no_mesh(tmp_path):
    formats.write(tmp_path / "m.sol", square(1), {"u": np.zeros(4)})
    with pytest.raises(FormatError, match="a solution file holds no mesh"):
        formats.read(tmp_path / "m.sol")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "does not begin with MeshVersionFormatted"),
        ("MeshVersionFormatted 2\nVertices 0\nEnd\n", "it has no Dimension"),
        ("MeshVersionFormatted 2\nDimension 4\nEnd\n", "Dimension is 4"),
        (HEAD + "End\n", "it holds no vertices"),
        (HEAD + POINTS + CELLS, "truncated: the keyword End is missing"),
        (HEAD + POINTS.replace("\n4\n", "\n5\n") + CELLS + "End\n", "Vertices announces 5 rows"),
        (HEAD + POINTS + CELLS.replace("3 4", "3 x") + "End\n", "Triangles holds something"),
        (HEAD + POINTS + CELLS.replace("3 4", "3 4.5") + "End\n", "Triangles holds 4.5 where"),
        (HEAD + POINTS + CELLS.replace("3 4", "3 5") + "End\n", "triangle 1 refers to point 4"),
        (HEAD + POINTS + CELLS.replace("3 4", "3 0") + "End\n", "triangle 1 refers to point -1"),
        (HEAD + POINTS + "End\n", "the mesh is empty"),
        (HEAD + POINTS + "Triangles\n0\nEnd\n", "the mesh is empty"),
        (HEAD + POINTS + CELLS.replace("1 3 4", "3 2 1") + "End\n", "cell 1 repeats cell 0"),
        (HEAD + POINTS.replace("1 1 0", "NaN 1 0") + CELLS + "End\n", "point 2 has a non-finite"),
        (HEAD + POINTS.replace("1 1 0", "0.5 0 0") + CELLS + "End\n", "cell 0 has zero volume"),
        (HEAD + POINTS + "Quadrilaterals\n1\n1 3 2 4 0\nEnd\n", "is twisted or flat"),
        (HEAD + POINTS + CELLS + "Edges\n1\n2 4 3\nEnd\n", "facet 0 is not a facet of any cell"),
        (HEAD + POINTS + CELLS + "Corners\n1\n9\nEnd\n", "corner refers to point 8 of 4"),
        ("# anistar:names [1\n" + HEAD, "does not begin|a comment of anistar is not JSON"),
    ],
)
def test_a_bad_medit_file_is_refused_with_its_name_and_the_reason(tmp_path, content, message):
    (tmp_path / "m.mesh").write_text(content)
    with pytest.raises(FormatError, match=rf"m\.mesh: .*({message})"):
        formats.read(tmp_path / "m.mesh")


def test_overlapping_cells_in_a_file_are_refused(tmp_path):
    points = POINTS.replace("0 1 0\n", "0.8 0.1 0\n")
    (tmp_path / "m.mesh").write_text(HEAD + points + CELLS + "End\n")
    with pytest.raises(FormatError, match="both are on the same side of facet"):
        formats.read(tmp_path / "m.mesh")


def test_nothing_is_printed_when_meshio_gives_up(tmp_path, capsys):
    (tmp_path / "m.vtu").write_text("no xml")
    with pytest.raises(FormatError, match=r"cannot read .*m\.vtu"):
        formats.read(tmp_path / "m.vtu")
    assert capsys.readouterr() == ("", "")


def test_a_quote_in_a_gmsh_name_is_refused(tmp_path):
    with pytest.raises(FormatError, match="a quote or line break in the name"):
        formats.write(tmp_path / "m.msh", square(1), {'u"': np.zeros(4)})
