"""Every call takes the mesh object at hand, and gives one of its kind back on request."""

import subprocess
import sys

import meshio
import numpy as np
import pytest
import pyvista
from meshes import cube, slit, square, two_region_cube, two_regions
from remesh3d.domains import touching_cubes

import anistar
from anistar import Mesh, objects

HOLDING_FIELDS = ["meshio", "pyvista", "vtk"]
BARE = ["dolfinx", "mfem", "ngsolve", "skfem"]


def front(mesh):
    return np.tanh(8 * (mesh.points.sum(axis=1) - 1))


def tags_by_name(mesh):
    """How many cells or facets carry each name, which no renumbering changes."""
    names = {}
    for (dim, tag), name in mesh.names.items():
        if dim == mesh.dim:
            names[name] = int((mesh.cell_tags == tag).sum())
        elif dim == mesh.dim - 1:
            names[name] = int((mesh.facet_tags == tag).sum())
    names.pop("0", None)  # NGSolve has a name for everything
    return names


@pytest.mark.parametrize("form", HOLDING_FIELDS + BARE)
@pytest.mark.parametrize("make", [square, cube], ids=["2d", "3d"])
def test_a_mesh_keeps_points_and_names_through_every_form(form, make):
    mesh = make()
    other = objects.made(mesh, {}, form)
    again = objects.as_mesh(other)
    assert anistar.validate(again, reference=None if form in BARE else mesh) == []
    assert np.array_equal(again.points, mesh.points)
    assert tags_by_name(again) == tags_by_name(mesh)


def moved(mesh):
    return anistar.Mesh(**{**mesh.arrays(), "points": mesh.points + 1e6})


@pytest.mark.parametrize("form", HOLDING_FIELDS + BARE)
@pytest.mark.parametrize(
    "make",
    [slit, lambda: touching_cubes((1, 1, 0)), lambda: moved(square()), lambda: moved(cube())],
    ids=["slit", "touching in an edge", "far away", "far away in space"],
)
def test_other_bodies_come_back_as_they_are(form, make):
    mesh = make()
    again = objects.as_mesh(objects.made(mesh, {}, form))
    assert anistar.validate(again) == []
    assert np.array_equal(again.points, mesh.points)
    assert np.array_equal(np.sort(again.cells, axis=1), np.sort(mesh.cells, axis=1))
    assert again.n_facets == mesh.n_facets


@pytest.mark.parametrize("form", HOLDING_FIELDS)
@pytest.mark.parametrize("make", [two_regions, two_region_cube], ids=["2d", "3d"])
def test_an_object_with_fields_is_adapted_to_one_of_them_by_name(form, make):
    mesh = make()
    given = objects.made(mesh, {"u": front(mesh), "carried": mesh.points[:, 0]}, form)
    made = anistar.adapt(given, "u", target_complexity=150, like=given)
    assert type(made) is type(given)
    held = objects.opened(made)
    assert anistar.validate(held.mesh) == []
    assert tags_by_name(held.mesh).keys() == tags_by_name(mesh).keys()
    assert set(held.fields) == {"u", "carried"}
    direct = anistar.adapt(mesh, {"u": front(mesh)}, target_complexity=150)
    assert np.array_equal(held.mesh.points, direct.mesh.points)
    assert np.allclose(held.fields["carried"].values, held.mesh.points[:, 0])


@pytest.mark.parametrize("form", BARE)
def test_a_mesh_without_fields_comes_back_beside_them(form):
    mesh = square()
    given = objects.made(mesh, {}, form)
    other, fields = anistar.adapt(given, front(mesh), target_complexity=100, like=given)
    assert type(other) is type(given)
    again = objects.as_mesh(other)
    assert anistar.validate(again) == []
    assert len(objects.values_of(fields["u"])) == again.n_points
    assert tags_by_name(again).keys() == set(mesh.names.values())


def values_on(form, other, fields):
    """A field and where the package itself says that its values are."""
    if form == "dolfinx":
        return other.domain.geometry.x[:, :2], fields["u"].x.array
    if form == "skfem":
        return other.p.T, fields["u"]
    if form == "ngsolve":
        return np.array([vertex.point for vertex in other.vertices]), fields["u"]
    return np.array(other.GetVertexArray())[:, :2], fields["u"]


