"""Files as other programs write them are read to the last bit that they hold."""

import re

import numpy as np
import pytest
from foreign_files import GMSH, MESHIO, gmsh_4, sample, write_with_meshio
from meshes import square, two_region_cube, two_regions

from anistar import Field, Mesh, formats
from anistar.base.errors import FormatError
from anistar.meshes.validation import validate

MAKERS = [two_regions, two_region_cube]


def order_of_cells(mesh):
    """The order of the cells where each tag has a block of its own."""
    return np.argsort(mesh.cell_tags, kind="stable")


def assert_same(path, mesh, order, *, digits=15):
    got, fields, report = formats.read_with_report(path)
    rounding = 10.0**-digits
    on_points, on_cells = sample(mesh)
    assert validate(got) == []
    assert np.allclose(got.points, mesh.points, rtol=rounding, atol=rounding)
    assert np.array_equal(got.cells, mesh.cells[order])
    assert np.array_equal(got.cell_tags, mesh.cell_tags[order])
    assert sorted(map(tuple, got.facets.tolist())) == sorted(map(tuple, mesh.facets.tolist()))
    assert np.array_equal(np.sort(got.facet_tags), np.sort(mesh.facet_tags))
    assert np.allclose(fields["u"].values, on_points["u"], rtol=rounding, atol=rounding)
    assert np.allclose(fields["v"].values, on_points["v"], rtol=rounding, atol=rounding)
    assert np.allclose(fields["k"].values, on_cells["k"][order], rtol=rounding, atol=rounding)
    return report


@pytest.mark.parametrize("make", MAKERS)
@pytest.mark.parametrize("kind", GMSH)
def test_gmsh_4_in_text_and_binary(tmp_path, make, kind):
    mesh = make()
    path = tmp_path / "m.msh"
    path.write_bytes(gmsh_4(mesh, kind))
    report = assert_same(path, mesh, order_of_cells(mesh))
    assert report.warnings == ()
    assert formats.read(path)[0].names == mesh.names


GMSH_REVERSED = """$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
1 3 "bottom"
2 2 "plate"
$EndPhysicalNames
$Entities
0 1 1 0
1 0 0 0 1 0 0 1 -3 0
1 0 0 0 1 1 0 1 -2 1 1
$EndEntities
$Nodes
1 3 1 3
2 1 0 3
1
2
3
0 0 0
1 0 0
1 1 0
$EndNodes
$Elements
2 2 1 2
1 1 1 1
1 1 2
2 1 2 1
2 1 2 3
$EndElements
"""


def test_groups_of_gmsh_may_have_their_entities_the_other_way_round(tmp_path):
    (tmp_path / "m.msh").write_text(GMSH_REVERSED)
    mesh = formats.read(tmp_path / "m.msh")[0]
    assert mesh.cell_tags.tolist() == [2]
    assert np.count_nonzero(mesh.facet_tags == 3) == 1
    assert mesh.names == {(1, 3): "bottom", (2, 2): "plate"}


@pytest.mark.parametrize("make", MAKERS)
@pytest.mark.parametrize("kind", MESHIO)
def test_what_meshio_writes(tmp_path, make, kind):
    mesh = make()
    path = tmp_path / f"m{MESHIO[kind][0]}"
    write_with_meshio(path, mesh, kind)
    # its text has twelve digits in VTU
    report = assert_same(path, mesh, np.arange(mesh.n_cells), digits=11 if "text" in kind else 15)
    is_told = ["no mark at its end" in warning for warning in report.warnings]
    assert is_told == ([True] if path.suffix == ".vtk" else [])


