"""Files with geometry: what is read of each format, what of a damaged one is said."""

import struct

import numpy as np
import pytest
from geometry_files import is_cube, poly_text, written
from solids import CORNERS, SIDES, grid, sphere

import anistar
from anistar import FormatError
from anistar.generating import read_plc, read_plc_with_report

TRIANGLES = [t for a, b, c, d in SIDES for t in ([a, b, c], [a, c, d])]


def stl_text(solids):
    parts = []
    for name, triangles in solids:
        parts.append(f"solid {name}")
        for row in triangles:
            parts.append(" facet normal 0 0 0\n  outer loop")
            parts += [f"   vertex {x!r} {y!r} {z!r}" for x, y, z in np.array(CORNERS)[row].tolist()]
            parts.append("  endloop\n endfacet")
        parts.append(f"endsolid {name}")
    return "\n".join(parts) + "\n"


def stl_binary(header=b"", count=None, corners=None, attribute=0):
    corners = np.array(CORNERS, "<f4")[TRIANGLES] if corners is None else corners
    rows = b"".join(b"\0" * 12 + row.tobytes() + struct.pack("<H", attribute) for row in corners)
    n = len(corners) if count is None else count
    return header.ljust(80, b" ") + struct.pack("<I", n) + rows


def test_the_solids_of_a_text_stl_are_tags_with_names(tmp_path):
    solids = [("lid", TRIANGLES[:2]), ("", TRIANGLES[2:4]), ("rest of it", TRIANGLES[4:])]
    plc, report = read_plc_with_report(written(tmp_path, "a.stl", stl_text(solids)))
    assert is_cube(plc)
    assert plc.names == {(2, 1): "lid", (2, 3): "rest of it"}
    assert plc.facet_tags.tolist() == [1, 2, 3, 3, 3, 3]
    assert report.merged_points == 36 - 8
    assert report.warnings == ()


@pytest.mark.parametrize("header", [b"", b"solid box", b"solid box\nfacet normal"])
def test_a_binary_stl_may_begin_with_the_word_solid(tmp_path, header):
    plc = read_plc(written(tmp_path, "a.STL", stl_binary(header)))
    assert is_cube(plc)
    assert not plc.names


def test_negative_zeros_are_zeros(tmp_path):
    text = stl_text([("", TRIANGLES)]).replace("vertex 0.0", "vertex -0.0", 5)
    assert is_cube(read_plc(written(tmp_path, "a.stl", text)))


def test_colours_in_a_binary_stl_are_told(tmp_path, caplog):
    read_plc(written(tmp_path, "a.stl", stl_binary(attribute=3)))
    assert "the attributes (colours) of 12 triangle(s) are not read" in caplog.text


GOOD = stl_text([("", TRIANGLES)])


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "it is truncated: 0 bytes"),
        (stl_binary()[:-7], "it is truncated: its header announces 12 triangles, .* hold 11"),
        (stl_binary(count=4), "its header announces 4 triangles, but 12 follow"),
        (stl_binary(count=2**32 - 1), "announces 4294967295 triangles"),
        (
            stl_binary(corners=np.full((1, 3, 3), np.nan, "<f4")),
            "triangle 0 has a corner at .nan, nan, nan., not finite",
        ),
        (GOOD[:-30], "line .*truncated within a solid|in the place of a facet"),
        (GOOD.replace("outer loop", "inner loop", 1), "line 2: 'facet normal 0 0 0' in the place"),
        (GOOD.replace("vertex 1.0", "vertex one", 1), "line 6: vertex 'one 1.0 0.0'|line"),
        (GOOD.replace("vertex 1.0", "vertex nan", 1), "line .*is not finite"),
        (GOOD + "nonsense", "'nonsense' in the place of a solid"),
        ("solid a\nendsolid a\n", "it is empty"),
    ],
)
def test_damaged_stl_files_are_refused_with_the_place(tmp_path, content, message):
    with pytest.raises(FormatError, match=message) as caught:
        read_plc(written(tmp_path, "bad.stl", content))
    assert "bad.stl" in str(caught.value)