@pytest.mark.parametrize("form", BARE)
def test_values_stand_where_the_package_says_its_points_are(form):
    mesh = square(12)
    linear = mesh.points @ [1.0, 10.0]
    given = objects.made(mesh, {}, form)
    _, fields = objects.made(mesh, {"u": linear}, form)
    done = anistar.adapt(given, {"v": front(mesh), "u": linear}, target_complexity=90)
    other, fields = done.to(form)
    places, values = values_on(form, other, fields)
    assert np.allclose(values, places @ [1.0, 10.0])


def test_solvers_of_dolfinx_get_functions_and_may_return_them():
    from anistar.adapters import dolfinx as adapter

    fem = adapter.dolfinx.fem
    seen = []

    def solve(domain, fields):
        for name, function in fields.items():
            x = adapter.dolfinx.fem.Function(function.function_space)
            x.interpolate(lambda points: points[0] + 10 * points[1])
            seen.append((name, abs(function.x.array - x.x.array).max()))
        u = fem.Function(fem.functionspace(domain, ("Lagrange", 1)))
        u.interpolate(lambda points: points[0] + 10 * points[1])
        means = fem.Function(fem.functionspace(domain, ("DG", 0)))
        means.interpolate(lambda points: points[0] + 10 * points[1])
        return {"u": u, "means": means}

    first = objects.made(square(8), {}, "dolfinx")
    loop = anistar.adapt_loop(solve, first.domain, complexities=(50, 80), like=first.domain)
    last = loop.steps[-1]
    assert anistar.validate(last.mesh) == []
    assert [name for name, _ in seen] == ["u", "means"] * 2
    assert max(off for name, off in seen if name == "u") < 1e-9
    assert max(off for name, off in seen if name == "means") < 3  # interpolated: not exact
    centres = last.mesh.points[last.mesh.cells].mean(axis=1)
    assert np.allclose(last.fields["means"].values, centres @ [1.0, 10.0])
    assert np.allclose(last.fields["u"], last.mesh.points @ [1.0, 10.0])


def test_fields_that_are_given_beside_those_of_an_object_need_not_all_make_a_metric():
    mesh = square()
    held = objects.made(mesh, {"carried": mesh.points[:, 0]}, "meshio")
    given = {"u": front(mesh), "ids": np.arange(mesh.n_points)}
    done = anistar.adapt(held, given, target_complexity=50)
    assert done.report.metric_fields == ("u",)
    assert set(done.fields) == {"u", "ids", "carried"}


def test_problems_in_time_take_the_fields_of_an_object_by_name():
    mesh = square(8)
    grid = objects.made(mesh, {"u": front(mesh), "w": mesh.points[:, 0]}, "meshio")
    seen = []

    def advance(other, fields, begin, end):
        seen.append(type(other))
        return fields

    done = anistar.unsteady_loop(
        advance, grid, "u", [0, 1, 2], window=1, target_complexity=60, like=grid
    )
    assert anistar.validate(done.last.mesh) == []
    assert set(done.last.fields) == {"u"}
    assert set(seen) == {meshio.Mesh}
    again = anistar.unsteady_loop(advance, mesh, front(mesh), [0, 1], target_complexity=60)
    assert set(again.last.fields) == {"u"}


def test_functions_of_finite_element_packages_are_read_at_the_points():
    ngsolve = pytest.importorskip("ngsolve")
    mesh = square(8)
    other = objects.made(mesh, {}, "ngsolve")
    function = ngsolve.GridFunction(ngsolve.H1(other, order=2))
    function.Set(ngsolve.x**2)
    done = anistar.adapt(other, {"u": function}, target_complexity=80)
    assert np.allclose(done.fields["u"], done.mesh.points[:, 0] ** 2, atol=0.02)
    assert anistar.metric.recover_hessian(other, function).shape == (mesh.n_points, 2, 2)


def test_dolfinx_functions_are_read_at_the_points():
    from anistar.adapters.dolfinx import to_function

    mesh = square()
    other = objects.made(mesh, {}, "dolfinx")
    import dolfinx.fem

    space = dolfinx.fem.functionspace(other.domain, ("Lagrange", 1))
    function = to_function(space, front(mesh))
    done = anistar.adapt(other.domain, function, target_complexity=100)
    direct = anistar.adapt(objects.as_mesh(other.domain), front(mesh), target_complexity=100)
    assert np.array_equal(done.mesh.points, direct.mesh.points)


