import numpy as np
import pytest
from meshes import annulus, rectangle_with_jitter, slit, square, two_region_cube, two_regions

from anistar import formats
from anistar.base.errors import FormatError
from anistar.meshes.fields import Field, as_fields
from anistar.meshes.mesh import Mesh
from anistar.meshes.validation import validate

NAMED = [".vtu", ".msh", ".mesh"]
ALL = [*NAMED, ".meshb", ".vtk"]
MAKERS = [two_regions, two_region_cube, slit, annulus]


def sample_fields(mesh):
    """Fields of every kind with random values, tensors symmetric, nothing diagonal."""
    draw = np.random.default_rng(7).normal
    fields = {}
    for on, count in (("points", mesh.n_points), ("cells", mesh.n_cells)):
        tensors = draw(size=(count, mesh.dim, mesh.dim))
        fields[f"u {on}"] = Field(draw(size=count), on)
        fields[f"v_{on}"] = Field(draw(size=(count, mesh.dim)), on)
        fields[f"T_{on}"] = Field(tensors + tensors.transpose(0, 2, 1), on)
        fields[f"k_{on}"] = Field(np.arange(count), on)
    return as_fields(mesh, fields)


def assert_same_arrays(got, expected):
    for name, array in expected.arrays().items():
        if name != "names":
            assert np.array_equal(getattr(got, name), array), name


@pytest.mark.parametrize("suffix", ALL)
@pytest.mark.parametrize("make", MAKERS)
def test_every_tag_comes_back(tmp_path, make, suffix):
    mesh = make()
    formats.write(tmp_path / f"m{suffix}", mesh)
    got, fields, report = formats.read_with_report(tmp_path / f"m{suffix}")
    assert_same_arrays(got, mesh)
    assert fields == {}
    assert report.warnings == ()
    assert validate(got) == []


@pytest.mark.parametrize("suffix", NAMED)
@pytest.mark.parametrize("make", MAKERS)
def test_every_name_comes_back(tmp_path, make, suffix):
    mesh = make()
    formats.write(tmp_path / f"m{suffix}", mesh)
    got, _ = formats.read(tmp_path / f"m{suffix}")
    assert got.names == mesh.names
    assert validate(got, mesh) == []


@pytest.mark.parametrize("suffix", [".meshb", ".vtk"])
def test_a_format_without_names_says_so(tmp_path, suffix, caplog):
    formats.write(tmp_path / f"m{suffix}", two_regions())
    assert "names" in caplog.text
    assert "this format does not carry" in caplog.text


@pytest.mark.parametrize("suffix", ALL)
@pytest.mark.parametrize("make", [two_regions, two_region_cube])
def test_every_field_comes_back_bit_by_bit(tmp_path, make, suffix):
    mesh = make()
    fields = sample_fields(mesh)
    if suffix in (".vtk", ".meshb"):  # neither keeps spaces in names, or names at all
        fields = {name.replace(" ", "_"): field for name, field in fields.items()}
    formats.write(tmp_path / f"m{suffix}", mesh, fields)
    got, back = formats.read(tmp_path / f"m{suffix}")
    assert validate(got) == []
    if suffix == ".meshb":  # binary solutions have neither names nor labels
        on_points = [f for f in fields.values() if f.on == "points"]
        assert [name for name in back if "cells" not in name] == [
            f"field{i}" for i in range(len(on_points))
        ]
        expected = [*on_points, *(f for f in fields.values() if f.on == "cells")]
        for found, field in zip(back.values(), expected, strict=True):
            assert np.array_equal(found.values, field.values)
        return
    assert back.keys() == fields.keys()
    for name, field in fields.items():
        assert np.array_equal(back[name].values, field.values), name
        assert (back[name].on, back[name].kind) == (field.on, field.kind), name


