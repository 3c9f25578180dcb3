"""DMPlex to Mesh and back with all labels, and anistar inside PETSc."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from meshes import annulus, cube, slit, square, two_region_cube, two_regions

import anistar

petsc = pytest.importorskip("anistar.adapters.petsc", reason="no petsc4py for Python 3.11")
PETSc = petsc.PETSc

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


def measures(mesh, labels):
    """Length or area of the facets with each label and value."""
    sizes = anistar.topology.facet_measures(mesh.points, mesh.facets)
    found = {}
    for (dim, tag), pairs in labels.pairs.items():
        if dim == mesh.dim - 1:
            for pair in pairs:
                found[pair] = found.get(pair, 0.0) + sizes[mesh.facet_tags == tag].sum()
    return found


def completed(mesh):
    """A DMPlex with labels of PETSc's usual kinds: overlapping, completed, on single vertices."""
    plex = petsc.to_dmplex(mesh)
    plex.markBoundaryFaces("marker", 1)
    plex.labelComplete(plex.getLabel("marker"))
    plex.createLabel("probe")
    plex.setLabelValue("probe", plex.getDepthStratum(0)[0] + 2, 5)
    plex.createLabel("empty")
    return plex


def uniform_metric(mesh, h):
    return np.tile(np.eye(mesh.dim) / h**2, (mesh.n_points, 1, 1))


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


def test_uniform_metric_vectors_are_understood():
    plex = petsc.to_dmplex(square(2))
    assert np.array_equal(
        petsc.metric_from_vec(plex, plex.metricCreateUniform(4.0)),
        np.tile(4 * np.eye(2), (9, 1, 1)),
    )


def test_nodal_fields_go_to_vectors_and_back():
    plex = petsc.to_dmplex(square(2))
    scalar, vector = np.arange(9.0), np.arange(18.0).reshape(9, 2)
    assert np.array_equal(petsc.from_vec(plex, petsc.to_vec(plex, scalar)), scalar)
    assert np.array_equal(petsc.from_vec(plex, petsc.to_vec(plex, vector)), vector)
    with pytest.raises(ValueError, match="9 vertices"):
        petsc.to_vec(plex, scalar[:-1])


@pytest.mark.usefixtures("adaptor")
def test_adapt_metric_of_petsc_calls_anistar_and_keeps_labels():
    plex = completed(two_regions(6))
    before = petsc.from_dmplex(plex)
    metric = petsc.metric_to_vec(plex, uniform_metric(before[0], 0.05))
    mesh, labels = petsc.from_dmplex(plex.adaptMetric(metric, "Face Sets", "Cell Sets"))
    assert anistar.validate(mesh) == []
    assert measures(mesh, labels) == pytest.approx(measures(*before), abs=1e-12)
    assert 400 < mesh.n_points < 700


@pytest.mark.usefixtures("adaptor")
def test_adapt_metric_keeps_every_label_in_three_dimensions():
    plex = completed(two_region_cube())
    before = petsc.from_dmplex(plex)
    metric = petsc.metric_to_vec(plex, uniform_metric(before[0], 0.2))
    mesh, labels = petsc.from_dmplex(plex.adaptMetric(metric))
    assert anistar.validate(mesh) == []
    assert measures(mesh, labels) == pytest.approx(measures(*before), abs=1e-9)
    assert {pair for pairs in labels.pairs.values() for pair in pairs} == {
        pair for pairs in before[1].pairs.values() for pair in pairs
    }
    assert 150 < mesh.n_points < 500


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


@pytest.mark.usefixtures("adaptor")
def test_errors_reach_the_caller_as_petsc_errors_with_our_message():
    plex = petsc.to_dmplex(square())
    metric = uniform_metric(square(), 0.1)
    metric[3] = [[1, 0], [0, -2]]
    with pytest.raises(PETSc.Error, match=r"point 3 is not positive definite.*-2\.0e\+00"):
        plex.adaptMetric(petsc.metric_to_vec(plex, metric))


@pytest.mark.usefixtures("adaptor")
def test_options_that_cannot_be_honoured_are_refused():
    plex = petsc.to_dmplex(square())
    plex.metricSetNoInsertion(True)
    with pytest.raises(PETSc.Error, match="-dm_plex_metric_no_insert is not supported"):
        plex.adaptMetric(petsc.metric_to_vec(plex, uniform_metric(square(), 0.1)))


def run(*command):
    """Run another program with the packages of this one."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "OMP_NUM_THREADS": "1"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_a_program_that_knows_nothing_of_anistar_adapts_with_it():
    shown = run(sys.executable, "-m", "anistar.adapters.petsc_program", EXAMPLE)
    rows = [line.split() for line in shown.splitlines()]
    uniform = {int(row[1]): float(row[-1]) for row in rows if row[0] == "uniform"}
    adapted = {int(row[1]): float(row[-1]) for row in rows if row[0] == "adapted"}
    most = max(adapted)
    more = min(n for n in uniform if n >= most)
    assert uniform[more] > 20 * adapted[most]
    assert "anistar" not in EXAMPLE.read_text().split('"""')[2]


PARALLEL = """
import numpy as np
from anistar.adapters import petsc
from anistar.adapters.petsc.plex import plex_of
from anistar.adapters.petsc.library import PETSc
from meshes import two_regions

comm = PETSc.COMM_WORLD
petsc.register()
PETSc.Options()["dm_adaptor"] = "anistar"
mesh = two_regions(12)
plex = plex_of(mesh if comm.rank == 0 else None, petsc.PlexLabels.of_mesh(mesh), comm, 2)
plex.distribute()
x = plex.getCoordinatesLocal().getArray().reshape(-1, 2)[:, 0]
metric = plex.metricCreate()
metric.setArray((np.eye(2) / (0.02 + 0.1 * abs(x - 0.5))[:, None, None] ** 2).ravel())
new = plex.adaptMetric(metric)
span, values = new.getHeightStratum(0), new.getLabelIdIS("Face Sets").getIndices().tolist()
metric.set(-1.0)
try:
    plex.adaptMetric(metric)
except PETSc.Error as error:
    failed = "not positive definite" in str(error)
whole = comm.tompi4py().gather((span[1] - span[0], values, failed))
if comm.rank == 0:
    counts, labels, failures = zip(*whole)
    print(min(counts) > 100, sorted(set().union(*labels)), all(failures))
"""


def test_a_distributed_dmplex_is_gathered_adapted_and_distributed_again(tmp_path):
    program = tmp_path / "parallel.py"
    program.write_text(PARALLEL)
    mpiexec = Path(sys.executable).with_name("mpiexec")
    assert run(mpiexec, "-n", "2", sys.executable, program) == "True [1, 2, 3, 4, 9] True\n"
