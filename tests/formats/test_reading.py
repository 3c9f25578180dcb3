import struct

import meshio
import numpy as np
import pytest
from meshes import cube, square, two_regions

from anistar import formats
from anistar.meshes.validation import validate

MEDIT = """# made by hand
MeshVersionFormatted
2
Dimension 3
Vertices 5  # count on the same line
0 0 0 1
1 0 0 1
0 1 0 1
0 0 1 2
1 1 1 2
Tetrahedra
2
1 2 3 4 5
2 3 4 5 6
Triangles 1
1 3 2 7
Edges 1
1 2 9
RequiredEdges 1
1
RequiredVertices
1
2
Normals
1
0.0 0.0 1e-3
NormalAtVertices 1
1 1
Corners
2
1 4
Ridges 1
1
SomethingNew 2
1.5e+3 NaN
End
"""


def test_a_text_mesh_with_comments_and_unknown_keywords_is_read(tmp_path):
    (tmp_path / "m.mesh").write_text(MEDIT)
    mesh, fields, report = formats.read_with_report(tmp_path / "m.mesh")
    assert mesh.n_cells == 2
    assert mesh.cell_tags.tolist() == [5, 6]
    assert mesh.facet_tags[0] == 7
    assert mesh.edges.tolist() == [[0, 1]]
    assert mesh.edge_tags.tolist() == [9]
    assert mesh.corners.tolist() == [0, 1, 3]
    assert fields == {}
    assert report.warnings == ("not known and not read: the section SomethingNew",)
    assert validate(mesh) == []


def binary(version, order="<"):
    """A unit square of two triangles with an unknown keyword 126, in any version."""
    real = "f" if version == 1 else "d"
    index, count = ("q", "q") if version == 4 else ("i", "i")
    offset = "q" if version >= 3 else "i"
    records = [
        (126, struct.pack(f"{order}{count}ii", 2, 3, 4)),
        (4, struct.pack(f"{order}{count}", 4) + b"".join(
            struct.pack(f"{order}{real}{real}{index}", x, y, 0)
            for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))
        )),
        (6, struct.pack(f"{order}{count}8{index}", 2, 1, 2, 3, 8, 1, 3, 4, 9)),
    ]  # fmt: skip
    start = 12 + struct.calcsize(f"={offset}") + 4
    out = struct.pack(f"{order}iii{offset}i".replace(" ", ""), 1, version, 3, start, 2)
    for code, payload in records:
        start += 4 + struct.calcsize(f"={offset}") + len(payload)
        out += struct.pack(f"{order}i{offset}", code, start) + payload
    return out + struct.pack(f"{order}i{offset}", 54, 0)


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("version", [1, 2, 3, 4])
def test_binary_meshes_of_every_version_are_read(tmp_path, version, order):
    (tmp_path / "m.meshb").write_bytes(binary(version, order))
    mesh, _ = formats.read(tmp_path / "m.meshb")
    assert mesh.points.tolist() == [[0, 0], [1, 0], [1, 1], [0, 1]]
    assert mesh.cells.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert mesh.cell_tags.tolist() == [8, 9]
    assert validate(mesh) == []


def test_the_written_binary_version_is_two(tmp_path):
    formats.write(tmp_path / "m.meshb", square(1))
    assert struct.unpack("<ii", (tmp_path / "m.meshb").read_bytes()[:8]) == (1, 2)


def test_tensors_in_a_solution_file_are_rows_of_the_lower_triangle(tmp_path):
    (tmp_path / "m.mesh").write_text(MEDIT)
    row = "1 .12 2 .13 .23 3\n"
    head = "MeshVersionFormatted 2 Dimension 3 SolAtVertices 5 1 3\n"
    (tmp_path / "m.sol").write_text(head + 5 * row)
    mesh, fields = formats.read(tmp_path / "m.mesh")
    expected = [[1, 0.12, 0.13], [0.12, 2, 0.23], [0.13, 0.23, 3]]
    assert fields["field0"].values[2].tolist() == expected
    assert formats.read_metric(tmp_path / "m.sol", mesh)[4].tolist() == expected


def test_several_fields_of_a_solution_file_are_interleaved(tmp_path):
    formats.write(tmp_path / "m.mesh", square(1))
    head = "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n4\n3 1 2 3\n"
    rows = "".join(f"{i} {i}.1 {i}.2 {i}.3 {i}.4 {i}.5\n" for i in range(1, 5))
    (tmp_path / "m.sol").write_text(head + rows + "End\n")
    _, fields = formats.read(tmp_path / "m.mesh")
    assert fields["field0"].values.tolist() == [1, 2, 3, 4]
    assert fields["field1"].values[1].tolist() == [2.1, 2.2]
    assert fields["field2"].values[2].tolist() == [[3.3, 3.4], [3.4, 3.5]]


def test_a_solution_of_another_length_is_not_taken_for_fields(tmp_path):
    formats.write(tmp_path / "m.mesh", square(1))
    formats.write(tmp_path / "m.sol", square(2), {"u": np.zeros(9)})
    _, fields, report = formats.read_with_report(tmp_path / "m.mesh")
    assert fields == {}
    assert report.warnings == ("m.sol is not used: it has another number of points",)