@pytest.mark.parametrize("mode", ["Ascii", "Binary", "Appended", "AppendedRaw"])
@pytest.mark.parametrize("compressor", ["None", "ZLib", "LZMA"])
@pytest.mark.parametrize("make", MAKERS)
def test_what_vtk_writes_in_xml(tmp_path, make, mode, compressor):
    io = pytest.importorskip("vtkmodules.vtkIOXML")
    from anistar.adapters.vtk import to_vtk

    mesh = make()
    on_points, on_cells = sample(mesh)
    fields = {**on_points, "k": Field(on_cells["k"], "cells")}
    writer = io.vtkXMLUnstructuredGridWriter()
    writer.SetInputData(to_vtk(mesh, fields))
    writer.SetFileName(str(tmp_path / "m.vtu"))
    getattr(writer, f"SetDataModeTo{mode.removesuffix('Raw')}")()
    writer.SetEncodeAppendedData(not mode.endswith("Raw"))
    getattr(writer, f"SetCompressorTypeTo{compressor}")()
    writer.SetHeaderTypeToUInt32()
    writer.Write()
    got, back, report = formats.read_with_report(tmp_path / "m.vtu")
    assert np.array_equal(got.points, mesh.points)
    assert validate(got, mesh) == []
    assert np.array_equal(back["v"].values, on_points["v"])
    assert np.array_equal(back["k"].values, on_cells["k"])
    assert report.warnings == ()


@pytest.mark.parametrize("is_text", [True, False])
@pytest.mark.parametrize("version", [42, 51])
def test_what_vtk_writes_in_its_legacy_format(tmp_path, version, is_text):
    io = pytest.importorskip("vtkmodules.vtkIOLegacy")
    from anistar.adapters.vtk import to_vtk

    mesh = two_region_cube()
    on_points, _ = sample(mesh)
    writer = io.vtkUnstructuredGridWriter()
    writer.SetInputData(to_vtk(mesh, on_points))
    writer.SetFileName(str(tmp_path / "m.vtk"))
    writer.SetFileVersion(version)
    writer.SetFileTypeToASCII() if is_text else writer.SetFileTypeToBinary()
    writer.Write()
    got, back = formats.read(tmp_path / "m.vtk")
    assert {violation.kind for violation in validate(got, mesh)} <= {"names"}
    assert np.allclose(got.points, mesh.points)
    assert np.allclose(back["v"].values, on_points["v"])


def grid(mesh):
    """What VTK's legacy writer takes, and the function that has it write a file."""
    io = pytest.importorskip("vtkmodules.vtkIOLegacy")
    from anistar.adapters.vtk import to_vtk

    content = to_vtk(mesh, {"v": Field(mesh.points + 1), "u": Field(mesh.points[:, 0])})

    def write(path, *, is_text):
        writer = io.vtkUnstructuredGridWriter()
        writer.SetInputData(content)
        writer.SetFileName(str(path))
        writer.SetFileTypeToASCII() if is_text else writer.SetFileTypeToBinary()
        assert writer.Write() == 1

    return content, write


@pytest.mark.parametrize("is_text", [True, False])
def test_an_array_may_come_twice_in_legacy_vtk_if_it_is_the_same(tmp_path, is_text):
    mesh = two_region_cube()
    content, write = grid(mesh)
    content.GetPointData().SetActiveVectors("v")
    content.GetPointData().SetActiveScalars("v")
    path = tmp_path / "m.vtk"
    write(path, is_text=is_text)
    assert path.read_bytes().count(b" v double") == 2
    assert np.allclose(formats.read(path)[1]["v"].values, mesh.points + 1)
    data = path.read_bytes()
    path.write_bytes(data.replace(b"SCALARS u", b"SCALARS v").replace(b"\nu 1 ", b"\nv 1 "))
    with pytest.raises(FormatError, match="two different arrays 'v'"):
        formats.read(path)


