"""PyVista's data sets have what anistar does at hand, whichever of the two is imported first."""

import subprocess
import sys

import numpy as np
import pytest
import pyvista
from meshes import cube, square

import anistar
from anistar import objects


def held_grid(mesh):
    u = np.tanh(8 * (mesh.points.sum(axis=1) - 1))
    return objects.made(mesh, {"u": u}, "pyvista")


@pytest.mark.parametrize("make", [square, cube], ids=["2d", "3d"])
def test_a_data_set_is_adapted_in_one_line(make):
    grid = held_grid(make())
    fine = grid.anistar.adapt("u", target_complexity=200)
    assert isinstance(fine, pyvista.UnstructuredGrid)
    assert fine.anistar.validate() == []
    direct = anistar.adapt(grid, "u", target_complexity=200)
    assert np.array_equal(fine.anistar.mesh.points, direct.mesh.points)
    assert np.array_equal(fine["u"], direct.fields["u"].values)


def test_every_step_is_there():
    grid = held_grid(square())
    M = grid.anistar.metric("u", target_complexity=60)
    new = grid.anistar.remesh(M)
    assert new.anistar.certify().simplex_ok.all()
    moved = grid.anistar.transfer(new)
    assert len(moved["u"]) == new.n_points


@pytest.mark.parametrize("order", ["anistar, pyvista", "pyvista, anistar"])
def test_the_order_of_imports_does_not_matter(order):
    program = f"import {order}\nprint(pyvista.Plane().triangulate().anistar.mesh.n_points)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == "121"


@pytest.mark.parametrize(
    "looked",
    ["importlib.util.find_spec('pyvista')", "importlib.util.find_spec('pyvista').loader.name"],
)
def test_looking_for_the_package_changes_nothing(looked):
    program = (
        f"import importlib.util, sys, anistar\n{looked}\nimport pyvista\n"
        "print(pyvista.Plane().triangulate().anistar.mesh.n_points)\n"
        "print(type(pyvista.__loader__).__name__, type(pyvista.__spec__.loader).__name__)\n"
        "print([1 for finder in sys.meta_path if type(finder).__name__ == '_Watch'])"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split("\n")[:3] == ["121", "SourceFileLoader SourceFileLoader", "[]"]


@pytest.mark.parametrize(("first", "second"), [("anistar", "pyvista"), ("pyvista", "anistar")])
def test_an_accessor_that_cannot_be_made_stops_neither_package(first, second):
    program = (
        f"import sys\nsys.modules['anistar.adapters.vtk.accessor'] = None\nimport {first}\n"
        f"import {second}\nprint(pyvista.Plane().n_points)"
    ).replace("print(", "import pyvista\nprint(")
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == "121"
    assert "pyvista has no accessor of anistar" in done.stderr


def test_a_package_that_is_missing_stays_missing():
    program = (
        "import sys\n"
        "from anistar.objects.after_import import after_import\n"
        "after_import('no_such_package', lambda: print('called'))\n"
        "try:\n    import no_such_package\nexcept ModuleNotFoundError as error:\n    print(error)"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.stdout.strip() == "No module named 'no_such_package'"
