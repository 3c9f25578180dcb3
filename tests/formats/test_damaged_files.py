"""Files that are cut, or say a thing twice, are refused with what is wrong."""

import base64
import struct
import zlib

import numpy as np
import pytest
from foreign_files import gmsh_4
from meshes import square, two_region_cube, two_regions

from anistar import Field, formats
from anistar.base.errors import FormatError
from anistar.cli.main import main

MEDIT = "MeshVersionFormatted 2\nDimension 2\n"
VERTICES = "Vertices\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
TRIANGLES = "Triangles\n2\n1 2 3 0\n1 3 4 0\n"
GMSH = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
NODES = "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
ELEMENTS = "$Elements\n2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 3 4\n$EndElements\n"
VTK = "# vtk DataFile Version 4.2\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n"
SU2 = "NDIME= 2\nNELEM= 1\n5 0 1 2 0\nNPOIN= 3\n0 0 0\n1 0 1\n0 1 2\n"


def refused(path, content, message):
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(FormatError) as caught:
        formats.read(path)
    assert str(path) in str(caught.value)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("make", [square, two_region_cube])
def test_su2_is_refused_wherever_it_ends(tmp_path, make):
    path = tmp_path / "m.su2"
    formats.write(path, make(1))
    whole = path.read_bytes()
    for end in range(0, len(whole), 11):
        refused(path, whole[:end], "")


@pytest.mark.parametrize("places", [("points",), ("cells",), ("points", "cells")])
def test_a_solution_beside_a_whole_mesh_is_refused_wherever_it_ends(tmp_path, places):
    mesh = square(1)
    fields = {f"on {place}": Field(np.arange(n) / 3, place)
              for place, n in (("points", mesh.n_points), ("cells", mesh.n_cells))
              if place in places}  # fmt: skip
    formats.write(tmp_path / "m.mesh", mesh, fields)
    solution = tmp_path / "m.sol"
    whole = solution.read_bytes().rstrip()
    for end in range(len(whole)):
        solution.write_bytes(whole[:end])
        with pytest.raises(FormatError, match=r"cannot read .*m\.sol: "):
            formats.read(tmp_path / "m.mesh")


def test_a_solution_of_another_program_may_lack_its_end_but_not_that_of_its_last_line(tmp_path):
    formats.write(tmp_path / "m.mesh", square(1))
    text = "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n4\n1 1\n1\n2\n3\n45\n"
    (tmp_path / "m.sol").write_text(text)
    assert formats.read(tmp_path / "m.mesh")[1]["field0"].values.tolist() == [1, 2, 3, 45]
    for end in range(len(text)):
        (tmp_path / "m.sol").write_text(text[:end])
        with pytest.raises(FormatError, match=r"m\.sol: "):
            formats.read(tmp_path / "m.mesh")


@pytest.mark.parametrize("kind", ["4.1", "4.0", "4.1 binary", "4.0 binary"])
def test_gmsh_4_is_refused_wherever_it_ends_within_a_section(tmp_path, kind):
    whole = gmsh_4(two_regions(2), kind)
    mesh_ends = whole.index(b"$EndElements") + len(b"$EndElements")
    for end in range(0, mesh_ends, 61):
        refused(tmp_path / "m.msh", whole[:end], "")