def test_xdmf_comes_back_without_its_corners(tmp_path):
    mesh, fields = two_region_cube(), sample_fields(two_region_cube())
    formats.write(tmp_path / "m.xdmf", mesh, fields)
    got, back = formats.read(tmp_path / "m.xdmf")
    assert np.array_equal(got.facet_tags, mesh.facet_tags)
    assert np.array_equal(got.edge_tags, mesh.edge_tags)
    assert np.array_equal(back["T_points"].values, fields["T_points"].values)
    assert [path.name for path in tmp_path.iterdir()] == ["m.xdmf"]
    assert validate(got) == []


@pytest.mark.parametrize("suffix", ALL)
def test_writing_twice_gives_the_same_bytes(tmp_path, suffix):
    mesh = two_regions()
    written = []
    for _ in range(2):
        formats.write(tmp_path / f"m{suffix}", mesh, {"u": mesh.points[:, 0]})
        written.append((tmp_path / f"m{suffix}").read_bytes())
    assert written[0] == written[1]


@pytest.mark.parametrize("suffix", [".sol", ".solb", ".vtu", ".msh"])
@pytest.mark.parametrize("make", [square, two_region_cube])
def test_a_metric_comes_back(tmp_path, make, suffix):
    mesh = make()
    root = np.random.default_rng(3).normal(size=(mesh.n_points, mesh.dim, mesh.dim))
    metric = root @ root.transpose(0, 2, 1)
    metric = (metric + metric.transpose(0, 2, 1)) / 2 + np.eye(mesh.dim)
    formats.write_metric(tmp_path / f"m{suffix}", mesh, metric)
    assert np.array_equal(formats.read_metric(tmp_path / f"m{suffix}", mesh), metric)


def test_a_scalar_solution_read_as_metric_means_sizes(tmp_path):
    mesh = square(2)
    formats.write(tmp_path / "m.sol", mesh, {"h": np.full(9, 0.25)})
    metric = formats.read_metric(tmp_path / "m.sol", mesh)
    assert np.array_equal(metric, np.broadcast_to(16 * np.eye(2), (9, 2, 2)))


def test_a_size_that_is_not_positive_is_named(tmp_path):
    mesh = square(2)
    sizes = np.ones(9)
    sizes[4] = -1
    formats.write(tmp_path / "m.sol", mesh, {"h": sizes})
    with pytest.raises(formats.FormatError, match="the size at point 4 is -1, not positive"):
        formats.read_metric(tmp_path / "m.sol", mesh)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"a": np.ones(9), "b": np.ones(9)}, "a metric is one field at the points, not 2"),
        ({"a": np.ones((9, 2))}, "'a' is not a 2 x 2 tensor field"),
    ],
)
def test_a_solution_that_is_no_metric_is_refused(tmp_path, fields, message):
    formats.write(tmp_path / "m.sol", square(2), fields)
    with pytest.raises(formats.FormatError, match=message):
        formats.read_metric(tmp_path / "m.sol", square(2))


def test_a_metric_of_another_length_is_refused(tmp_path):
    formats.write(tmp_path / "m.sol", square(2), {"h": np.ones(9)})
    with pytest.raises(formats.FormatError, match="has 9 values, the mesh has 16 points"):
        formats.read_metric(tmp_path / "m.sol", square(3))


def test_a_full_tensor_is_refused_by_a_symmetric_format(tmp_path):
    tensors = np.tile([[1.0, 2.0], [3.0, 4.0]], (9, 1, 1))
    with pytest.raises(formats.FormatError, match=r"cannot write field 'T' to .*not symmetric"):
        formats.write(tmp_path / "m.sol", square(2), {"T": tensors})
    formats.write(tmp_path / "m.vtu", square(2), {"T": tensors})
    assert np.array_equal(formats.read(tmp_path / "m.vtu")[1]["T"].values, tensors)