def written(path, points, cells, **options):
    """Write cells of any kind, which anistar itself would not."""
    meshio.Mesh(np.asarray(points, float), cells, **options).write(path)
    return path


@pytest.mark.parametrize("make", [square, cube])
def test_inverted_cells_are_turned_and_counted(tmp_path, make, caplog):
    mesh = make(2)
    cells = mesh.cells.copy()
    cells[[1, 4], :2] = cells[[1, 4], 1::-1]
    kind = "triangle" if mesh.dim == 2 else "tetra"
    points = np.pad(mesh.points, ((0, 0), (0, 3 - mesh.dim)))
    path = written(tmp_path / "m.vtu", points, [(kind, cells)])
    got, _, report = formats.read_with_report(path)
    assert report.flipped_cells == 2
    assert "2 inverted cell(s) flipped, the first is cell 1" in report.warnings
    assert "2 inverted cell(s) flipped" in caplog.text
    assert report.as_dict()["flipped_cells"] == 2
    assert validate(got) == []


def test_points_without_a_cell_are_dropped_with_their_values(tmp_path):
    mesh = square(1)
    points = np.pad(np.insert(mesh.points, 2, [7, 7], axis=0), ((0, 0), (0, 1)))
    points[2, 2] = 5  # a stray point off the plane does not make it a surface
    cells = np.where(mesh.cells >= 2, mesh.cells + 1, mesh.cells)
    values = {"u": np.arange(5.0)}
    path = written(tmp_path / "m.vtu", points, [("triangle", cells)], point_data=values)
    got, fields, report = formats.read_with_report(path)
    assert fields["u"].values.tolist() == [0, 1, 3, 4]
    assert report.dropped_points == 1
    assert report.warnings == ("1 point(s) without a cell dropped, the first is point 2",)
    assert validate(got) == []


@pytest.mark.parametrize("suffix", [".vtu", ".vtk"])
def test_a_file_of_points_alone_is_refused(tmp_path, suffix):
    path = written(tmp_path / f"m{suffix}", [[0, 0, 0]], [("vertex", [[0]])])
    with pytest.raises(formats.FormatError, match="the mesh is empty"):
        formats.read(path)


def test_cell_sets_become_tags_with_names(tmp_path):
    mesh = two_regions(2)
    sets = {"west": [mesh.cell_tags == 1], "east": [mesh.cell_tags == 2]}
    sets = {name: [np.flatnonzero(mask[0])] for name, mask in sets.items()}
    content = meshio.Mesh(
        np.pad(mesh.points, ((0, 0), (0, 1))), [("triangle", mesh.cells)], cell_sets=sets
    )
    content.write(tmp_path / "m.inp")
    got, _ = formats.read(tmp_path / "m.inp")
    assert np.array_equal(got.cell_tags, mesh.cell_tags)
    assert got.names == {(2, 1): "west", (2, 2): "east"}
    assert validate(got) == []


GMSH_4 = """$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
1 5 "wall"
2 6 "air"
$EndPhysicalNames
$Entities
0 1 1 0
1 0 0 0 1 0 0 1 5 0
1 0 0 0 1 1 0 1 6 0
$EndEntities
$Nodes
1 3 1 3
2 1 0 3
1
2
3
0 0 0
1 0 0
0 1 0
$EndNodes
$Elements
2 2 1 2
1 1 1 1
1 1 2
2 1 2 1
2 1 2 3
$EndElements
"""


def test_gmsh_4_has_physical_names(tmp_path):
    (tmp_path / "m.msh").write_text(GMSH_4)
    mesh, _ = formats.read(tmp_path / "m.msh")
    assert mesh.names == {(1, 5): "wall", (2, 6): "air"}
    assert mesh.cell_tags.tolist() == [6]
    assert mesh.facet_tags.tolist() == [5, 0, 0]
    assert validate(mesh) == []


def test_one_name_may_be_used_in_two_dimensions(tmp_path):
    (tmp_path / "m.msh").write_text(GMSH_4.replace("wall", "air"))
    mesh, _ = formats.read(tmp_path / "m.msh")
    assert mesh.names == {(1, 5): "air", (2, 6): "air"}
    formats.write(tmp_path / "n.msh", mesh)
    assert formats.read(tmp_path / "n.msh")[0].names == mesh.names


def test_gmsh_data_on_some_elements_goes_by_number(tmp_path):
    (tmp_path / "m.msh").write_text(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
        "$Nodes\n4\n10 0 0 0\n20 1 0 0\n30 1 1 0\n40 0 1 0\n$EndNodes\n"
        "$Elements\n3\n7 1 2 3 1 10 20\n9 2 2 4 1 10 20 30\n8 2 2 4 1 10 30 40\n$EndElements\n"
        '$ElementData\n1\n"k"\n1\n0.0\n3\n0\n1\n2\n8 80\n9 90\n$EndElementData\n'
        '$NodeData\n1\n"u"\n1\n0.0\n3\n0\n1\n4\n40 4\n30 3\n20 2\n10 1\n$EndNodeData\n'
    )
    mesh, fields = formats.read(tmp_path / "m.msh")
    assert fields["k"].values.tolist() == [90, 80]
    assert fields["u"].values.tolist() == [1, 2, 3, 4]
    assert mesh.facet_tags.tolist() == [3, 0, 0, 0]
    assert validate(mesh) == []


