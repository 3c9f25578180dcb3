"""DMPlex to Mesh and back with all labels, and anistar inside PETSc."""

import ctypes
import sys
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from meshes import annulus, cube, slit, square, two_region_cube, two_regions

import anistar

petsc = pytest.importorskip("anistar.adapters.petsc", reason="no petsc4py for Python 3.11")
PETSc = petsc.PETSc

from plexes import completed, measures, run, uniform_metric  # noqa: E402

EXAMPLE = Path(__file__).resolve().parents[2] / "solver_examples/petsc/reaction_diffusion.py"
TAGGED = [two_regions, slit, annulus, cube, two_region_cube]


@pytest.fixture
def adaptor():
    petsc.register()
    PETSc.Options()["dm_adaptor"] = "anistar"
    yield
    del PETSc.Options()["dm_adaptor"]


def vertices(plex, point):
    first, end = plex.getDepthStratum(0)
    return tuple(sorted(p for p in plex.getTransitiveClosure(point)[0] if first <= p < end))


def strata(plex):
    """The vertices of all points with each value of every label but PETSc's own."""
    names = [plex.getLabelName(i) for i in range(plex.getNumLabels())]
    return {
        (name, int(value)): {
            vertices(plex, point) for point in plex.getStratumIS(name, value).getIndices()
        }
        for name in names
        if name not in {"depth", "celltype"}
        for value in plex.getLabelIdIS(name).getIndices()
    }


@pytest.mark.parametrize("make", TAGGED)
def test_a_mesh_comes_back_from_dmplex_with_points_and_cells_in_order(make):
    mesh = make()
    again, _ = petsc.from_dmplex(petsc.to_dmplex(mesh))
    assert np.array_equal(again.points, mesh.points)
    assert np.array_equal(np.sort(again.cells, axis=1), np.sort(mesh.cells, axis=1))
    assert anistar.validate(again) == []


@pytest.mark.parametrize("make", TAGGED)
def test_cells_of_a_dmplex_have_outward_cones(make):
    plex = petsc.to_dmplex(make())
    _, middle, _ = plex.computeCellGeometryFVM(plex.getHeightStratum(0)[0])
    for facet in plex.getCone(plex.getHeightStratum(0)[0]):
        _, centre, normal = plex.computeCellGeometryFVM(facet)
        if plex.getSupport(facet)[0] == plex.getHeightStratum(0)[0]:
            assert normal @ (centre - middle) > 0


@pytest.mark.parametrize("make", TAGGED)
def test_every_label_on_every_stratum_survives_the_way_to_a_mesh_and_back(make):
    plex = completed(make())
    mesh, labels = petsc.from_dmplex(plex)
    assert strata(petsc.to_dmplex(mesh, labels)) == strata(plex)
    assert "empty" in labels.names


def test_tags_become_values_of_the_usual_labels_and_of_their_names():
    plex = petsc.to_dmplex(two_regions())
    assert plex.getLabelIdIS("Cell Sets").getIndices().tolist() == [1, 2]
    assert plex.getLabelIdIS("Face Sets").getIndices().tolist() == [1, 2, 3, 4, 9]
    same = strata(plex)
    assert same["interface", 9] == same["Face Sets", 9] != set()


def test_labels_survive_remeshing_and_keep_their_lengths():
    mesh, labels = petsc.from_dmplex(completed(two_regions(6)))
    done = anistar.remesh(mesh, uniform_metric(mesh, 0.07))
    assert anistar.validate(done.mesh) == []
    again, same = petsc.from_dmplex(petsc.to_dmplex(done.mesh, labels))
    assert measures(again, same) == pytest.approx(measures(mesh, labels), abs=1e-12)
    assert [tuple(p) for p in again.points[again.corners]] == [tuple(mesh.points[2])]


def test_an_interpolated_simplicial_mesh_is_asked_for():
    quads = PETSc.DMPlex().createBoxMesh([2, 2], simplex=False)
    with pytest.raises(TypeError, match="other than triangles"):
        petsc.from_dmplex(quads)
    bare = PETSc.DMPlex().createFromCellList(
        2, np.array([[0, 1, 2]], PETSc.IntType), np.eye(3)[:, :2].copy(), interpolate=False
    )
    with pytest.raises(ValueError, match=r"depth 1 in dimension 2.*interpolate"):
        petsc.from_dmplex(bare)


def test_a_surface_in_space_is_refused():
    surface = PETSc.DMPlex().createFromCellList(
        2, np.array([[0, 1, 2]], PETSc.IntType), np.eye(3), interpolate=True
    )
    with pytest.raises(ValueError, match="dimension 2 in 3 dimensions"):
        petsc.from_dmplex(surface)


