"""VTK grids to Mesh and back, filters in a pipeline, the ParaView plugin, glyphs."""

import runpy
import sys
import types
from pathlib import Path

import numpy as np
import pytest
from formats.test_element_kinds import of_second_order
from meshes import cube, slit, square, two_region_cube, two_regions
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData, vtkUnstructuredGrid
from vtkmodules.vtkFiltersTensor import vtkTensorPrincipalInvariants
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

import anistar
from anistar.adapters import vtk
from anistar.adapters.vtk.grids import from_vtk_with_report

PLUGIN = Path(vtk.__file__).with_name("paraview_plugin.py")


def fields_of(mesh):
    draw = np.random.default_rng(0).normal
    root = draw(size=(mesh.n_points, mesh.dim, mesh.dim))
    return {
        "u": draw(size=mesh.n_points),
        "v": draw(size=(mesh.n_points, mesh.dim)),
        "m": root + root.transpose(0, 2, 1),
        "p": anistar.Field(draw(size=mesh.n_cells), on="cells"),
        "id": anistar.Field(np.arange(mesh.n_cells), on="cells"),
    }


def assert_same_mesh(one, other):
    for name, array in one.arrays().items():
        assert np.array_equal(array, other.arrays()[name]) if name != "names" else True, name
    assert one.names == other.names


def assert_same_fields(given, found):
    assert found.keys() == given.keys()
    for name, field in given.items():
        expected = field.values if isinstance(field, anistar.Field) else field
        assert np.array_equal(found[name].values, expected), name


@pytest.mark.parametrize("make", [two_regions, slit, cube, two_region_cube])
def test_meshes_with_tags_names_and_fields_go_to_vtk_and_back(make):
    mesh = make()
    fields = fields_of(mesh)
    again, found = vtk.from_vtk(vtk.to_vtk(mesh, fields))
    assert_same_mesh(mesh, again)
    assert_same_fields(fields, found)


@pytest.mark.parametrize("make", [two_regions, two_region_cube])
def test_a_grid_from_a_file_of_ours_is_the_same(make, tmp_path):
    mesh = make()
    anistar.write(tmp_path / "a.vtu", mesh, fields_of(mesh))
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(tmp_path / "a.vtu"))
    reader.Update()
    again, found = vtk.from_vtk(reader.GetOutput())
    assert_same_mesh(mesh, again)
    assert_same_fields(fields_of(mesh), found)


@pytest.mark.parametrize("make", [two_regions, two_region_cube])
def test_arrays_are_shared_where_vtk_has_the_same_layout(make):
    mesh = make()
    fields = {name: fields_of(mesh)[name] for name in "uvm"}
    grid = vtk.to_vtk(mesh, fields)
    data = grid.GetPointData()
    inside = {name: vtk_to_numpy(data.GetArray(name)) for name in fields}
    _, found = vtk.from_vtk(grid)
    shared = {name: np.shares_memory(inside[name], fields[name]) for name in fields}
    back = {name: np.shares_memory(inside[name], found[name].values) for name in fields}
    # In the plane VTK has a third component.
    in_space = mesh.dim == 3
    assert shared == back == {"u": True, "v": in_space, "m": in_space}
    points = vtk_to_numpy(grid.GetPoints().GetData())
    assert np.shares_memory(points, mesh.points) == in_space


def test_values_outlive_the_grid_that_they_are_shared_with():
    mesh = cube(8)
    _, found = vtk.from_vtk(vtk.to_vtk(mesh, {"u": np.arange(float(mesh.n_points))}))
    _ = [np.zeros(mesh.n_points) for _ in range(50)]
    assert np.array_equal(found["u"].values, np.arange(float(mesh.n_points)))