@pytest.mark.parametrize(("tags", "warned"), [((3, 3), 0), ((3, 5), 1)])
def test_a_facet_given_twice_counts_once(tmp_path, tags, warned):
    (tmp_path / "m.mesh").write_text(
        "MeshVersionFormatted 2\nDimension 2\nVertices\n3\n0 0 0\n1 0 0\n0 1 0\n"
        f"Triangles\n1\n1 2 3 0\nEdges\n2\n1 2 {tags[0]}\n2 1 {tags[1]}\nEnd\n"
    )
    mesh, _, report = formats.read_with_report(tmp_path / "m.mesh")
    assert mesh.facet_tags.tolist() == [3, 0, 0]
    assert report.repeated_facets == 1
    assert len(report.warnings) == warned
    assert validate(mesh) == []


@pytest.mark.parametrize("suffix", [".vtu", ".vtk"])
def test_six_components_are_in_the_order_of_vtk(tmp_path, suffix):
    mesh = cube(1)
    six = np.tile([1, 2, 3, 0.12, 0.23, 0.13], (8, 1))
    data = {"M": six}
    path = written(tmp_path / f"m{suffix}", mesh.points, [("tetra", mesh.cells)], point_data=data)
    expected = [[1, 0.12, 0.13], [0.12, 2, 0.23], [0.13, 0.23, 3]]
    assert formats.read(path)[1]["M"].values[3].tolist() == expected


def test_arrays_of_any_width_become_scalars(tmp_path):
    mesh = cube(1)
    data = {"Y": np.arange(40.0).reshape(8, 5)}
    path = written(tmp_path / "m.vtu", mesh.points, [("tetra", mesh.cells)], point_data=data)
    fields = formats.read(path)[1]
    assert list(fields) == [f"Y_{i}" for i in range(5)]
    assert fields["Y_3"].values[2] == 13


def test_columns_that_are_called_as_another_array_are_refused(tmp_path):
    mesh = cube(1)
    data = {"Y": np.arange(40.0).reshape(8, 5), "Y_3": np.ones(8)}
    path = written(tmp_path / "m.vtu", mesh.points, [("tetra", mesh.cells)], point_data=data)
    with pytest.raises(formats.FormatError, match=r"m\.vtu: it has two fields 'Y_3'"):
        formats.read(path)


def test_blank_lines_and_marks_of_editors_do_no_harm(tmp_path):
    mesh = square(1)
    for suffix in (".mesh", ".msh", ".su2"):
        path = tmp_path / f"m{suffix}"
        formats.write(path, mesh)
        text = path.read_text()
        for changed in (text.replace("\n", "\r\n"), text.replace("\n", " \n\n"), "\ufeff" + text):
            path.write_text(changed, encoding="utf-8", newline="")
            assert np.array_equal(formats.read(path)[0].points, mesh.points)


def test_the_last_step_of_gmsh_data_counts_and_is_told(tmp_path):
    data = '$NodeData\n1\n"u"\n1\n0.0\n3\n{}\n1\n3\n1 {}\n2 0\n3 0\n$EndNodeData\n'
    path = tmp_path / "m.msh"
    path.write_text(GMSH_4 + data.format(1, 5) + data.format(3, 7) + data.format(2, 6))
    _, fields, report = formats.read_with_report(path)
    assert fields["u"].values.tolist() == [7, 0, 0]
    assert report.warnings == ("1 field(s) have several steps, the last one is kept",)
    path.write_text(GMSH_4 + data.format(1, 5) + data.format(1, 6))
    with pytest.raises(
        formats.FormatError, match=r"m\.msh: the data 'u' are given twice for step 1"
    ):
        formats.read(path)


def test_an_entity_in_several_groups_has_the_tag_of_the_first(tmp_path):
    path = tmp_path / "m.msh"
    path.write_text(GMSH_4.replace("1 0 0 0 1 1 0 1 6 0", "1 0 0 0 1 1 0 2 6 8 0"))
    mesh, _, report = formats.read_with_report(path)
    assert mesh.cell_tags.tolist() == [6]
    assert report.warnings == ("1 entity(s) are in several physical groups, the first is kept",)


def test_names_of_files_in_medit_are_no_keywords(tmp_path):
    text = (
        'MeshVersionFormatted 2\nDimension 2\nGeometry "my End # Part.mesh"\nVertices\n3\n0 0 0\n'
        '1 0 0\n0 1 0\nIdentifier\n"Vertices of Mesh"\nTriangles\n1\n1 2 3 7\nEnd\n'
    )
    (tmp_path / "m.mesh").write_text(text)
    mesh, _, report = formats.read_with_report(tmp_path / "m.mesh")
    assert mesh.cell_tags.tolist() == [7]
    assert report.warnings == ("not known and not read: the section Geometry, Identifier",)