OBJ = """# a cube, two groups
mtllib none.mtl
v 0 0 0
v 1 0 0 0.5 0.5 0.5
v 1 1 0
v 0 1 0
g lower
f -4 -1 -2 -3
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
g upper
f 5//1 6//2 7/3/1 \\
 8
g sides
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
l 1 2 3
p 1
curv 0 1 2
"""


def test_an_obj_keeps_polygons_groups_lines_and_points(tmp_path):
    plc, report = read_plc_with_report(written(tmp_path, "a.obj", OBJ))
    assert is_cube(plc)
    assert plc.names == {(2, 1): "lower", (2, 2): "upper", (2, 3): "sides"}
    assert plc.facet_tags.tolist() == [1, 2, 3, 3, 3, 3]
    assert plc.edges.tolist() == [[0, 1], [1, 2]]
    assert plc.points_kept.tolist() == [0]
    assert report.split_faces == 6
    assert report.warnings == ("not known and not read: the statement curv (1 times)",)


def test_materials_of_one_object_are_tags(tmp_path):
    text = OBJ.replace("g ", "usemtl ")
    plc = read_plc(written(tmp_path, "a.obj", "o cube\n" + text))
    assert plc.names == {(2, 1): "lower", (2, 2): "upper", (2, 3): "sides"}


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("f 1 2 6 5", "f 1 2 6 50", "its faces refer to point 49"),
        ("f 1 2 6 5", "f 1 2 0 5", "line 17: there is no point 0"),
        ("f 1 2 6 5", "f 1 2 -9 5", "line 17: there is no point -9, 8 come before"),
        ("f 1 2 6 5", "f 1 x 6 5", "line 17: 'x' in the place of an integer"),
        ("v 1 1 1", "v 1 1", "line 11: a point has three coordinates"),
        ("v 1 1 1", "v 1 1 z", "line 11: '1 1 z' in the place of numbers"),
        ("v 1 1 1", "v 1 1 inf", "point 6 is .1.0, 1.0, inf., not finite"),
        ("f 1 2 6 5", "f 1 6 2 5", "encloses no area|cross"),
    ],
)
def test_damaged_obj_files_are_refused_with_the_line(tmp_path, old, new, message):
    with pytest.raises(FormatError, match=message):
        read_plc(written(tmp_path, "a.obj", OBJ.replace(old, new, 1)))


def test_faces_of_too_few_points_are_dropped_and_told(tmp_path):
    text = OBJ + "f 1 2\nf 3 3 4\nf 1 1 2 3\nv 9 9 9\n"
    plc, report = read_plc_with_report(written(tmp_path, "a.obj", text))
    assert report.dropped_faces == 2
    assert report.dropped_points == 1
    assert len(plc.triangles) == 13
    assert any("fewer than three" in text for text in report.warnings)


def off_text(header="OFF"):
    rows = [f"{x} {y} {z}" for x, y, z in CORNERS]
    faces = ["4 " + " ".join(map(str, side)) + " 255 0 0" for side in SIDES]
    return "\n".join([header, "# comment", "8 6 12", *rows, *faces]) + "\n"


def off_binary(order, with_colours):
    parts = [b"OFF BINARY\n", struct.pack(order + "3i", 8, 6, 12)]
    parts.append(np.array(CORNERS, order + "f4").tobytes())
    for side in SIDES:
        parts.append(struct.pack(order + "5i", 4, *side))
        parts.append(struct.pack(order + "i", 0) if with_colours else b"")
    return b"".join(parts)


@pytest.mark.parametrize(
    "content",
    [
        off_text(),
        off_text("OFF").replace("OFF\n# comment\n", "OFF "),
        off_text("COFF"),
        off_binary(">", True),
        off_binary("<", True),
        off_binary("<", False),
    ],
)
def test_off_files_are_read(tmp_path, content):
    assert is_cube(read_plc(written(tmp_path, "a.off", content)))


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (off_text()[:-40], "it is truncated"),
        (off_text().replace("8 6 12", "8 999999999 12"), "it is truncated"),
        (off_text("4OFF"), "another number of coordinates"),
        (off_text("OOF"), "does not begin with the word OFF"),
        (off_text().replace("4 0 3 2 1", "9 0 3 2 1"), "line 12: .* in the place|has 7"),
        (off_binary(">", True)[:-9], "it is truncated: 5 of 6 faces"),
    ],
)
def test_damaged_off_files_are_refused(tmp_path, content, message):
    with pytest.raises(FormatError, match=message):
        read_plc(written(tmp_path, "a.off", content))