@pytest.mark.parametrize("make", [square, cube])
def test_metrics_go_to_vectors_and_back(make):
    mesh = make()
    plex = petsc.to_dmplex(mesh)
    root = np.random.default_rng(0).normal(size=(mesh.n_points, mesh.dim, mesh.dim))
    metric = np.eye(mesh.dim) + root @ root.transpose(0, 2, 1)
    assert np.array_equal(petsc.metric_from_vec(plex, petsc.metric_to_vec(plex, metric)), metric)


@pytest.mark.parametrize("make", [square, cube])
def test_uniform_and_isotropic_metric_vectors_are_understood(make):
    mesh = make(2)
    plex = petsc.to_dmplex(mesh)
    uniform = petsc.metric_from_vec(plex, plex.metricCreateUniform(4.0))
    assert np.array_equal(uniform, np.tile(4 * np.eye(mesh.dim), (mesh.n_points, 1, 1)))
    plex = petsc.to_dmplex(mesh)
    plex.metricSetIsotropic(True)
    vec = plex.metricCreate()
    vec.setArray(np.arange(1.0, mesh.n_points + 1))
    isotropic = petsc.metric_from_vec(plex, vec)
    assert np.array_equal(isotropic, vec.getArray()[:, None, None] * np.eye(mesh.dim))
    with pytest.raises(ValueError, match=f"2 values does not fit {mesh.n_points}"):
        petsc.metric_from_vec(plex, petsc.PETSc.Vec().createSeq(2))


@pytest.mark.parametrize("make", [square, cube])
def test_nodal_fields_go_to_vectors_and_back(make):
    mesh = make(2)
    plex = petsc.to_dmplex(mesh)
    scalar, vector = mesh.points[:, 0] ** 2, np.arange(mesh.points.size).reshape(mesh.points.shape)
    assert np.array_equal(petsc.from_vec(plex, petsc.to_vec(plex, scalar)), scalar)
    assert np.array_equal(petsc.from_vec(plex, petsc.to_vec(plex, vector)), vector)
    with pytest.raises(ValueError, match=f"{mesh.n_points} vertices"):
        petsc.to_vec(plex, scalar[:-1])


@pytest.mark.usefixtures("adaptor")
@pytest.mark.parametrize(
    ("make", "h", "fewest", "most"),
    [
        (partial(two_regions, 6), 0.05, 400, 700),
        (partial(slit, 6), 0.05, 400, 700),
        (annulus, 0.1, 200, 500),
        (two_region_cube, 0.2, 150, 500),
    ],
)
def test_adapt_metric_of_petsc_calls_anistar_and_keeps_every_label_on_every_stratum(
    make, h, fewest, most
):
    plex = completed(make())
    before = petsc.from_dmplex(plex)
    metric = petsc.metric_to_vec(plex, uniform_metric(before[0], h))
    new = plex.adaptMetric(metric, "Face Sets", "Cell Sets")
    mesh, labels = petsc.from_dmplex(new)
    assert anistar.validate(mesh) == []
    # The circles of the annulus are resampled on smooth curves.
    assert measures(mesh, labels) == pytest.approx(
        measures(*before), rel=2e-2 if make is annulus else 1e-9
    )
    assert labels.completed == before[1].completed
    assert {"empty", "probe", "marker"} <= set(labels.names) == set(before[1].names)
    assert fewest < mesh.n_points < most


def adapt_in_c(plex, metric, boundary, regions):
    """DMAdaptMetric as a C program calls it, which need not take labels from the DM."""
    call = petsc.library.library().DMAdaptMetric
    call.argtypes = [ctypes.c_void_p] * 5
    new = ctypes.c_void_p()
    handles = [None if label is None else label.handle for label in (boundary, regions)]
    assert call(plex.handle, metric.handle, *handles, ctypes.addressof(new)) == 0
    return petsc.library.plex_at(new.value)


@pytest.mark.usefixtures("adaptor")
@pytest.mark.parametrize("make", [square, cube])
def test_labels_that_a_caller_hands_over_are_kept_though_they_are_not_on_the_dm(make):
    mesh = make(4)
    plex = petsc.to_dmplex(mesh)
    kept = len(mesh.facets)
    wall = PETSc.DMLabel().create("wall")
    first, end = plex.getHeightStratum(1)
    for facet in range(first, end):
        corners = plex.vecGetClosure(
            plex.getCoordinateSection(), plex.getCoordinatesLocal(), facet
        ).reshape(-1, mesh.dim)
        if (corners[:, 0] == 0.5).all():
            wall.setValue(facet, 3)
    east = PETSc.DMLabel().create("Face Sets")  # instead of the one of that name
    for cell in range(*plex.getHeightStratum(0)):
        if plex.computeCellGeometryFVM(cell)[1][0] > 0.5:
            east.setValue(cell, 8)
    metric = petsc.metric_to_vec(plex, uniform_metric(mesh, 0.2))
    again, labels = petsc.from_dmplex(adapt_in_c(plex, metric, wall, east))
    assert anistar.validate(again) == []
    found = measures(again, labels)
    assert found[mesh.dim - 1, ("wall", 3)] == pytest.approx(1.0)
    assert found[mesh.dim, ("Face Sets", 8)] == pytest.approx(0.5)
    assert (mesh.dim - 1, ("Face Sets", 1)) not in found
    assert len(petsc.from_dmplex(plex)[0].facets) == kept  # the old DM is as it was