@pytest.mark.parametrize("suffix", [".msh", ".vtk"])
def test_our_own_files_miss_what_is_cut_off_behind_a_section(tmp_path, suffix):
    mesh = two_regions(2)
    path = tmp_path / f"m{suffix}"
    fields = {"u": mesh.points[:, 0], "k": Field(np.arange(mesh.n_cells) / 3, "cells")}
    formats.write(path, mesh, fields)
    whole = path.read_bytes()
    refused(path, whole[: whole.index({".msh": b"$ElementData", ".vtk": b"CELL_DATA"}[suffix])],
            "it is truncated: the ")  # fmt: skip


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("m.mesh", MEDIT + VERTICES + TRIANGLES + TRIANGLES + "End\n", "two sections Triangles"),
        ("m.mesh", MEDIT + VERTICES + VERTICES + TRIANGLES + "End\n", "two sections Vertices"),
        ("m.mesh", MEDIT + VERTICES + TRIANGLES + "End\n" + TRIANGLES, "two sections Triangles"),
        (
            "m.mesh",
            MEDIT + VERTICES + TRIANGLES + "End\nEdges 0\n",
            "Edges follows its keyword End",
        ),
        ("m.mesh", "7\n" + MEDIT + VERTICES + TRIANGLES + "End\n", "does not begin with"),
        ("m.msh", GMSH + NODES + NODES + ELEMENTS, "two sections Nodes"),
        ("m.msh", GMSH + NODES + ELEMENTS + ELEMENTS, "two sections Elements"),
        (
            "m.msh",
            GMSH + NODES.replace("\n2 1", "\n1 1") + ELEMENTS,
            "node number 1 is given twice",
        ),
        (
            "m.msh",
            GMSH + NODES + ELEMENTS.replace("\n2 2 2", "\n1 2 2"),
            "element number 1 is given",
        ),
        ("m.msh", GMSH + NODES + ELEMENTS.replace("$Elements\n2", "$Elements\n3"), "3 rows, 2"),
        ("m.msh", GMSH + NODES + ELEMENTS + "7\n", "something follows its last section"),
        ("m.su2", SU2, "NMARK= is missing: it is truncated, or needs NMARK= 0"),
        ("m.su2", SU2 + "NMARK= 0", "its last line does not end. If it is whole, end it with a"),
        ("m.su2", SU2 + "NMARK= 1\n", "NMARK announces 1 markers, 0 follow"),
        ("m.su2", SU2 + "NMARK= 1\nMARKER_TAG= a\n", "the marker 'a' has no MARKER_ELEMS="),
        ("m.su2", SU2 + "NMARK= 1\nMARKER_TAG= a\nMARKER_ELEMS= 2\n3 0 1\n", "announces 2 rows of"),
        (
            "m.su2",
            SU2 + 2 * "MARKER_TAG= a\nMARKER_ELEMS= 1\n3 0 1\n" + "NMARK= 2\n",
            "comes twice",
        ),
        ("m.su2", SU2 + "NMARK= 0\n" + SU2, "two parts NDIME="),
        ("m.su2", SU2.replace("1\n5 0 1 2 0", "1\n9 0 1 2 2") + "NMARK= 0\n", "twisted or flat"),
        (
            "m.inp",
            "*NODE\n1, 0, 0\n1, 1, 0\n*ELEMENT, TYPE=CPS3\n1, 1, 1, 1\n",
            "number 1 is given",
        ),
        ("m.inp", "*NODE\n1, 0, 0\n*INCLUDE, INPUT=/etc/passwd\n", "file, which is not opened"),
        ("m.inp", "*NODE, INPUT=/etc/passwd\n", "file, which is not opened"),
        ("m.inp", "*SYSTEM\n1, 0, 0\n*NODE\n1, 0, 0\n", "*SYSTEM, which moves its nodes"),
        ("m.inp", "*NODE, SYSTEM=C\n1, 0, 0\n", "*NODE has SYSTEM=C: give the nodes in Cartesian"),
        (
            "m.inp",
            "*NODE\n1, 0, 0\n*ELEMENT, TYPE=CPS3\n1, x\n",
            "m.inp: *ELEMENT holds something that is not a number",
        ),
        ("m.inp", "*NODE\n1, 0, 0\n*ELEMENT, TYPE=C3D8\n1, 1\n", "no rows of 9"),
        (
            "m.inp",
            "*NODE\n1, 0, 0\n*ELEMENT, TYPE=CPS3, EMSET=a\n",
            "EMSET of *ELEMENT is not known",
        ),
        (
            "m.vtk",
            VTK + "POINTS 1 double\n0 0 0\nFIELD f 1\nu 1 1 double\n1\n",
            "before POINT_DATA",
        ),
    ],
)
def test_what_is_missing_or_given_twice_is_named(tmp_path, name, content, message):
    refused(tmp_path / name, content, message)


def test_sections_given_twice_in_binary_medit_are_named(tmp_path):
    path = tmp_path / "m.meshb"
    formats.write(path, square(1))
    whole = path.read_bytes()
    code, following = struct.unpack_from("<ii", whole, 20)
    again = whole[20:following]
    end = len(whole) - 8
    doubled = whole[:end] + struct.pack("<ii", code, end + len(again)) + again[8:] + whole[end:]
    refused(path, doubled, "two sections Vertices")
    refused(path, whole + b"more", "4 bytes follow its keyword End")
    count = 28
    fewer = whole[:count] + struct.pack("<i", 3) + whole[count + 4 :]
    refused(path, fewer, "bytes follow the last row of Vertices")