def test_vtk_itself_reads_what_is_written(tmp_path):
    reader_module = pytest.importorskip("vtkmodules.vtkIOXML")
    mesh = two_region_cube()
    metric = np.tile([[1, 0.12, 0.13], [0.12, 2, 0.23], [0.13, 0.23, 3]], (mesh.n_points, 1, 1))
    formats.write_metric(tmp_path / "m.vtu", mesh, metric)
    reader = reader_module.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(tmp_path / "m.vtu"))
    reader.Update()
    grid = reader.GetOutput()
    assert grid.GetPointData().GetArray("metric").GetTuple(5) == tuple(metric[0].ravel())
    assert grid.GetCellData().GetArray("medit:ref").GetRange() == (0.0, 7.0)
    assert grid.GetNumberOfPoints() == mesh.n_points


@pytest.mark.parametrize("suffix", ALL)
def test_a_mesh_without_tags_stays_without(tmp_path, suffix):
    mesh = rectangle_with_jitter(3)
    formats.write(tmp_path / f"m{suffix}", mesh)
    assert_same_arrays(formats.read(tmp_path / f"m{suffix}")[0], mesh)


def test_negative_and_large_tags_come_back(tmp_path):
    base = square(2)
    mesh = Mesh(**{**base.arrays(), "facet_tags": base.facet_tags * -100_000, "names": {}})
    for suffix in ALL:
        formats.write(tmp_path / f"m{suffix}", mesh)
        assert_same_arrays(formats.read(tmp_path / f"m{suffix}")[0], mesh)


@pytest.mark.parametrize("suffix", [".vtu", ".vtk", ".xdmf", ".msh", ".mesh"])
@pytest.mark.parametrize("name", ["refs", "cell_tags", "größe", "a<b>&'"])
def test_a_field_may_be_called_what_other_programs_call_tags(tmp_path, suffix, name):
    mesh = square(2)
    path = tmp_path / f"m{suffix}"
    values = np.arange(mesh.n_cells) + 0.5
    formats.write(path, mesh, {name: Field(values, "cells")})
    again, fields = formats.read(path)
    assert np.array_equal(fields[name].values, values)
    assert np.array_equal(again.cell_tags, mesh.cell_tags)


@pytest.mark.parametrize("suffix", [".vtu", ".vtk", ".xdmf"])
@pytest.mark.parametrize("name", ["medit:ref", "gmsh:physical", "anistar:names"])
def test_a_field_that_would_be_taken_for_tags_is_refused(tmp_path, suffix, name):
    mesh = square(2)
    path = tmp_path / f"m{suffix}"
    with pytest.raises(FormatError, match=f"'{name}' is no name for a field"):
        formats.write(path, mesh, {name: mesh.points[:, 0]})
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", [".VTU", ".MESH", ".MeshB", ".MSH"])
def test_a_suffix_in_capitals_is_the_same_format(tmp_path, suffix):
    mesh = square(2)
    path = tmp_path / f"m{suffix}"
    formats.write(path, mesh, {"u": mesh.points[:, 0]})
    again, fields = formats.read(path)
    assert np.array_equal(again.points, mesh.points)
    assert [field.values.tolist() for field in fields.values()] == [mesh.points[:, 0].tolist()]


def test_each_medit_mesh_takes_the_solution_of_its_own_encoding(tmp_path):
    mesh = square(2)
    u = mesh.points[:, 0]
    formats.write(tmp_path / "m.meshb", mesh, {"u": 2 * u})
    formats.write(tmp_path / "m.mesh", mesh, {"u": u})
    for suffix, factor in ((".mesh", 1), (".meshb", 2)):
        _, fields = formats.read(tmp_path / f"m{suffix}")
        (field,) = fields.values()
        assert np.array_equal(field.values, factor * u)


def test_a_solution_left_beside_a_new_mesh_is_told(tmp_path, caplog):
    mesh = square(2)
    formats.write(tmp_path / "m.mesh", mesh, {"u": mesh.points[:, 0]})
    assert caplog.messages == []
    formats.write(tmp_path / "m.mesh", mesh)
    assert "m.sol is left from before and will be read with it" in caplog.text