def ply(form, faces=SIDES, more=""):
    head = (
        f"ply\nformat {form} 1.0\ncomment c\nelement vertex 8\nproperty float x\n"
        "property double y\nproperty float z\nproperty uchar red\n"
        f"element face {len(faces)}\n{more}property list uchar int vertex_indices\nend_header\n"
    ).encode()
    if form == "ascii":
        rows = [f"{x} {y} {z} 7" for x, y, z in CORNERS]
        rows += [" ".join(map(str, [len(f), *f])) for f in faces]
        return head + "\n".join(rows).encode()
    order = "<" if "little" in form else ">"
    body = [struct.pack(order + "fdfB", *corner, 7) for corner in CORNERS]
    body += [struct.pack(f"{order}B{len(f)}i", len(f), *f) for f in faces]
    return head + b"".join(body)


FORMS = ["ascii", "binary_little_endian", "binary_big_endian"]


@pytest.mark.parametrize("form", FORMS)
def test_ply_files_are_read(tmp_path, form):
    mixed = [*SIDES[:3], *TRIANGLES[6:]]
    assert is_cube(read_plc(written(tmp_path, "a.ply", ply(form))))
    assert is_cube(read_plc(written(tmp_path, "b.ply", ply(form, mixed))))


@pytest.mark.parametrize("form", FORMS)
def test_damaged_ply_files_are_refused(tmp_path, form):
    whole = ply(form)
    cases = [whole[:-10], whole[:60], whole.replace(b"face 6", b"face 600000000")]
    cases += [whole.replace(b"float x", b"float u"), whole.replace(b"list uchar", b"list float")]
    for content in cases:
        with pytest.raises(
            FormatError, match=r"truncated|property|no integer|not known in a header"
        ):
            read_plc(written(tmp_path, "a.ply", content))


def test_a_poly_file_keeps_holes_edges_regions_and_markers(tmp_path):
    plc = read_plc(written(tmp_path, "a.poly", poly_text()))
    assert plc.n_facets == 6
    assert plc.facet_tags.tolist() == [11, 12, 13, 13, 13, 13]
    assert plc.facets[1] == ((4, 5, 6, 7), (8, 9, 10, 11), (8, 4))
    assert plc.holes.tolist() == [[0.5, 0.5, 0.5]]
    region = plc.regions[0]
    assert (region.seed, region.tag) == ((0.1, 0.1, 0.1), 3)
    assert region.size**3 / (6 * 2**0.5) == pytest.approx(0.001)


def test_points_of_a_poly_file_may_be_in_another_one(tmp_path):
    lines = poly_text().splitlines()
    written(tmp_path, "a.node", "\n".join(lines[1:14]))
    path = written(tmp_path, "a.poly", "\n".join(["0 3 0 0", *lines[14:]]))
    assert read_plc(path).n_points == 12
    (tmp_path / "a.node").unlink()
    with pytest.raises(FormatError, match=r"a\.node"):
        read_plc(path)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("4 1 4 3 2", "4 1 4 3 99", "line 18: it refers to point 99"),
        ("2 9 5", "2 9 3", "not planar|lies in none"),
        ("12 3 0 0", "12 4 0 0", "4 coordinates"),
        ("1 0.1 0.1 0.1 3", "1 0.1 0.1 0.1 3.5", "attribute of a region is 3.5"),
        ("6 1\n", "60 1\n", "truncated|polygons|integer"),
    ],
)
def test_damaged_poly_files_are_refused(tmp_path, old, new, message):
    text = poly_text()
    assert old in text
    with pytest.raises(FormatError, match=message):
        read_plc(written(tmp_path, "a.poly", text.replace(old, new, 1)))


def test_outlines_of_triangle_are_read(tmp_path):
    text = "4 2 1 1\n0 0 0 9 0\n1 1 0 9 0\n2 1 1 9 1\n3 0.5 0.25 9 0\n"
    text += "3 1\n0 0 1 5\n1 1 2 6\n2 2 0 7\n0\n"
    plc = read_plc(written(tmp_path, "a.poly", text + "1\n0 0.6 0.2 8 0.01\n"))
    assert plc.dim == 2
    assert plc.edge_tags.tolist() == [5, 6, 7]
    assert plc.points_kept.tolist() == [3]
    assert plc.regions[0].tag == 8


