"""The solver examples gain over uniform refinement what their pages say."""

import shutil

import pytest
from example_runs import gain, rows_of, run


def test_dolfinx_finds_a_reaction_front_at_a_twentieth_of_the_error(tmp_path):
    pytest.importorskip("anistar.adapters.dolfinx", reason="no dolfinx for Python 3.11")
    rows = run("dolfinx/cubic_reaction.py", tmp_path, complexities=(250, 500, 1000), sizes=(34, 44))
    assert gain(rows) > 20


def test_ngsolve_finds_the_stress_at_a_hole_at_a_third_of_the_error(tmp_path):
    pytest.importorskip("anistar.adapters.ngsolve")
    rows = run("ngsolve/plate_with_hole.py", tmp_path, complexities=(250, 500), lengths=(0.07,))
    assert gain(rows) > 2.5


def test_mfem_finds_boundary_layers_at_a_fortieth_of_the_error(tmp_path):
    pytest.importorskip("anistar.adapters.mfem")
    rows = run("mfem/boundary_layer.py", tmp_path, complexities=(125, 250, 500), sizes=(26, 32))
    assert gain(rows) > 40


def test_freefem_finds_layers_at_a_twentieth_of_the_error_and_keeps_its_labels(tmp_path):
    if shutil.which("FreeFem++") is None:
        pytest.skip("no FreeFem++ on the path: apt-get install freefem++")
    rows = run("freefem/convection.py", tmp_path, complexities=(125, 250, 500), sizes=(26, 32))
    assert gain(rows) > 20


def test_a_mesh_that_follows_a_front_has_a_fifth_of_the_error(tmp_path):
    pytest.importorskip("skfem")
    series = tmp_path / "series.pvd"
    rows = rows_of(
        "scikit_fem/moving_front.py", complexity=400, end=0.1, steps=20, output=str(series)
    )
    (_, uniform_points, uniform), (_, points, following) = rows
    assert points < uniform_points
    assert uniform > 5 * following
    assert series.read_text().count("<DataSet") == 21
