"""The wheel that carries dolfinx and petsc4py."""

import contextlib
import importlib

from ..base.extras import install_command


def petsc_is_missing() -> str:
    """Return what to do where there is no petsc4py."""
    return (
        f"anistar's PETSc adapter needs petsc4py: {install_command('dolfinx')} brings it compiled, "
        f"{install_command('petsc')} compiles it"
    )


def make_importable() -> None:
    """Let dolfinx and petsc4py be found where the wheel `dolfinx-solver-real` is installed.

    It makes them importable only once it is imported itself; elsewhere nothing happens.
    """
    with contextlib.suppress(ImportError):
        importlib.import_module("dolfinx_solver")