@pytest.mark.parametrize("is_text", [True, False])
def test_what_is_no_field_in_legacy_vtk_is_told(tmp_path, is_text):
    mesh = two_region_cube()
    content, write = grid(mesh)
    core = pytest.importorskip("vtkmodules.vtkCommonCore")
    on_points, on_cells = content.GetPointData(), content.GetCellData()

    def add(kind, name, n, to, *, width=1, value=1):
        array = kind()
        array.SetName(name)
        array.SetNumberOfComponents(width)
        for i in range(n * width):
            array.InsertNextValue(value(i) if callable(value) else value)
        to(array)

    n, m = mesh.n_points, content.GetNumberOfCells()
    strings = ["", "a b", 70 * "c", 20_000 * "d"]
    add(
        core.vtkStringArray,
        "of the file",
        4,
        content.GetFieldData().AddArray,
        value=lambda i: strings[i],
    )
    add(core.vtkIdTypeArray, "ids", n, on_points.SetGlobalIds)
    add(core.vtkUnsignedCharArray, "rgb", n, on_points.SetScalars, width=3, value=9)
    add(core.vtkDoubleArray, "my places", n, on_points.SetTCoords, width=2)
    add(core.vtkStringArray, "words", m, on_cells.AddArray, value=lambda i: strings[i % 4])
    add(core.vtkBitArray, "bits", m, on_cells.AddArray, value=lambda i: int(i % 3 == 0))
    add(core.vtkDoubleArray, "50% of it", m, on_cells.AddArray, value=float)
    path = tmp_path / "m.vtk"
    write(path, is_text=is_text)
    for blank_line in (b"", b"\n"):
        path.write_bytes(path.read_bytes().replace(b"DATASET", blank_line + b"DATASET", 1))
        got, fields, report = formats.read_with_report(path)
        assert got.n_cells == mesh.n_cells
        assert fields.keys() == {"u", "v", "bits", "50% of it"}
        places = fields["50% of it"].values
        assert np.array_equal(places, places[0] + np.arange(mesh.n_cells))
        assert np.array_equal(fields["bits"].values, places % 3 == 0)
        assert np.allclose(fields["v"].values, mesh.points + 1)
        told = "CELL_DATA words, POINT_DATA rgb, POINT_DATA my places, POINT_DATA ids"
        assert f"no field and not read: the array {told}" in report.warnings


def test_information_may_come_before_the_numbers_of_an_array(tmp_path):
    mesh = square(1)
    path = tmp_path / "m.vtu"
    formats.write(path, mesh, {"u": mesh.points[:, 0]})
    key = '<InformationKey name="L2" location="x" length="1"><Value index="0">3</Value>'
    text, n = re.subn(r"(<DataArray[^>]*[^/]>)", rf"\1 {key}</InformationKey>", path.read_text())
    assert n > 4
    path.write_text(text)
    got, fields = formats.read(path)
    assert np.array_equal(got.cells, mesh.cells)
    assert np.array_equal(fields["u"].values, mesh.points[:, 0])


def test_pieces_are_put_together(tmp_path):
    mesh = square(2)
    path = tmp_path / "m.vtu"
    formats.write(path, mesh, {"u": mesh.points[:, 0]})
    text = path.read_text()
    start, end = text.index("<Piece"), text.index("</UnstructuredGrid>")
    formats.write(path, Mesh(points=mesh.points + 2, cells=mesh.cells), {"u": mesh.points[:, 1]})
    other = path.read_text()
    piece = other[other.index("<Piece") : other.index("</UnstructuredGrid>")]
    path.write_text(text[:end] + piece + text[end:])
    got, fields = formats.read(path)
    assert text[start:end] != piece
    assert got.n_points == 2 * mesh.n_points
    assert np.array_equal(got.cells[mesh.n_cells :], mesh.cells + mesh.n_points)
    assert fields["u"].values.tolist() == [*mesh.points[:, 0], *mesh.points[:, 1]]
    assert validate(got) == []
    path.write_text(text[:end] + piece.replace('Name="u"', 'Name="w"') + text[end:])
    _, fields, report = formats.read_with_report(path)
    assert fields == {}
    assert "not in all pieces and not read: the array u, w" in report.warnings


