"""The wheel that carries dolfinx and petsc4py."""

import contextlib
import importlib

PETSC_IS_MISSING = (
    "anistar's PETSc adapter needs petsc4py: pip install 'anistar[dolfinx]' or 'anistar[petsc]'"
)


def make_importable() -> None:
    """Let dolfinx and petsc4py be found where the wheel `dolfinx-solver-real` is installed.

    It makes them importable only once it is imported itself; elsewhere nothing happens.
    """
    with contextlib.suppress(ImportError):
        importlib.import_module("dolfinx_solver")
