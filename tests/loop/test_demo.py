import json
import runpy
from pathlib import Path

import numpy as np
import pytest
from meshes import square

skfem = pytest.importorskip("skfem")
pytest.importorskip("matplotlib")

from anistar.adapters.skfem import from_skfem, to_skfem  # noqa: E402
from anistar.demo import problem as demo_problem  # noqa: E402
from anistar.demo.plane import run_demo, stages  # noqa: E402
from anistar.formats import read  # noqa: E402
from anistar.judging.interpolation_error import l2_norm  # noqa: E402
from anistar.meshes.validation import validate  # noqa: E402
from anistar.transfer import transfer  # noqa: E402

EXAMPLES = Path(__file__).parents[2] / "solver_examples" / "scikit_fem"


@pytest.mark.parametrize("size", [0.05, 0.08, 0.12])
def test_the_channel_is_valid_at_any_size_and_its_sides_are_named(size):
    mesh = demo_problem.channel(size)
    assert validate(mesh) == []
    assert set(mesh.names.values()) == set(demo_problem.SIDES.values())
    assert set(mesh.facet_tags.tolist()) == set(demo_problem.SIDES)


def test_the_temperature_keeps_its_boundary_values():
    mesh = demo_problem.channel()
    u = demo_problem.solve(mesh, {})["u"]
    hot = np.unique(mesh.facets[mesh.facet_tags == 6])
    cold = np.unique(mesh.facets[mesh.facet_tags == 5])
    assert (u[hot] == 1.0).all()
    assert (u[cold] == 0.0).all()


def test_the_demo_beats_uniform_meshes_and_leaves_all_its_files(tmp_path):
    said = []
    demo = run_demo(tmp_path, complexities=(300, 1200), progress=said.append)
    assert demo.rows[-1].gain > 3
    assert demo.adapted_order > demo.uniform_order + 0.5
    assert len(said) == stages((300, 1200))
    names = {path.name for path in tmp_path.iterdir()}
    assert {"channel.pvd", "channel_002.vtu", "overview.png", "convergence.png"} <= names
    assert {path.name for path in demo.files} == names
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["rows"][1]["complexity"] == 1200
    mesh, fields = read(tmp_path / "channel_002.vtu")
    assert mesh.n_points == demo.rows[1].adapted_points
    assert len(fields["u"].values) == mesh.n_points
    stars = demo.loop.steps[-1].report.star_ok
    assert fields["star_ok"].values.mean() == pytest.approx(stars, abs=1e-12)


def test_the_advection_diffusion_example_solves_the_problem_of_the_demo(tmp_path):
    example = runpy.run_path(str(EXAMPLES / "advection_diffusion.py"))
    mesh = demo_problem.channel()
    ours, theirs = demo_problem.solve(mesh, {})["u"], example["solve_heat"](mesh, {})["u"]
    # At the jumps in the boundary values either value is right.
    assert np.abs(ours - theirs).mean() < 0.02
    loop = example["main"]((200, 400), str(tmp_path / "heat.vtu"))
    assert validate(loop.steps[-1].mesh, loop.steps[0].mesh, tolerance=0.02) == []
    assert (tmp_path / "heat.vtu").exists()


def test_the_advection_diffusion_example_has_a_third_of_the_error_on_half_the_unknowns(tmp_path):
    example = runpy.run_path(str(EXAMPLES / "advection_diffusion.py"))
    *_, last, fine = example["main"]((200, 400, 800, 4000), str(tmp_path / "heat.vtu")).steps
    uniform = demo_problem.channel(0.04)
    heat = example["solve_heat"](uniform, {})

    def error(mesh, fields):
        there = transfer(mesh, fields, fine.mesh, outside="nearest").fields["u"]
        return l2_norm(fine.mesh, there - fine.fields["u"])

    assert fine.mesh.n_points > 2 * uniform.n_points > 4 * last.mesh.n_points
    assert error(uniform, heat) > 3 * error(last.mesh, last.fields)


def test_the_poisson_example_converges_at_second_order():
    study = runpy.run_path(str(EXAMPLES / "poisson.py"))["main"]((250, 500, 1000))
    assert study.order == pytest.approx(2.0, abs=0.35)
    assert validate(study.steps[-1].mesh) == []
    # A fifth of the error on half the unknowns, and a tenth at the same complexity.
    (*_, second, third), (*_, uniform) = study.table, study.baselines["uniform"]
    assert uniform.points > 1.8 * second.points
    assert uniform.error > 5 * second.error
    assert uniform.error > 9 * third.error


def test_a_mesh_goes_to_scikit_fem_and_back_with_its_names():
    mesh = square(4)
    other = to_skfem(mesh)
    assert set(other.boundaries) == {"bottom", "left", "right", "top"}
    assert np.array_equal(other.p.T, mesh.points)
    back = from_skfem(other)
    assert validate(back) == []
    assert set(back.names.values()) == set(mesh.names.values())
    tag_of = {name: tag for (_, tag), name in back.names.items()}
    for (_, tag), name in mesh.names.items():
        there = np.unique(back.facets[back.facet_tags == tag_of[name]])
        assert np.array_equal(there, np.unique(mesh.facets[mesh.facet_tags == tag]))


def test_a_mesh_of_scikit_fem_without_names_keeps_points_and_cells():
    other = skfem.MeshTri().refined(2)
    mesh = from_skfem(other)
    assert validate(mesh) == []
    assert mesh.n_points == other.p.shape[1]
    assert mesh.names == {}


def test_overlapping_boundaries_cannot_be_tags():
    other = skfem.MeshTri().with_boundaries(
        {"all": lambda x: x[0] < 2, "left": lambda x: x[0] == 0}
    )
    with pytest.raises(ValueError, match="'left' overlaps 'all': one entity can carry one tag"):
        from_skfem(other)


def test_quadrilaterals_are_split():
    mesh = from_skfem(skfem.MeshQuad())
    assert validate(mesh) == []
    assert (mesh.n_points, mesh.n_cells) == (4, 2)
