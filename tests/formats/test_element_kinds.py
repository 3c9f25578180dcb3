"""Elements that a mesh has not are split, of those of second order the corners are taken."""

import itertools

import meshio
import numpy as np
import pytest
from meshes import cube, square

from anistar import formats, remesh
from anistar.formats.content.kinds import KINDS
from anistar.meshes.validation import validate

BOX = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
CELLS = {
    "hexahedron": (BOX, range(8), 6),
    "wedge": (BOX, [0, 1, 3, 4, 5, 7], 3),
    "pyramid": ([*BOX[:4], [0.5, 0.5, 1]], range(5), 2),
}
"""Points, nodes and tetrahedra of a cell."""


OPTIONS = {".xdmf": {"data_format": "XML"}, ".msh": {"file_format": "gmsh22"}}


def written(path, points, cells, **data):
    mesh = meshio.Mesh(np.asarray(points, float), cells, **data)
    mesh.write(path, **OPTIONS.get(path.suffix, {}))
    return path


def volumes(mesh):
    sides = mesh.points[mesh.cells[:, 1:]] - mesh.points[mesh.cells[:, :1]]
    return np.linalg.det(sides) / (2 if mesh.dim == 2 else 6)


@pytest.mark.parametrize("suffix", [".vtu", ".vtk", ".xdmf", ".msh", ".mesh", ".inp"])
def test_a_quadrilateral_is_split_by_its_better_diagonal(tmp_path, suffix):
    points = [[0, 0, 0], [3, 0, 0], [2, 1, 0], [0, 1, 0], [4, 1, 0]]
    cells = [("quad", [[0, 1, 2, 3]]), ("triangle", [[1, 4, 2]])]
    path = written(tmp_path / f"m{suffix}", points, cells)
    mesh, _, report = formats.read_with_report(path)
    assert sorted(map(sorted, mesh.cells.tolist())) == [[0, 1, 2], [0, 2, 3], [1, 2, 4]]
    assert report.split_elements == 1
    assert "1 quadrilateral(s) split into triangles" in report.warnings
    assert validate(mesh) == []


def test_tags_and_values_of_what_is_split_are_repeated_in_all_dimensions(tmp_path):
    tags = [np.array([7, 9], np.int32), np.array([3], np.int32)]
    data = {"gmsh:physical": tags, "k": [np.array([0.5, 1.5]), np.array([0.0])]}
    points = [*BOX, [2, 0, 0], [2, 1, 0], [2, 1, 1], [2, 0, 1]]
    cells = [("hexahedron", [range(8), [1, 8, 9, 2, 5, 11, 10, 6]]), ("quad", [[0, 3, 7, 4]])]
    path = written(tmp_path / "m.vtu", points, cells, cell_data=data)
    mesh, fields, report = formats.read_with_report(path)
    assert mesh.cell_tags.tolist() == 6 * [7] + 6 * [9]
    assert fields["k"].values.tolist() == 6 * [0.5] + 6 * [1.5]
    assert np.count_nonzero(mesh.facet_tags == 3) == 2
    assert report.split_elements == 3
    assert np.isclose(volumes(mesh).sum(), 2)
    assert validate(mesh) == []


@pytest.mark.parametrize("kind", CELLS)
def test_a_cell_is_filled_whatever_the_numbers_of_its_points(tmp_path, kind):
    points, nodes, count = CELLS[kind]
    volume = {"hexahedron": 1, "wedge": 1 / 2, "pyramid": 1 / 3}[kind]
    draw = np.random.default_rng(3)
    for _ in range(12):
        order = draw.permutation(len(points))
        place = np.argsort(order)
        rows = place[list(nodes)][None]
        path = written(tmp_path / "m.vtu", np.array(points)[order], [(kind, rows)])
        mesh = formats.read(path)[0]
        assert mesh.n_cells == count
        assert np.isclose(volumes(mesh).sum(), volume)
        assert validate(mesh) == []


def test_cells_of_all_kinds_meet_at_the_same_triangles(tmp_path):
    """A box with a pyramid below, a prism beside and tetrahedra above, numbered at random."""
    points = [*BOX, [0.5, 0.5, -1], [2, 0, 0], [2, 0, 1], [0.5, 0.5, 2]]
    hexahedron, pyramid, wedge = list(range(8)), [3, 2, 1, 0, 8], [1, 9, 2, 5, 10, 6]
    upper = [5, 6, 7, 4, 11]  # a pyramid again
    draw = np.random.default_rng(8)
    for _ in range(12):
        order = draw.permutation(len(points))
        place = np.argsort(order)
        cells = [
            ("hexahedron", place[[hexahedron]]),
            ("pyramid", place[[pyramid, upper]]),
            ("wedge", place[[wedge]]),
        ]
        mesh = formats.read(written(tmp_path / "m.vtu", np.array(points)[order], cells))[0]
        assert mesh.n_cells == 6 + 2 * 2 + 3
        assert validate(mesh) == []


