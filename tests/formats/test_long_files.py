"""Files that are made to take long. Work that grows as the square of the length would not end."""

import base64
import struct

import numpy as np
import pytest

from anistar import formats
from anistar.base.errors import FormatError
from anistar.formats.gmsh import reader as gmsh_reader
from anistar.formats.parsing import rows

N = 300_000
MEDIT = (
    "MeshVersionFormatted 2\n{}Dimension 2\nVertices\n3\n0 0 0\n1 0 0\n0 1 0\n"
    "Triangles\n1\n1 2 3 0\nEnd\n"
)
GMSH = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
MESH = (
    "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n$Elements\n1\n1 2 2 1 1 1 2 3\n$EndElements\n"
)
SU2 = "NDIME= 2\nNELEM= 1\n5 0 1 2 0\nNPOIN= 3\n0 0 0\n1 0 1\n0 1 2\n"
ABAQUS = "*NODE\n1, 0, 0\n2, 1, 0\n3, 0, 1\n*ELEMENT, TYPE=CPS3, ELSET=s\n1, 1, 2, 3\n"
VTK = "# vtk DataFile Version 4.2\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n"
VTK_MESH = "POINTS 3 double\n0 0 0 1 0 0 0 1 0\nCELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n"
STRIP = "".join(f"{i + 1} {i // 2} {i % 2} {(i // 2) % 2}\n" for i in range(N // 15))
ENTITIES = "".join(
    f"{i + 1} 2 2 1 {i + 1} {i + 1} {i + 2} {i + 3}\n{N + i} 1 2 1 {i + 1} {i + 1} {i + 3}\n"
    for i in range(N // 15 - 2)
)
MANY_ENTITIES = (
    f"$Nodes\n{N // 15}\n{STRIP}$EndNodes\n"
    f"$Elements\n{2 * (N // 15 - 2) + 1}\n{3 * N} 4 2 1 1 1 2 3 4\n{ENTITIES}$EndElements\n"
)
XDMF = (
    '<Xdmf><Domain><Grid><Geometry GeometryType="XY"><DataItem Dimensions="3 2">0 0 1 0 0 1'
    '</DataItem></Geometry><Topology TopologyType="Mixed"><DataItem Dimensions="{}" '
    'NumberType="Int">{}</DataItem></Topology></Grid></Domain></Xdmf>'
)


def read(path, content):
    """Read a file, which may be refused; return what was said."""
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    try:
        _, _, report = formats.read_with_report(path)
    except FormatError as error:
        return str(error)
    return " ".join(report.warnings)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("m.mesh", MEDIT.format("\n" * 10 * N)),
        ("m.mesh", MEDIT.format(" \t" * 5 * N + "\n")),
        ("m.mesh", MEDIT.format("#" * 10 * N + "\n" + "# anistar:" * N + "\n")),
        ("m.mesh", MEDIT.format("Ab" * 5 * N + "\n")),
        ("m.mesh", MEDIT.format("".join(f"Section{i}\n" for i in range(N)))),
        ("m.msh", GMSH + "$A\n" * 3 * N),
        ("m.msh", GMSH + "$" + "A" * 5 * N + " " * 5 * N + "x\n"),
        ("m.msh", GMSH + "$PhysicalNames\n1\n" + "\n" * 10 * N + "$EndPhysicalNames\n" + MESH),
        ("m.msh", GMSH + "$PhysicalNames\n1\n1 1 " + " " * 5 * N + "\n$EndPhysicalNames\n" + MESH),
        ("m.msh", GMSH + MESH + "".join(f"$A{i}\n$EndA{i}\n" for i in range(N // 3))),
        ("m.msh", "$MeshFormat\n" * N),
        ("m.msh", GMSH + MANY_ENTITIES),
        ("m.su2", SU2 + "\n" * 10 * N + "NMARK= 0\n"),
        ("m.su2", SU2 + "A" * 5 * N + " " * 5 * N + "\nNMARK= 0\n"),
        ("m.su2", SU2 + f"NMARK= {N // 15}\n" + "".join(
            f"MARKER_TAG= {i}\nMARKER_ELEMS= 0\n" for i in range(N // 15))),
        ("m.inp", ABAQUS + "*\n" * (N // 4) + "\n" * 5 * N),
        ("m.inp", ABAQUS + "".join(f"*ELSET, ELSET=s{i}\ns\n" for i in range(N // 50))),
        ("m.inp", ABAQUS + "*ELSET, ELSET=t0\n1\n" + "".join(
            f"*ELSET, ELSET=t{i + 1}\nt{i}, t{i}\n" for i in range(1000))),
        ("m.vtk", VTK + VTK_MESH + "\n" * 5 * N + "METADATA\nx\n\n" * (N // 9)),
        ("m.vtk", VTK + VTK_MESH + f"POINT_DATA 3\nFIELD f {N // 50}\n" + "".join(
            f"u{i} 1 3 double\n1 2 3\n" for i in range(N // 50))),
        ("m.vtk", VTK + "POINTS 3 double\n" + " " * 10 * N + "0 0 0\n"),
        ("m.vtu", "<VTKFile>" + "<AppendedData " * N),
        ("m.vtu", "<VTKFile>" + "<a>" * N + "</a>" * N + "</VTKFile>"),
        ("m.xdmf", XDMF.format(7 * (N // 50), "1 1 0 4 0 1 2 " * (N // 50))),
    ],
    ids=lambda value: value if len(value) < 9 else "",
)  # fmt: skip
def test_work_grows_no_faster_than_the_file(tmp_path, name, content):
    said = read(tmp_path / name, content)
    assert len(said) < 800
    assert "\n" not in said


class Watched(np.ndarray):
    """An array that counts the numbers in the slices taken of it."""

    n_looked_at = 0

    def __getitem__(self, index):
        part = super().__getitem__(index)
        if isinstance(index, slice):
            Watched.n_looked_at += part.size
        return np.asarray(part)


@pytest.mark.parametrize("n_alike", [1, 500])
def test_runs_of_rows_are_found_with_work_in_proportion_to_them(n_alike):
    one = [*[1, 7] * n_alike, *[2, 8, 8] * n_alike]
    work = []
    for n in (500, 1000, 2000):
        values = np.tile(one, n // n_alike).view(Watched)
        at, Watched.n_looked_at = 0, 0
        while at < values.size:
            width = 2 if int(np.asarray(values)[at]) == 1 else 3
            at += rows.leading_rows(values, at, width, [0]).size
        work.append(Watched.n_looked_at)
    assert work[1] < 2.5 * work[0]
    assert work[2] < 2.5 * work[1]


def test_arrays_that_share_their_bytes_are_counted_each(tmp_path):
    n_points, n_arrays = 10_000, 3000
    block = struct.pack("<Q", 24 * n_points) + bytes(24 * n_points)
    array = (
        '<DataArray type="Float64" Name="{}" NumberOfComponents="3" format="appended" offset="0"/>'
    )
    document = (
        '<VTKFile type="UnstructuredGrid" byte_order="LittleEndian" header_type="UInt64">'
        f'<UnstructuredGrid><Piece NumberOfPoints="{n_points}" NumberOfCells="0"><Points>'
        f'{array.format("p")}</Points><Cells><DataArray type="Int64" Name="connectivity"/>'
        '<DataArray type="Int64" Name="offsets"/><DataArray type="UInt8" Name="types"/></Cells>'
        f"<PointData>{''.join(array.format(i) for i in range(n_arrays))}</PointData></Piece>"
        '</UnstructuredGrid><AppendedData encoding="base64">_'
    ).encode()
    path = tmp_path / "m.vtu"
    said = read(path, document + base64.b64encode(block) + b"</AppendedData></VTKFile>")
    assert said == f"cannot read {path}: its arrays take more than 100 times its length"


def test_blocks_of_one_kind_are_joined(tmp_path):
    n = 2000
    points = np.stack([np.arange(n + 2) // 2, np.arange(n + 2) % 2, np.zeros(n + 2)], axis=1)
    nodes = "".join(f"{i + 1} {x} {y} {z}\n" for i, (x, y, z) in enumerate(points.tolist()))
    cells = "".join(
        f"{2 * i + 1} 2 2 1 1 {i + 1} {i + 2} {i + 3}\n{2 * i + 2} 15 2 0 1 {i + 1}\n"
        for i in range(n)
    )
    path = tmp_path / "m.msh"
    path.write_text(
        f"{GMSH}$Nodes\n{n + 2}\n{nodes}$EndNodes\n$Elements\n{2 * n}\n{cells}$EndElements\n"
    )
    raw = gmsh_reader.read(path)
    assert {block.kind: len(block.rows) for block in raw.blocks} == {"triangle": n, "vertex": n}
    assert len(raw.blocks) == 2
    assert formats.read(path)[0].n_cells == n


@pytest.mark.parametrize(
    ("components", "n_sections"), [(10**9, 1), (1, 3000)], ids=["wide", "many"]
)
def test_data_without_rows_take_no_memory(tmp_path, components, n_sections):
    n = 4000
    nodes = "".join(f"{i + 4} 0 0 0\n" for i in range(n))
    mesh = MESH.replace("$Nodes\n3\n", f"$Nodes\n{n + 3}\n")
    mesh = mesh.replace("$EndNodes", f"{nodes}$EndNodes")
    data = "".join(
        f'$NodeData\n1\n"u{i}"\n1\n0\n3\n0\n{components}\n0\n$EndNodeData\n'
        for i in range(n_sections)
    )
    path = tmp_path / "m.msh"
    said = read(path, GMSH + mesh + data)
    assert said == f"cannot read {path}: its arrays take more than 100 times its length"