@pytest.mark.parametrize(
    "note",
    [
        "[" * 100_000,
        '[[Infinity, 1, "x"]]',
        '[["a", 1, "x"]]',
        "[[1, [2], 3]]",
        '[[1, 99999999999, "x"]]',
        "[[1, " + "9" * 5000 + ', "x"]]',
        '[[1, 1, "x"], [1, 1, "y"]]',
        "5",
        "{}",
    ],
)
def test_damaged_names_in_a_comment_are_refused(tmp_path, note):
    head = MEDIT.replace("Dim", f"# anistar:names {note}\nDim")
    refused(tmp_path / "m.mesh", head + VERTICES + TRIANGLES + "End\n", "comment")


@pytest.mark.parametrize("note", ["[" * 100_000, "[[1]]", "5", "{}"])
def test_damaged_labels_in_a_comment_are_refused(tmp_path, note):
    comment = f"$Comments\nanistar:labels {note}\n$EndComments\n"
    refused(tmp_path / "m.msh", GMSH + comment + NODES + ELEMENTS, "comment")


@pytest.mark.parametrize(
    "note",
    ["[1]", '{"points": 5}', '{"points": [[[1], "scalar"]]}', '{"edges": []}', "[" * 100_000],
)
def test_damaged_fields_in_a_comment_are_refused(tmp_path, note):
    (tmp_path / "m.mesh").write_text(MEDIT + VERTICES + TRIANGLES + "End\n")
    head = MEDIT.replace("Dim", f"# anistar:fields {note}\nDim")
    (tmp_path / "m.sol").write_text(head + "SolAtVertices\n4\n1 1\n1 2 3 4\nEnd\n")
    with pytest.raises(FormatError, match=r"cannot read .*m\.sol: .*comment"):
        formats.read(tmp_path / "m.mesh")
    with pytest.raises(FormatError, match=r"cannot read .*m\.sol: .*comment"):
        formats.read_metric(tmp_path / "m.sol", square(1))


@pytest.mark.parametrize("head", ["-1 0", "-1\n0", "4\n0", "4\n-1", "4\n1 9"])
def test_a_solution_of_no_length_or_type_is_refused(tmp_path, head):
    (tmp_path / "m.sol").write_text(MEDIT + f"SolAtVertices\n{head}\nEnd\n")
    with pytest.raises(FormatError, match=r"cannot read .*m\.sol: "):
        formats.read_metric(tmp_path / "m.sol", square(1))


@pytest.mark.parametrize("suffix", [".mesh", ".msh", ".su2", ".inp", ".vtk", ".vtu", ".xdmf"])
def test_integers_of_any_length_are_refused(tmp_path, suffix):
    path = tmp_path / f"m{suffix}"
    many = b"1" * 5000
    if suffix == ".inp":
        refused(path, b"*NODE\n" + many + b", 0, 0\n*ELEMENT, TYPE=CPS3\n1, 1, 1, 1\n", "")
        return
    formats.write(path, square(1))
    whole = path.read_bytes()
    word = {".mesh": b"Vertices\n4", ".msh": b"$Nodes\n4", ".su2": b"NPOIN= 4", ".vtk": b"POINTS 4",
            ".vtu": b'NumberOfPoints="4', ".xdmf": b'Dimensions="4'}[suffix]  # fmt: skip
    assert word in whole
    refused(path, whole.replace(word, word[:-1] + many), "")


HUGE = 2**31 - 1


def _record(code, *numbers):
    return (
        struct.pack("<iii", 1, 2, 3)
        + struct.pack("<ii", 20, 2)
        + struct.pack(f"<ii{len(numbers)}i", code, 28 + 4 * len(numbers), *numbers)
    )


def _vtu(array, *, points="1"):
    return (
        '<VTKFile type="UnstructuredGrid" byte_order="LittleEndian" header_type="UInt64" '
        'compressor="vtkZLibDataCompressor"><UnstructuredGrid>'
        f'<Piece NumberOfPoints="{points}" NumberOfCells="1"><Points>'
        f'<DataArray type="Float64" NumberOfComponents="3" format="binary">{array}</DataArray>'
        "</Points><Cells></Cells></Piece></UnstructuredGrid></VTKFile>"
    )


def _bomb(n_bytes):
    """A block of zeros that is a thousandth of what it says."""
    packed = zlib.compress(bytes(n_bytes), 9)
    header = struct.pack("<QQQQ", 1, n_bytes, n_bytes, len(packed))
    return _vtu(
        (base64.b64encode(header) + base64.b64encode(packed)).decode(), points=n_bytes // 24
    )


