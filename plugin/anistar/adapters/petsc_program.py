"""Run a petsc4py program, unchanged, with anistar as PETSc's metric adaptor.

``python -m anistar.adapters.petsc_program PROGRAM.py ARGUMENTS``

is ``python PROGRAM.py ARGUMENTS -dm_adaptor anistar`` with anistar registered.
"""

from __future__ import annotations

import importlib
import runpy
import sys

from . import dolfinx_wheel


def main() -> None:
    """Register, then run as a script the program that the command line names."""
    if len(sys.argv) < 2:
        raise SystemExit("usage: python -m anistar.adapters.petsc_program PROGRAM.py [ARGUMENTS]")
    sys.argv = sys.argv[1:]
    # PETSc reads its options when petsc4py is initialised, which importing the adapter does.
    dolfinx_wheel.make_importable()
    try:
        petsc4py = importlib.import_module("petsc4py")
    except ImportError as error:
        raise SystemExit(f"{error}; {dolfinx_wheel.petsc_is_missing()}") from error
    petsc4py.init([*sys.argv, "-dm_adaptor", "anistar"])
    importlib.import_module("anistar.adapters.petsc").register()
    runpy.run_path(sys.argv[0], run_name="__main__")


if __name__ == "__main__":
    main()
