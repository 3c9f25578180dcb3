"""What beginners do, and what they are told."""

import numpy as np
import pytest
from meshes import cube, square

import anistar
from anistar import LoopOptions, Mesh, MetricOptions, RemeshOptions


def test_a_mesh_is_made_of_points_and_cells_by_position():
    mesh = square()
    again = Mesh(mesh.points, mesh.cells)
    assert anistar.validate(again) == []
    with pytest.raises(TypeError, match="takes 3 positional arguments but 4"):
        Mesh(mesh.points, mesh.cells, mesh.cell_tags)


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (
            lambda: LoopOptions((100, 200)),
            TypeError,
            r"LoopOptions takes its options by name, got \(100, 200\) without one; the names "
            "are adapt, complexities,",
        ),
        (
            lambda: MetricOptions(target_complexty=9),
            TypeError,
            "MetricOptions has no option 'target_complexty': did you mean 'target_complexity'",
        ),
        (
            lambda: RemeshOptions(xyz=9),
            TypeError,
            "RemeshOptions has no option 'xyz': known: agreement, callback,",
        ),
        (
            lambda: MetricOptions(target_complexity="1000"),
            TypeError,
            "target_complexity must be a number, got '1000'",
        ),
        (
            lambda: LoopOptions(target_error="1e-3"),
            TypeError,
            "target_error must be a number, got '1e-3'",
        ),
        (
            lambda: RemeshOptions(max_seconds="3"),
            TypeError,
            "max_seconds must be a number, got '3'",
        ),
        (
            lambda: MetricOptions(size_at=0.1),
            TypeError,
            "size_at must be like {'wall': 0.02}, got 0.1",
        ),
        (
            lambda: anistar.Field(np.ma.masked_less(np.arange(5.0), 2)),
            ValueError,
            "2 values are masked, the first is value 0: give what is to stand there",
        ),
        (
            lambda: adapted(np.ma.masked_equal(np.arange(25.0), 7)),
            ValueError,
            "field 'u': 1 values are masked, the first is value 7",
        ),
        (
            lambda: adapted(np.arange(25)),
            ValueError,
            r"the fields are: u \(label, points\); whole numbers are labels, give them",
        ),
        (
            lambda: anistar.adapt(square(), {"u": np.arange(25) > 7}, target_complexity=9),
            ValueError,
            "no scalar or vector .* whole numbers are labels, give them as floats",
        ),
        (
            lambda: anistar.metric.recover_hessian(
                square(), np.ma.masked_equal(np.arange(25.0), 7)
            ),
            ValueError,
            "1 values are masked, the first is value 7",
        ),
    ],
)
def test_a_mistake_is_named(call, error, message):
    with pytest.raises(error, match=message):
        call()


def adapted(values):
    return anistar.adapt(square(), values, target_complexity=9)


def test_a_mask_that_hides_nothing_does_no_harm():
    values = np.ma.MaskedArray(np.tanh(9 * square(8).points[:, 0]), mask=False)
    done = anistar.adapt(square(8), values, target_complexity=60)
    assert anistar.validate(done.mesh) == []


def test_a_field_without_features_is_told(caplog):
    done = anistar.adapt(
        square(), {"a": np.ones(25), "b": square().points[:, 0]}, p=2.0, target_complexity=50
    )
    assert anistar.validate(done.mesh) == []
    assert "no second derivative above the noise in a, b: the mesh is uniform" in caplog.text
    caplog.clear()
    anistar.adapt(square(8), np.tanh(9 * square(8).points[:, 0]), target_complexity=60)
    assert caplog.text == ""


def test_sizes_stand_for_a_metric():
    mesh = square()
    done = anistar.remesh(mesh, 0.1)
    assert anistar.validate(done.mesh) == []
    assert np.allclose(done.metric, 100 * np.eye(2))
    same = anistar.remesh(mesh, np.full(mesh.n_points, 0.1))
    assert np.array_equal(same.mesh.points, done.mesh.points)
    assert anistar.certify(done, 0.1).simplex_ok.all()
    with pytest.raises(ValueError, match="7 sizes are given, the mesh has 25 points"):
        anistar.remesh(mesh, np.ones(7))
    with pytest.raises(ValueError, match="size at point 0 must be positive and finite"):
        anistar.remesh(mesh, -0.1)


def test_results_are_written_and_adapted_as_they_are(tmp_path):
    mesh = square(8)
    u = np.tanh(9 * mesh.points[:, 0])
    done = anistar.adapt(mesh, u, target_complexity=60)
    anistar.write(tmp_path / "done.vtu", done)
    again, fields = anistar.read(tmp_path / "done.vtu")
    assert anistar.validate(again) == []
    assert np.array_equal(fields["u"].values, done.fields["u"])
    further = anistar.adapt(done, "u", target_complexity=90)
    assert anistar.validate(further.mesh) == []
    anistar.write(tmp_path / "plain.vtu", mesh, u)
    assert np.array_equal(anistar.read(tmp_path / "plain.vtu")[1]["u"].values, u)
    with pytest.raises(TypeError, match="the path comes first, then the mesh: got Mesh"):
        anistar.write(mesh, tmp_path / "x.vtu")


def test_an_array_leaves_the_fields_of_an_object_as_they_are():
    mesh = square(8)
    held = anistar.objects.made(mesh, {"u": mesh.points[:, 0]}, "meshio")
    done = anistar.adapt(held, np.tanh(9 * mesh.points[:, 1]), target_complexity=60)
    assert done.report.metric_fields == ("u_",)
    assert np.allclose(done.fields["u"].values, done.mesh.points[:, 0])


def test_one_complexity_is_a_loop_of_one_adaptation():
    def solve(mesh, fields):
        return {"u": np.tanh(9 * mesh.points[:, 0])}

    loop = anistar.adapt_loop(solve, square(8), complexities=60)
    assert len(loop.steps) == 2


def test_a_solver_in_time_that_loses_a_field_is_told():
    def advance(mesh, fields, begin, end):
        return {"v": fields["u"]}

    with pytest.raises(anistar.MeshingError, match="returned the fields v, without u, which it"):
        anistar.unsteady_loop(advance, square(), np.zeros(25), [0, 1], target_complexity=9)


def test_a_budget_that_ends_the_work_is_told(caplog):
    mesh = square(8)
    M = anistar.metric.from_sizes(np.full(mesh.n_points, 0.02))
    done = anistar.remesh(mesh, M, max_vertices=100)
    assert anistar.validate(done.mesh) == []
    assert "stopped by max_vertices: this is not the mesh that the metric asks for" in caplog.text
    assert done.report.warnings[0].startswith("stopped by max_vertices")


def test_a_volume_like_a_surface_keeps_its_cells():
    pyvista = pytest.importorskip("pyvista")
    grid = anistar.objects.made(cube(), {}, pyvista.Sphere())
    assert anistar.validate(grid, cube()) == []
    assert anistar.objects.as_mesh(grid).n_cells == cube().n_cells


def test_sizes_that_are_no_numbers_are_named():
    with pytest.raises(TypeError, match=r"size_at\['rubber'\] must be a number, got 'fine'"):
        MetricOptions(size_at={"rubber": "fine"})
