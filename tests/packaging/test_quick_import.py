"""What `import anistar` loads, by name: a time would say more of the machine."""

import subprocess
import sys

import pytest

import anistar

SLOW = [
    "meshio", "rich", "matplotlib", "pyvista", "vtkmodules", "skfem",
    "scipy.spatial", "scipy.optimize", "scipy.linalg", "scipy.sparse.linalg",
    "scipy.sparse.csgraph",
]  # fmt: skip

LOADED = "import sys, anistar; print('\\n'.join(sys.modules))"


@pytest.fixture(scope="module")
def loaded():
    done = subprocess.run(
        [sys.executable, "-c", LOADED], capture_output=True, text=True, check=True, timeout=60
    )
    return set(done.stdout.split())


def test_the_package_itself_is_loaded(loaded):
    assert {"anistar", "anistar._core", "numpy", "scipy.sparse"} <= loaded
    assert set(anistar.__all__) <= set(dir(anistar))


@pytest.mark.parametrize("module", SLOW)
def test_importing_anistar_does_not_load(loaded, module):
    assert module not in loaded