def test_a_twisted_cell_is_refused(tmp_path):
    points = np.array(BOX, float)
    points[6] = [0.2, 0.2, -0.5]
    path = written(tmp_path / "m.vtu", points, [("hexahedron", [range(8)])])
    with pytest.raises(formats.FormatError, match=r"hexahedron 0 at \(.*\) is twisted"):
        formats.read(path)
    bow = [[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]]
    path = written(tmp_path / "m.vtu", bow, [("quad", [[0, 1, 2, 3]])])
    with pytest.raises(formats.FormatError, match=r"quadrilateral 0 at .* is twisted or flat"):
        formats.read(path)


@pytest.mark.parametrize("kind", ["polygon5", "polyhedron8"])
def test_what_cannot_be_split_is_refused(tmp_path, kind):
    from anistar.formats.content.raw import Block, RawMesh
    from anistar.formats.content.simplices import simplices_of

    name = kind.rstrip("58")
    with pytest.raises(ValueError, match=f"elements of type '{name}'; .* are not supported"):
        simplices_of(RawMesh(np.eye(3), [Block(name, np.zeros((1, 0), np.int64))]))


def of_second_order(mesh, bend):
    """The cells and facets of a mesh with nodes on their edges, moved by `bend`."""
    kinds = {2: "line3", 3: "triangle6", 4: "tetra10"}
    points, number, blocks = [*mesh.points], {}, []
    for rows in (mesh.cells, mesh.facets):
        kind = kinds[rows.shape[1]]
        nodes = [[*row] for row in rows.tolist()]
        for row in nodes:
            for a, b, _ in KINDS[kind].mids:
                edge = tuple(sorted((row[a], row[b])))
                if edge not in number:
                    number[edge] = len(points)
                    points.append(bend(mesh.points[list(edge)].mean(axis=0)))
                row.append(number[edge])
        blocks.append((kind, nodes))
    points = np.pad(points, ((0, 0), (0, 3 - mesh.dim)))
    tags = [mesh.cell_tags, mesh.facet_tags]
    return meshio.Mesh(points, blocks, cell_data={"gmsh:physical": tags})


@pytest.mark.parametrize("suffix", [".vtu", ".vtk", ".msh", ".xdmf"])
@pytest.mark.parametrize("make", [square, cube])
def test_curved_edges_of_second_order_are_the_geometry(tmp_path, make, suffix):
    mesh = make(2)
    given = of_second_order(mesh, lambda x: x + 0.05 * np.sin(np.pi * x[::-1]))
    given.point_data["u"] = given.points[:, 0]
    given.write(tmp_path / f"m{suffix}", **OPTIONS.get(suffix, {}))
    got, fields, report = formats.read_with_report(tmp_path / f"m{suffix}")
    shape = report.geometry
    assert np.array_equal(got.points, mesh.points)
    assert np.array_equal(got.cell_tags, mesh.cell_tags)
    assert np.array_equal(fields["u"].values, mesh.points[:, 0])
    assert report.mid_nodes == len(given.points) - mesh.n_points
    assert report.dropped_points == 0
    assert shape.n_cells == 2**mesh.dim * mesh.n_cells
    assert shape.n_facets == 2 ** (mesh.dim - 1) * mesh.n_facets
    counts = [np.bincount(m.facet_tags) for m in (shape, got)]
    assert np.array_equal(counts[0], 2 ** (mesh.dim - 1) * counts[1])
    assert np.isclose(shape.points, given.points[-1, : mesh.dim]).all(axis=1).any()
    assert "geometry of their own" in report.warnings[-1]
    assert report.as_dict()["geometry"] is True
    assert validate(got) == validate(shape) == []


def test_straight_edges_of_second_order_are_no_geometry(tmp_path):
    of_second_order(cube(1), lambda x: x).write(tmp_path / "m.vtu")
    mesh, _, report = formats.read_with_report(tmp_path / "m.vtu")
    assert report.geometry is None
    assert report.warnings == ("18 element(s) of second order: their corners are the mesh",)
    assert validate(mesh) == []


def test_edges_that_cross_when_they_are_curved_are_straight_and_it_is_told(tmp_path):
    given = of_second_order(square(1), lambda x: [x[0], x[1] + 1.4 * (x[1] == 0)])
    given.write(tmp_path / "m.vtu")
    mesh, _, report = formats.read_with_report(tmp_path / "m.vtu")
    assert report.geometry is None
    assert "are curved, but the mesh through their nodes is not valid" in report.warnings[-1]
    assert validate(mesh) == []