@pytest.mark.parametrize("make", [square, cube])
def test_symmetric_tensors_of_six_components_are_in_the_order_of_vtk(make):
    """VTK's own filter says which component is which: its invariants are the eigenvalues."""
    mesh = make(2)
    M = fields_of(mesh)["m"]
    full = np.zeros((mesh.n_points, 3, 3))
    full[:, : mesh.dim, : mesh.dim] = M
    grid = vtk.to_vtk(mesh)
    six = numpy_to_vtk(full[:, [0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]].copy(), deep=True)
    six.SetName("sigma")
    grid.GetPointData().AddArray(six)
    assert np.array_equal(vtk.from_vtk(grid)[1]["sigma"].values, M)
    invariants = vtkTensorPrincipalInvariants()
    invariants.SetInputData(grid)
    invariants.SetInputArrayToProcess(0, 0, 0, 0, "sigma")
    invariants.Update()
    data = invariants.GetOutput().GetPointData()
    largest = vtk_to_numpy(data.GetArray(invariants.GetSigmaValueArrayName("sigma", 1)))
    assert np.allclose(largest, np.linalg.eigvalsh(full)[:, -1])


def test_anistar_reads_what_vtk_writes(tmp_path):
    mesh = two_regions()
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(tmp_path / "b.vtu"))
    writer.SetInputData(vtk.to_vtk(mesh, {"u": mesh.points[:, 0]}))
    writer.SetDataModeToAscii()
    writer.Write()
    again, found = anistar.read(tmp_path / "b.vtu")
    assert_same_mesh(mesh, again)
    assert np.allclose(found["u"].values, mesh.points[:, 0])


def test_the_grid_keeps_its_numbers_when_python_forgets_them():
    grid = vtk.to_vtk(square(100), {"u": np.arange(101.0**2)})
    _ = [np.zeros((101**2, 3)) for _ in range(50)]
    assert np.array_equal(vtk_to_numpy(grid.GetPointData().GetArray("u")), np.arange(101.0**2))


def test_other_data_is_refused_by_its_type():
    with pytest.raises(TypeError, match="vtkUnstructuredGrid is needed, not vtkPoints"):
        vtk.from_vtk(vtkPoints())
    with pytest.raises(anistar.FormatError, match="vtkPolyData: the mesh is empty"):
        vtk.from_vtk(vtkPolyData())
    with pytest.raises(anistar.FormatError, match="no triangles and no tetrahedra"):
        vtk.from_vtk(vtkUnstructuredGrid())


def front(mesh):
    return {"u": np.tanh(20 * (mesh.points.sum(axis=1) - 1.1)), "other": mesh.points[:, 0]}


def test_the_metric_filter_adds_the_metric_that_from_fields_makes():
    mesh = square(10)
    filter_ = vtk.vtkAnistarMetric()
    filter_.SetInputDataObject(vtk.to_vtk(mesh, front(mesh)))
    filter_.set_fields("u")
    filter_.set_options(target_complexity=500.0, gradation_factor=1.4)
    filter_.Update()
    _, found = vtk.from_vtk(filter_.GetOutputDataObject(0))
    expected, _ = anistar.metric.from_fields(
        mesh,
        {"u": front(mesh)["u"]},
        anistar.MetricOptions(target_complexity=500.0, gradation_factor=1.4),
    )
    assert np.allclose(found["metric"].values, expected)


def test_a_pipeline_of_both_filters_remeshes_and_carries_fields():
    mesh = two_regions(10)
    metric = vtk.vtkAnistarMetric()
    metric.SetInputDataObject(vtk.to_vtk(mesh, front(mesh)))
    metric.set_fields("u")
    adapt = vtk.vtkAnistarAdapt()
    adapt.SetInputConnection(metric.GetOutputPort())
    adapt.Update()
    new, found = vtk.from_vtk(adapt.GetOutputDataObject(0))
    assert anistar.validate(new) == []
    assert new.names == mesh.names
    assert 800 < new.n_points < 1800
    assert np.allclose(found["other"].values, new.points[:, 0])