def test_a_planar_polydata_comes_back_as_one(caplog):
    plane = pyvista.Plane(i_resolution=8, j_resolution=8).triangulate()
    plane["u"] = np.tanh(9 * plane.points[:, 0])
    made = anistar.adapt(plane, "u", target_complexity=100, like=plane)
    assert isinstance(made, pyvista.PolyData)
    assert anistar.adapt(plane, target_complexity=50).report.metric_fields == ("u",)
    assert "how a surface looks and not read: the array Normals, TextureCoordinates" in caplog.text
    assert made.is_all_triangles
    assert np.isclose(made.area, 1.0)
    assert made.n_points == len(made["u"])


def test_a_grid_without_facets_gets_none():
    points, cells = square().points, square().cells
    grid = pyvista.UnstructuredGrid(
        {pyvista.CellType.TRIANGLE: cells}, np.pad(points, ((0, 0), (0, 1)))
    )
    grid["u"] = np.tanh(9 * points[:, 0])
    made = anistar.adapt(grid, "u", target_complexity=60, like=grid)
    assert set(made.celltypes) == {pyvista.CellType.TRIANGLE}
    with_facets = anistar.adapt(grid, "u", target_complexity=60, like="pyvista")
    assert set(with_facets.celltypes) >= {pyvista.CellType.TRIANGLE, pyvista.CellType.LINE}


def test_a_file_is_a_mesh_object_too(tmp_path):
    mesh = square()
    path = tmp_path / "in.vtu"
    anistar.write(path, mesh, {"u": front(mesh)})
    assert anistar.validate(path) == []
    done = anistar.adapt(str(path), "u", target_complexity=60)
    assert np.array_equal(
        done.mesh.points, anistar.adapt(mesh, front(mesh), target_complexity=60).mesh.points
    )
    grid = anistar.read(path, like="pyvista")
    assert isinstance(grid, pyvista.UnstructuredGrid)
    anistar.write(tmp_path / "again.vtu", grid)
    assert np.array_equal(anistar.read(tmp_path / "again.vtu")[1]["u"].values, front(mesh))


def test_every_stage_takes_an_object_and_the_name_of_a_metric():
    mesh = square()
    M = anistar.metric.from_sizes(np.full(mesh.n_points, 0.3))
    grid = objects.made(mesh, {"metric": anistar.Field(M), "u": front(mesh)}, "meshio")
    new = anistar.remesh(grid, "metric", like=grid)
    assert isinstance(new, meshio.Mesh)
    done = anistar.remesh(mesh, M)
    held = objects.opened(new)
    assert anistar.validate(new) == []
    assert np.array_equal(held.mesh.points, done.mesh.points)
    assert anistar.certify(new, "metric").simplex_ok.all()
    assert len(anistar.explain_star(new, "metric", 0)) > 0
    assert not anistar.needs_adaptation(new, "metric")
    moved = anistar.transfer(grid, "u", new, method="conservative", like="pyvista")
    assert moved.array_names.count("u") == 1
    assert anistar.transfer_operator(grid, new).shape == (held.mesh.n_points, mesh.n_points)
    assert anistar.metric.complexity(grid, M) == anistar.metric.complexity(mesh, M)
    sizes = anistar.metric.size_near_boundary(grid, 1, 0.1)
    assert np.array_equal(sizes, anistar.metric.size_near_boundary(mesh, 1, 0.1))


@pytest.mark.parametrize("given", [cube(2), Mesh(**square(2).arrays() | {"z": 0.5})])
@pytest.mark.parametrize("form", ["meshio", "pyvista"])
def test_a_flat_example_takes_nothing_from_what_needs_more_room(given, form):
    flat = meshio.Mesh(square(1).points, [("triangle", square(1).cells)])
    surface = objects.made(square(1), {}, "pyvista").extract_surface(algorithm="geometry")
    made = objects.made(given, {}, flat if form == "meshio" else surface)
    again = objects.as_mesh(made)
    assert (again.dim, again.z) == (given.dim, given.z)
    assert np.array_equal(again.points, given.points)
    assert again.n_cells == given.n_cells
    assert anistar.validate(again) == []