@pytest.mark.usefixtures("adaptor")
def test_the_gradation_factor_of_the_dm_grades_the_metric():
    plex = petsc.to_dmplex(square(16))
    mesh, _ = petsc.from_dmplex(plex)
    h = np.where(np.hypot(*mesh.points.T) < 0.1, 0.01, 0.2)
    metric = np.eye(2) / h[:, None, None] ** 2

    def adapted(factor):
        plex.metricSetGradationFactor(factor)
        return petsc.from_dmplex(plex.adaptMetric(petsc.metric_to_vec(plex, metric)))[0]

    assert adapted(1.3).n_points > 1.5 * adapted(1.0).n_points


@pytest.fixture
def option():
    """Sets options of PETSc's database as a command line does, until the test ends."""
    options, names = PETSc.Options(), []

    def set_option(name, value):
        options[name] = value
        names.append(name)

    yield set_option
    for name in names:
        del options[name]


@pytest.mark.usefixtures("adaptor")
def test_options_are_read_from_the_command_line_and_only_gradation_is_applied(option):
    mesh = square(16)
    h = np.where(np.hypot(*mesh.points.T) < 0.1, 0.01, 0.2)

    def adapted():
        plex = petsc.to_dmplex(mesh)
        metric = petsc.metric_to_vec(plex, np.eye(2) / h[:, None, None] ** 2)
        return petsc.from_dmplex(plex.adaptMetric(metric))[0]

    option("dm_plex_metric_gradation_factor", 1.0)
    bare = adapted()
    for name, value in {"h_min": 0.1, "h_max": 0.15, "a_max": 1.5, "target_complexity": 10}.items():
        option(f"dm_plex_metric_{name}", value)
    assert np.array_equal(adapted().points, bare.points)
    option("dm_plex_metric_gradation_factor", 1.3)
    assert adapted().n_points > 1.5 * bare.n_points
    assert anistar.validate(bare) == []


@pytest.mark.usefixtures("adaptor")
def test_errors_reach_the_caller_as_petsc_errors_with_our_message():
    plex = petsc.to_dmplex(square())
    metric = uniform_metric(square(), 0.1)
    metric[3] = [[1, 0], [0, -2]]
    with pytest.raises(PETSc.Error) as caught:
        plex.adaptMetric(petsc.metric_to_vec(plex, metric))
    assert caught.value.ierr == 76  # PETSC_ERR_LIB
    text = str(caught.value)
    for words in (
        "error code 76",
        "DMAdaptMetric()",
        "anistar: metric at point 3 is not positive definite: smallest eigenvalue -2.0e+00",
    ):
        assert words in text


@pytest.mark.parametrize(
    ("option_name", "value"),
    [("no_insert", 1), ("no_swap", 1), ("no_move", 1), ("no_surf", 1), ("hausdorff_number", 0.2)],
)
@pytest.mark.parametrize("make", [square, cube])
@pytest.mark.usefixtures("adaptor")
def test_options_that_cannot_be_honoured_are_refused(make, option_name, value, option):
    option(f"dm_plex_metric_{option_name}", value)
    plex = petsc.to_dmplex(make())
    metric = petsc.metric_to_vec(plex, uniform_metric(make(), 0.5))
    with pytest.raises(PETSc.Error, match=rf"-dm_plex_metric_{option_name} .*is.* not supported"):
        plex.adaptMetric(metric)


def test_an_interruption_in_the_mesher_is_an_error_for_petsc():
    def interrupt(phase, fraction):
        raise KeyboardInterrupt

    petsc.register("interrupted", remesh_options=anistar.RemeshOptions(callback=interrupt))
    PETSc.Options()["dm_adaptor"] = "interrupted"
    try:
        plex = petsc.to_dmplex(square())
        metric = petsc.metric_to_vec(plex, uniform_metric(square(), 0.02))
        with pytest.raises(PETSc.Error, match="anistar: KeyboardInterrupt"):
            plex.adaptMetric(metric)
    finally:
        del PETSc.Options()["dm_adaptor"]


def test_a_program_that_knows_nothing_of_anistar_adapts_with_it():
    shown = run(sys.executable, "-m", "anistar.adapters.petsc_program", EXAMPLE)
    rows = [line.split() for line in shown.splitlines()]
    uniform = {int(row[1]): float(row[-1]) for row in rows if row[0] == "uniform"}
    adapted = {int(row[1]): float(row[-1]) for row in rows if row[0] == "adapted"}
    most = max(adapted)
    more = min(n for n in uniform if n >= most)
    assert uniform[more] > 20 * adapted[most]
    assert "anistar" not in EXAMPLE.read_text().split('"""')[2]