def test_the_adapt_filter_makes_the_metric_itself_where_there_is_none():
    mesh = square(10)
    adapt = vtk.vtkAnistarAdapt()
    adapt.SetInputDataObject(vtk.to_vtk(mesh, front(mesh)))
    adapt.set_fields("u")
    adapt.set_options(target_complexity=300.0)
    adapt.Update()
    first, _ = vtk.from_vtk(adapt.GetOutputDataObject(0))
    adapt.set_options(target_complexity=900.0)
    adapt.Update()
    second, _ = vtk.from_vtk(adapt.GetOutputDataObject(0))
    assert anistar.validate(second) == []
    assert 2 < second.n_points / first.n_points < 4


def test_a_filter_that_fails_says_why_and_has_no_output():
    mesh = square(4)
    adapt = vtk.vtkAnistarAdapt()
    adapt.SetInputDataObject(vtk.to_vtk(mesh, front(mesh)))
    adapt.set_fields("missing")
    adapt.Update()
    assert "unknown field 'missing'" in adapt.error
    assert adapt.GetOutputDataObject(0).GetNumberOfCells() == 0


def test_unknown_options_are_refused_and_change_nothing():
    adapt = vtk.vtkAnistarAdapt()
    with pytest.raises(ValueError, match="unknown option 'complexity'"):
        adapt.set_options(complexity=3)
    with pytest.raises(ValueError, match="p must"):
        adapt.set_options(p=0.5)
    adapt.set_options(p=4.0)


def passing(*_, **__):
    return lambda decorated: decorated


@pytest.fixture
def paraview(monkeypatch):
    """The modules of ParaView that the plugin imports; their decorators only describe."""
    names = ("smproxy", "smproperty", "smdomain", "smhint")
    module = types.ModuleType("paraview.util.vtkAlgorithm")
    kinds = ("filter", "input", "datatype", "xml", "doublevector", "stringvector")
    for name in names:
        setattr(module, name, types.SimpleNamespace(**dict.fromkeys(kinds, passing)))
    for name in ("paraview", "paraview.util"):
        monkeypatch.setitem(sys.modules, name, types.ModuleType(name))
    monkeypatch.setitem(sys.modules, "paraview.util.vtkAlgorithm", module)
    return sys.modules["paraview"]


@pytest.mark.usefixtures("paraview")
@pytest.mark.parametrize("make", [square, cube])
def test_the_paraview_plugin_offers_both_filters_with_properties(make):
    plugin = runpy.run_path(str(PLUGIN))
    mesh = make(5)
    for name in ("AnistarAdapt", "AnistarMetric"):
        assert "SetTargetComplexity" in vars(plugin[name])  # ParaView looks in no base
        filter_ = plugin[name]()
        filter_.SetInputDataObject(vtk.to_vtk(mesh, front(mesh)))
        filter_.SetTargetComplexity(200.0)
        filter_.SetLargestSize(0.4)
        filter_.SetSmallestSize(0.0)
        filter_.SetLargestAnisotropy(10.0)
        filter_.SetGradationFactor(1.5)
        filter_.SetNorm(2.0)
        filter_.SetPointArrays(None)
        filter_.SetPointArrays("u")
        filter_.Update()
        new, found = vtk.from_vtk(filter_.GetOutputDataObject(0))
        assert anistar.validate(new) == []
        assert (new.n_points != mesh.n_points) == (name == "AnistarAdapt")
        assert ("metric" in found) == (name == "AnistarMetric")


class FilterOfParaView:
    """What `paraview.simple` makes of a filter: properties by their names in the plugin."""

    def __init__(self, made, Input):
        self.__dict__["filter"] = made
        made.SetInputDataObject(Input)

    def __setattr__(self, name, value):
        getattr(self.filter, f"Set{name}")(value)

    def UpdatePipeline(self):  # noqa: N802
        self.filter.Update()

    def GetDataInformation(self):  # noqa: N802
        return self.filter.GetOutputDataObject(0)