@pytest.mark.parametrize("make", MAKERS)
def test_su2_keeps_what_it_can_hold(tmp_path, make):
    mesh = make()
    formats.write(tmp_path / "m.su2", mesh)
    got, _, report = formats.read_with_report(tmp_path / "m.su2")
    tags = np.unique(mesh.facet_tags)
    names = {mesh.names.get((mesh.dim - 1, tag), str(tag)) for tag in tags.tolist()}
    assert np.array_equal(got.cells, mesh.cells)
    assert np.array_equal(got.points, mesh.points)
    assert {got.names.get((mesh.dim - 1, t), str(t)) for t in got.facet_tags.tolist()} == names
    assert report.warnings == ()
    assert validate(got) == []


@pytest.mark.parametrize("precision", ["", 'Precision="4"', 'Precision="8"'])
def test_all_digits_of_xdmf_are_read(tmp_path, precision):
    path = tmp_path / "m.xdmf"
    path.write_text(
        f"""<Xdmf><Domain><Grid>
        <Geometry GeometryType="XY"><DataItem Dimensions="3 2" {precision}>
        0 0 1.123456789012 0 0 1</DataItem></Geometry>
        <Topology TopologyType="Triangle"><DataItem Dimensions="1 3" NumberType="Int">
        0 1 2</DataItem></Topology></Grid></Domain></Xdmf>"""
    )
    assert formats.read(path)[0].points[1, 0] == 1.123456789012


def test_xdmf_may_name_its_dtd(tmp_path):
    mesh = two_regions()
    path = tmp_path / "m.xdmf"
    formats.write(path, mesh)
    text = path.read_text()
    head = '<?xml version="1.0" ?>\n<!DOCTYPE Xdmf SYSTEM "Xdmf.dtd" []>\n'
    path.write_text(head + text[text.index("<Xdmf") :])
    assert np.array_equal(formats.read(path)[0].cells, mesh.cells)


ABAQUS = """*HEADING
** a comment
*NODE
10, 0, 0
20, 1, 0
30, 1, 1
40, 0, 1
*ELEMENT, TYPE=CPS3, ELSET=all
1, 10, 20, 30
2, 10, 30,
40
*ELEMENT, TYPE=T2D2
7, 10, 20
*ELSET, ELSET=upper
2
*ELSET, ELSET=wall, GENERATE
7, 7, 1
"""


def test_capitals_do_not_count_in_sets_of_abaqus(tmp_path):
    text = ABAQUS.replace("*ELSET, ELSET=wall", "*ELSET, ELSET=half\nUpper\n*ELSET, ELSET=wall")
    more = "*ELSET, ELSET=Wall\n1\n"
    (tmp_path / "m.inp").write_text(text.replace("*NODE", "*NODE, SYSTEM=r") + more)
    mesh, _, report = formats.read_with_report(tmp_path / "m.inp")
    assert mesh.cell_tags.tolist() == [4, 3]
    assert mesh.names[2, 3] == "half"
    assert mesh.names[1, 4] == mesh.names[2, 4] == "wall"
    assert "Wall" not in mesh.names.values()
    assert (
        "capitals do not count in names of sets, the first spelling is kept: 'wall' of 'Wall'"
        in report.warnings
    )


def test_sets_of_abaqus_are_tags_and_the_last_one_counts(tmp_path):
    (tmp_path / "m.inp").write_text(ABAQUS)
    mesh, _, report = formats.read_with_report(tmp_path / "m.inp")
    assert mesh.cells.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert mesh.cell_tags.tolist() == [1, 2]
    assert mesh.facet_tags[0] == 3
    assert mesh.names == {(2, 1): "all", (2, 2): "upper", (1, 3): "wall"}
    assert report.warnings[0] == "1 element(s) are in several sets, the last one is kept"
    assert "a file that was cut cannot be told: 4 points and 3 elements" in report.warnings[1]
    assert validate(mesh) == []