@pytest.mark.parametrize("suffix", [".vtp", ".vtk", ".ply", ".stl"])
@pytest.mark.parametrize("binary", [True, False])
def test_files_of_pyvista_are_read(tmp_path, suffix, binary):
    pyvista = pytest.importorskip("pyvista")
    points, triangles = sphere(8)
    faces = np.c_[np.full(len(triangles), 3), triangles].ravel()
    surface = pyvista.PolyData(points.astype(np.float32), faces)
    surface.cell_data["medit:ref"] = np.arange(len(triangles)) % 3
    path = tmp_path / f"a{suffix}"
    surface.save(path, binary=binary)
    plc = read_plc(path)
    assert len(plc.triangles) == len(triangles)
    assert plc.n_points == len(points)
    if suffix in (".vtp", ".vtk"):
        assert set(plc.facet_tags.tolist()) == {0, 1, 2}


def test_a_surface_mesh_of_gmsh_keeps_names_and_lines(tmp_path):
    gmsh = pytest.importorskip("gmsh")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        box = gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.addPhysicalGroup(2, [1, 2], tag=7, name="ends")
        gmsh.model.addPhysicalGroup(2, [3, 4, 5, 6], tag=8, name="sides")
        gmsh.model.addPhysicalGroup(1, [1], tag=9, name="an edge")
        gmsh.model.mesh.generate(2)
        assert box == 1
        for version in (2.2, 4.1):
            gmsh.option.setNumber("Mesh.MshFileVersion", version)
            gmsh.write(str(tmp_path / f"a{version}.msh"))
    finally:
        gmsh.finalize()
    for path in sorted(tmp_path.iterdir()):
        plc = read_plc(path)
        assert plc.n_facets == 6
        assert sorted(plc.facet_tags.tolist()) == [7, 7, 8, 8, 8, 8]
        assert plc.names == {(2, 7): "ends", (2, 8): "sides", (1, 9): "an edge"}
        assert set(plc.edge_tags.tolist()) == {9}


def test_other_formats_come_by_way_of_meshio(tmp_path):
    meshio = pytest.importorskip("meshio")
    points, triangles = grid(3, bend=0.3)
    path = tmp_path / "a.xdmf"
    meshio.Mesh(points, [("triangle", triangles)]).write(path, data_format="XML")
    assert len(read_plc(path).triangles) == len(triangles)
    path.write_text("nonsense")
    with pytest.raises(FormatError, match=r"a\.xdmf: meshio says"):
        read_plc(path)


def test_files_that_are_no_geometry_are_refused(tmp_path):
    with pytest.raises(FormatError, match="no such file"):
        read_plc(tmp_path / "a.stl")
    with pytest.raises(FormatError, match="not known as geometry"):
        read_plc(written(tmp_path, "a.step", "x"))


def test_damaged_bytes_raise_nothing_but_format_errors(tmp_path):
    random = np.random.default_rng(5)
    seeds = {
        "a.stl": [GOOD.encode(), stl_binary()],
        "a.obj": [OBJ.encode()],
        "a.off": [off_text().encode(), off_binary(">", True)],
        "a.ply": [ply(form) for form in FORMS],
        "a.poly": [poly_text().encode()],
    }
    for name, contents in seeds.items():
        for content in contents:
            for _ in range(25):
                data = bytearray(content)
                for at in random.integers(0, len(data), 3):
                    data[at] = random.integers(0, 256)
                try:
                    read_plc(written(tmp_path, name, bytes(data[: random.integers(len(data))])))
                    read_plc(written(tmp_path, name, bytes(data)))
                except FormatError:
                    pass


def test_every_function_takes_a_file_for_a_complex(tmp_path):
    path = written(tmp_path, "a.stl", stl_binary())
    assert anistar.check_plc(path) == []
    assert is_cube(anistar.repaired(path, "orient")[0])
    assert anistar.wrap(path, 0.1).plc.n_facets > 6
    assert anistar.generate(path, method="constrained").mesh.n_points == 8