def test_cell_sets_of_meshio_become_tags_with_names():
    mesh = two_regions()
    left = mesh.cell_tags == 1
    other = meshio.Mesh(
        mesh.points,
        [("triangle", mesh.cells)],
        cell_sets={"left": [np.flatnonzero(left)], "right": [np.flatnonzero(~left)]},
    )
    again = objects.as_mesh(other)
    assert anistar.validate(again) == []
    assert tags_by_name(again) == {"left": left.sum(), "right": (~left).sum()}


def test_a_loop_gives_its_solver_meshes_of_the_form_it_was_given():
    import skfem
    from skfem.models.poisson import laplace, mass, unit_load

    seen = []

    def solve(mesh, fields):
        seen.append(type(mesh))
        basis = skfem.Basis(mesh, skfem.ElementTriP1())
        A = 1e-3 * laplace.assemble(basis) + mass.assemble(basis)
        b = unit_load.assemble(basis)
        return {"u": skfem.solve(*skfem.condense(A, b, D=basis.get_dofs()))}

    first = skfem.MeshTri.init_lshaped().refined(2)
    loop = anistar.adapt_loop(solve, first, complexities=(60, 120), like=first)
    assert len(loop.steps) == 3
    assert set(seen) == {skfem.MeshTri}
    assert anistar.validate(loop.steps[-1].mesh) == []


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (
            lambda: anistar.adapt(3, np.zeros(4)),
            TypeError,
            "mesh must be an anistar.Mesh, a path, or a mesh of dolfinx, meshio, mfem, "
            "ngsolve, pyvista, skfem, vtk, not int",
        ),
        (
            lambda: anistar.metric.complexity([1, 2], None),
            TypeError,
            "mesh must be an anistar.Mesh, .* not list",
        ),
        (
            lambda: anistar.adapt("nowhere.vtu", "u", target_complexity=10),
            anistar.FormatError,
            "cannot read nowhere.vtu: no such file",
        ),
        (
            lambda: anistar.adapt(square(), "u", target_complexity=10),
            ValueError,
            "the mesh object has no field 'u'; it has none",
        ),
        (
            lambda: anistar.adapt(square(), target_complexity=10),
            ValueError,
            "no fields are given, and the mesh object has none",
        ),
        (
            lambda: anistar.adapt(square(), front(square()), target_complexity=50, like="abaqus"),
            ValueError,
            "no form of meshes is called 'abaqus'; known: dolfinx, meshio,",
        ),
        (
            lambda: anistar.adapt(square(), front(square()), target_complexity=50, like=7),
            TypeError,
            "like must be a mesh object or one of dolfinx, .* not int",
        ),
        (
            lambda: anistar.remesh(objects.made(square(), {"u": front(square())}, "meshio"), "u"),
            ValueError,
            "field 'u' is a scalar on points, no metric at the points",
        ),
        (
            lambda: anistar.adapt(pyvista.Sphere(), target_complexity=10),
            anistar.FormatError,
            "vtkPolyData.* surface mesh",
        ),
    ],
)
def test_what_is_no_mesh_or_field_is_named(call, error, message):
    with pytest.raises(error, match=message):
        call()


def test_a_form_of_ones_own_is_registered():
    class Box:
        def __init__(self, mesh):
            self.mesh = mesh

    objects.register(
        objects.Form(
            name="box",
            accepts=lambda obj: isinstance(obj, Box),
            read=lambda box: objects.Content(box.mesh, {}),
            make=lambda mesh, fields, like: Box(mesh),
        )
    )
    box, fields = anistar.adapt(Box(square()), front(square()), target_complexity=50, like="box")
    assert isinstance(box, Box)
    assert fields["u"].shape == (box.mesh.n_points,)


def test_importing_anistar_imports_no_package_of_mesh_objects():
    program = (
        "import sys, anistar\n"
        "print(sorted({name.partition('.')[0] for name in sys.modules}"
        " & {'pyvista', 'vtkmodules', 'skfem', 'dolfinx', 'ngsolve', 'mfem', 'matplotlib'}))"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "[]"