def test_quadrilaterals_of_second_order_are_split_between_their_corners(tmp_path):
    points = [[0, 0], [2, 0], [2, 1], [0, 1], [1, -0.2], [2, 0.5], [1, 1], [0, 0.5]]
    cells = [("quad8", [list(range(8))])]
    path = written(tmp_path / "m.vtu", np.pad(points, ((0, 0), (0, 1))), cells)
    mesh, _, report = formats.read_with_report(path)
    assert (mesh.n_points, mesh.n_cells) == (4, 2)
    assert report.geometry is None
    assert "not all cells are triangles or tetrahedra of second order" in report.warnings[-1]
    assert validate(mesh) == []


PLANES = [".vtu", ".vtk", ".xdmf", ".msh", ".mesh"]


@pytest.mark.parametrize("suffix", PLANES)
def test_a_plane_at_any_height_is_a_mesh_in_2d_and_goes_back_there(tmp_path, suffix):
    mesh = square(3)
    points = np.column_stack([mesh.points, np.full(mesh.n_points, 3.1)])
    written(tmp_path / "in.vtu", points, [("triangle", mesh.cells)])
    got = formats.read(tmp_path / "in.vtu")[0]
    assert (got.dim, got.z) == (2, 3.1)
    assert np.array_equal(got.points, mesh.points)
    formats.write(tmp_path / f"out{suffix}", got, {"v": mesh.points})
    again, fields = formats.read(tmp_path / f"out{suffix}")
    assert again.z == 3.1
    assert np.array_equal(fields["v"].values, mesh.points)
    assert validate(again, got) == []


@pytest.mark.parametrize(
    ("plane", "message"),
    [
        ([[1, 0, 0], [0, 1, 1]], r"a plane that is tilted: z goes from 0 to 1.* turn it"),
        ([[0, 1, 0], [0, 0, 1]], r"a plane that is tilted: .*its normal is \(1, 0, 0\);"),
    ],
)
def test_a_tilted_plane_is_refused_with_its_normal(tmp_path, plane, message):
    mesh = square(2)
    path = written(tmp_path / "m.vtu", mesh.points @ np.array(plane), [("triangle", mesh.cells)])
    with pytest.raises(formats.FormatError, match=message):
        formats.read(path)


@pytest.mark.parametrize(("number", "most"), [(np.float32, 1e-6), (np.float64, 1e-10)])
@pytest.mark.parametrize("z", [0.0, 3.5])
def test_a_plane_that_was_turned_away_and_back_is_one_again(tmp_path, number, most, z):
    mesh = square(3)
    turn = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0].astype(number)
    given = np.column_stack([mesh.points - 0.5, np.full(mesh.n_points, z)]).astype(number)
    points = (given @ turn.T) @ turn
    assert np.ptp(points[:, 2]) > 0
    path = written(tmp_path / "m.vtu", points, [("triangle", mesh.cells)])
    got, _, report = formats.read_with_report(path)
    assert (got.dim, got.z == 0) == (2, z == 0)
    assert abs(got.z - z) <= most * 4
    assert "z varies by" in report.warnings[0]
    assert validate(got) == []


def test_a_spread_beyond_rounding_is_told_with_its_bound(tmp_path):
    mesh = square(3)
    z = np.full(mesh.n_points, 0.1)
    z[0] += 1e-9
    path = written(tmp_path / "m.vtu", np.c_[mesh.points, z], [("triangle", mesh.cells)])
    with pytest.raises(
        formats.FormatError,
        match=r"not quite a plane of one z: z varies by 1e-09, more than .*1e-10",
    ):
        formats.read(path)


def test_a_curved_surface_is_refused(tmp_path):
    mesh = square(2)
    points = np.column_stack([mesh.points, (mesh.points**2).sum(axis=1)])
    path = written(tmp_path / "m.vtu", points, [("triangle", mesh.cells)])
    with pytest.raises(formats.FormatError, match=r"surface mesh in 3D.*z goes from 0 to 2"):
        formats.read(path)


def test_every_kind_has_its_corners_first():
    for name, kind in KINDS.items():
        corners = KINDS[kind.corners]
        assert corners.corners == kind.corners
        assert corners.dim == kind.dim
        nodes = sorted(itertools.chain.from_iterable(kind.mids))
        assert nodes == [] or name.startswith("quad") or set(nodes) == set(range(kind.n_nodes))


@pytest.mark.parametrize("form", ["path", "meshio", "pyvista"])
def test_curved_edges_of_any_object_are_what_is_remeshed(tmp_path, form):
    content = of_second_order(square(2), lambda x: x + 0.05 * np.sin(np.pi * x[::-1]))
    content.write(tmp_path / "m.vtu")
    held = {
        "path": lambda: tmp_path / "m.vtu",
        "meshio": lambda: content,
        "pyvista": lambda: pytest.importorskip("pyvista").read(tmp_path / "m.vtu"),
    }[form]()
    new = remesh(held, np.tile(36 * np.eye(2), (9, 1, 1))).mesh
    outline = np.minimum(new.points, 1 - new.points)[np.unique(new.facets)]
    assert np.count_nonzero(np.abs(outline).min(axis=1) > 0.02) > 8  # off the straight square
    assert validate(new) == []