def test_the_script_for_paraview_adapts_a_file(paraview, monkeypatch, tmp_path):
    """In VTK's pipeline, through the few calls that the script makes."""
    simple = types.ModuleType("paraview.simple")

    def load(path, remote):
        plugin = runpy.run_path(path)
        simple.AnistarAdapt = lambda Input: FilterOfParaView(plugin["AnistarAdapt"](), Input)

    def opened(path):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(path)
        reader.Update()
        return reader.GetOutput()

    def save(path, adapted):
        adapted.filter.Update()
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetFileName(path)
        writer.SetInputData(adapted.filter.GetOutputDataObject(0))
        writer.Write()

    simple.LoadPlugin, simple.OpenDataFile, simple.SaveData = load, opened, save
    paraview.simple = simple
    monkeypatch.setitem(sys.modules, "paraview.simple", simple)
    mesh = two_regions(10)
    anistar.write(tmp_path / "flow.vtu", mesh, front(mesh))
    words = [str(tmp_path / "flow.vtu"), str(tmp_path / "adapted.vtu"), "300", "u"]
    monkeypatch.setattr(sys, "argv", ["paraview_run.py", *words])
    runpy.run_path(str(PLUGIN.with_name("paraview_run.py")), run_name="__main__")
    new, found = anistar.read(tmp_path / "adapted.vtu")
    assert anistar.validate(new) == []
    assert new.names == mesh.names
    assert 200 < new.n_points < 600
    assert set(found) == {"u", "other"}


@pytest.mark.parametrize("make", [square, cube])
def test_glyphs_are_the_unit_balls_of_the_metric(make):
    mesh = make(3)
    root = np.random.default_rng(1).normal(size=(mesh.n_points, mesh.dim, mesh.dim))
    metric = np.eye(mesh.dim) + root @ root.transpose(0, 2, 1)
    chosen = np.array([0, 3, 5])
    glyphs = vtk.metric_glyphs(mesh, metric, at=chosen, scale=0.25)
    points = vtk_to_numpy(glyphs.GetPoints().GetData())[:, : mesh.dim]
    off = points.reshape(len(chosen), -1, mesh.dim) - mesh.points[chosen, None]
    length = np.sqrt(np.einsum("nbi,nij,nbj->nb", off, metric[chosen], off))
    assert np.allclose(length, 0.25, rtol=1e-5)
    assert glyphs.GetNumberOfCells() % len(chosen) == 0
    with pytest.raises(ValueError, match="scale must be positive, got 0"):
        vtk.metric_glyphs(mesh, metric, scale=0)


def test_a_grid_at_some_height_of_quadrilaterals_is_split_and_stays_there():
    mesh = square(3)
    high = anistar.Mesh(**(mesh.arrays() | {"z": 1.5}))
    grid = vtk.to_vtk(high, {"v": mesh.points})
    assert grid.GetBounds()[4:] == (1.5, 1.5)
    again, fields = vtk.from_vtk(grid)
    assert again.z == 1.5
    assert np.array_equal(fields["v"].values, mesh.points)
    pixels = vtkImageData()
    pixels.SetDimensions(4, 3, 1)
    pixels.SetOrigin(0, 0, 1.5)
    split, _, report = from_vtk_with_report(pixels)
    assert (split.z, split.n_cells, report.split_elements) == (1.5, 12, 6)
    assert anistar.validate(again, high) == anistar.validate(split) == []


def test_the_filter_keeps_to_the_curved_edges_of_a_grid(tmp_path):
    curved = of_second_order(square(2), lambda x: x + 0.05 * np.sin(np.pi * x[::-1]))
    curved.point_data["u"] = np.tanh(5 * curved.points[:, 0])
    curved.write(tmp_path / "m.vtu")
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(tmp_path / "m.vtu"))
    adapted = vtk.vtkAnistarAdapt()
    adapted.set_options(target_complexity=100)
    adapted.SetInputConnection(reader.GetOutputPort())
    adapted.Update()
    new, _ = vtk.from_vtk(adapted.GetOutputDataObject(0))
    outline = np.minimum(new.points, 1 - new.points)[np.unique(new.facets)]
    assert np.count_nonzero(np.abs(outline).min(axis=1) > 0.02) > 8
    assert anistar.validate(new) == []
