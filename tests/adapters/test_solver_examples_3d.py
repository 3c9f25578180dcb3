"""The solver examples in three dimensions gain over uniform refinement too."""

import pytest
from example_runs import REGISTERED, gain, run


def test_dolfinx_finds_a_front_in_a_cube_at_a_fifth_of_the_error(tmp_path):
    pytest.importorskip("anistar.adapters.dolfinx", reason="no dolfinx for Python 3.11")
    sizes = {"complexities": (500, 1000, 1500), "sizes": (15,)}
    rows = run("dolfinx/cubic_reaction.py", tmp_path, dim=3, **sizes)
    assert gain(rows) > 5


def test_mfem_finds_boundary_layers_of_a_cube_at_a_fifth_of_the_error(tmp_path):
    pytest.importorskip("anistar.adapters.mfem")
    rows = run("mfem/boundary_layer.py", tmp_path, dim=3, complexities=(500, 1000), sizes=(13,))
    assert gain(rows) > 5


def test_ngsolve_finds_the_stress_in_a_thick_plate_at_seven_tenths_of_the_error(tmp_path):
    pytest.importorskip("anistar.adapters.ngsolve")
    rows = run("ngsolve/plate_with_hole.py", tmp_path, dim=3, complexities=(250,), lengths=(0.19,))
    assert gain(rows) > 1.4


def test_scikit_fem_finds_outflow_layers_in_a_cube_at_a_tenth_of_the_error(tmp_path):
    pytest.importorskip("skfem")
    complexities = (500, 1000, 2000)
    rows = run("scikit_fem/outflow_layers.py", tmp_path, complexities=complexities, sizes=(16,))
    assert gain(rows) > 10


def test_petsc_finds_a_front_in_a_cube_at_a_fifth_of_the_error(tmp_path):
    pytest.importorskip("anistar.adapters.petsc", reason="no petsc4py for Python 3.11")
    sizes = {"dim": 3, "complexities": (250, 500), "sizes": (12,)}
    rows = run("petsc/reaction_diffusion.py", tmp_path, before=REGISTERED, **sizes)
    assert gain(rows) > 5