ENTITY = '<!DOCTYPE l [<!ENTITY a "x">]><VTKFile>&a;</VTKFile>'
POINTS_41 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 99999999999 1 9\n2 1 0 99999999999\n"


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("m.meshb", _record(4, HUGE, 0), "it is truncated"),
        ("m.meshb", _record(6, HUGE, 0), "it is truncated"),
        ("m.meshb", _record(62, HUGE, HUGE, 1), "it is truncated"),
        ("m.su2", SU2.replace("NPOIN= 3", "NPOIN= 99999999999") + "NMARK= 0\n", "announces"),
        ("m.vtk", VTK + "POINTS 99999999999 double\n0 0 0\n", "it is truncated"),
        (
            "m.vtk",
            VTK.replace("ASCII", "BINARY") + "POINTS 99999999999 double\n0",
            "it is truncated",
        ),
        (
            "m.vtk",
            VTK.replace("UNSTRUCTURED_GRID", "STRUCTURED_POINTS") + "DIMENSIONS 9999 9999 1\n",
            "save it as an unstructured grid",
        ),
        ("m.msh", POINTS_41 + "$EndNodes\n$Elements\n0 0 0 0\n$EndElements\n", "announces 9"),
        (
            "m.msh",
            b"$MeshFormat\n4.1 1 8\n\1\0\0\0\n$EndMeshFormat\n$Nodes\n"
            + struct.pack("<4Q3iQ", 1, 2**40, 1, 2**40, 2, 1, 0, 2**40)
            + b"\n$EndNodes\n",
            "truncated",
        ),
        (
            "m.msh",
            b"$MeshFormat\n2.2 1 8\n\1\0\0\0\n$EndMeshFormat\n$Nodes\n999999999\nxx",
            "truncated",
        ),
        ("m.vtu", _bomb(200 * 2**20), "its arrays take more than 100 times its length"),
        ("m.vtu", _vtu(base64.b64encode(struct.pack("<Q", 2**60)).decode()), "it is truncated"),
        ("m.vtu", ENTITY, "it defines the entity 'a'"),
        ("m.vtu", ENTITY.encode("utf-16"), "it defines the entity 'a'"),
        ("m.vtu", ENTITY.replace("a ", "% a ", 1), "it defines the entity 'a'"),
        ("m.xdmf", ENTITY.replace('"x"', 'SYSTEM "/etc/passwd"'), "it defines the entity 'a'"),
        ("m.xdmf", '<!DOCTYPE l SYSTEM "l.dtd"><Xdmf>&a;</Xdmf>', "undefined entity &a;"),
        ("m.xdmf", "<Xdmf>" + "<Domain>" * 50_000 + "</Domain>" * 50_000 + "</Xdmf>", "0 grids"),
    ],
    ids=lambda value: value if isinstance(value, str) and len(value) < 60 else "",
)
def test_sizes_are_checked_against_the_length_of_the_file(tmp_path, name, content, message):
    refused(tmp_path / name, content, message)


def test_points_of_xdmf_cells_in_another_order_are_refused(tmp_path):
    path = tmp_path / "m.xdmf"
    formats.write(path, square(1))
    text = path.read_text()
    for told, message in (("BaseOffset", "1"), ("Order", "0 2 1"), ("Order", "1 2 3")):
        refused(path, text.replace("<Topology", f'<Topology {told}="{message}"'), f"has {told} '")
    path.write_text(text.replace("<Topology", '<Topology BaseOffset="0" Order="0 1 2"'))
    assert formats.read(path)[0].n_cells == 2


def test_numbers_outside_of_an_xdmf_file_are_not_followed(tmp_path):
    path = tmp_path / "m.xdmf"
    formats.write(path, square(1))
    text = path.read_text()
    refused(path, text.replace('Format="XML"', 'Format="Binary"', 1), "numbers are elsewhere")
    refused(path, text.replace('Format="XML"', 'Format="HDF"', 1), "no HDF5 file beside it")


@pytest.mark.parametrize("suffix", [".node", ".tec", ".ply", ".off", ".stl", ".e"])
def test_formats_that_no_test_reads_are_refused_with_what_to_do(tmp_path, suffix):
    refused(tmp_path / f"m{suffix}", "", f"files {suffix} are not read here; convert it to VTU")


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("m.mesh", MEDIT.replace("Dim", "# anistar:names 5\nDim") + VERTICES + TRIANGLES + "End\n"),
        ("m.msh", GMSH + NODES + ELEMENTS + ELEMENTS),
        ("m.su2", SU2),
        ("m.vtu", "<VTKFile>"),
    ],
)
def test_the_command_line_names_the_file(tmp_path, capsys, name, content):
    (tmp_path / name).write_text(content)
    assert main(["check", str(tmp_path / name)]) in (1, 2)
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert f"cannot read {tmp_path / name}: " in said
