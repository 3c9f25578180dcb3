"""Formats that the package gmsh reads, in a process of its own: it may crash on what is damaged."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

from ...base.errors import FormatError
from ...base.extras import install_command
from ..content.raw import RawMesh
from . import reader

#: I-DEAS universal files, Nastran's bulk data, and CGNS.
SUFFIXES = (".unv", ".bdf", ".nas", ".cgns")

#: Longer than any file should take; what is damaged may keep it busy for ever.
MOST_SECONDS = 600.0

_MISSING = 3
_PROGRAM = f"""
import sys
try:
    import gmsh
except ImportError:
    sys.exit({_MISSING})
gmsh.initialize(interruptible=False)
gmsh.option.setNumber("General.Terminal", 0)
try:
    gmsh.merge(sys.argv[1])
    gmsh.option.setNumber("Mesh.SaveAll", 1)
    gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
    gmsh.option.setNumber("Mesh.Binary", 1)
    gmsh.write(sys.argv[2])
except Exception as error:
    sys.exit(str(error))
"""


def read(path: Path) -> RawMesh:
    """Have Gmsh read a file and write its own format, and read that.

    Raises
    ------
    FormatError
        If the package gmsh is missing, or does not get through with the file.
    """
    with tempfile.TemporaryDirectory() as folder:
        converted = Path(folder) / "converted.msh"
        try:
            done = subprocess.run(
                [sys.executable, "-c", _PROGRAM, str(path.resolve()), str(converted)],
                capture_output=True,
                text=True,
                errors="replace",
                check=False,
                timeout=MOST_SECONDS,
            )
        except subprocess.TimeoutExpired as error:
            raise FormatError(
                f"cannot read {path}: gmsh was not done with it after {MOST_SECONDS:g} s"
            ) from error
        if done.returncode == _MISSING:
            raise FormatError(
                f"cannot read {path}: files {path.suffix} are read by the package gmsh, which is "
                f"missing: {install_command('gmsh')}"
            )
        if done.returncode != 0 or not converted.is_file():
            said = done.stderr.strip().splitlines() or [f"it ended with {done.returncode}"]
            raise FormatError(f"cannot read {path}: gmsh does not get through: {said[-1][:200]}")
        try:
            return reader.read(converted)
        except FormatError as error:
            reason = str(error).replace(str(converted), "what gmsh made of it")
            raise FormatError(f"{path}: {reason}") from error
