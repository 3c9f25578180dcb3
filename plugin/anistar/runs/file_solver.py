"""A solver that is a command: meshes and solutions go through files."""

from __future__ import annotations

import logging
import re
import shlex
import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..base.errors import FormatError
from ..formats import losses, put, read_with_report
from ..meshes.fields import Field, as_fields
from ..meshes.mesh import Mesh
from ..meshes.renumbering import renumbering

_log = logging.getLogger(__name__)

#: Suffix of the mesh file, and that of the solution file.
FILE_KINDS = {
    "mesh": (".mesh", ".sol"),
    "meshb": (".meshb", ".solb"),
    "vtu": (".vtu", ".vtu"),
    "msh": (".msh", ".msh"),
    "su2": (".su2", ".vtu"),
}
#: Those whose mesh files carry fields as well.
_WITH_FIELDS = ("vtu", "msh")
#: Those whose solutions have no mesh of their own, and are read with the mesh of the same name.
_WITHOUT_MESH = (".sol", ".solb")


def exchanged_files(kind: str) -> tuple[str, ...]:
    """Return regular expressions of the names of all files that a `FileSolver` of a kind leaves."""
    mesh_suffix, solution_suffix = FILE_KINDS[kind]
    solution = _solution_stem(r"step_\d{3,}", kind)
    return (
        r"step_\d{3,}" + re.escape(mesh_suffix),
        solution + re.escape(solution_suffix),
        r"step_\d{3,}\.log",
    )


def _solution_stem(mesh_stem: str, kind: str) -> str:
    mesh_suffix, solution_suffix = FILE_KINDS[kind]
    return f"{mesh_stem}_solution" if mesh_suffix == solution_suffix else mesh_stem


class FileSolver:
    """Runs a command for each solve; an instance is the `solve` of `adapt_loop`.

    The command may number points and cells anew: by the mesh in its solution the fields are put
    back into our order. A medit solution has no mesh, and its order must be that of the mesh file.

    Parameters
    ----------
    command : str
        The command with ``{mesh}`` and ``{solution}`` where the paths go. It reads the first and
        writes the second; it runs without a shell.
    folder : path
        Where the files are left: ``step_000.mesh``, what the command printed in
        ``step_000.log``, and so on.
    kind : {"mesh", "meshb", "vtu", "msh", "su2"}
        Formats of the mesh and of the solution, see `FILE_KINDS`. With `vtu` and `msh` the mesh
        file also carries the last fields, as an initial guess.
    first : int
        Number of the first solve, when others were made before.

    Raises
    ------
    ValueError
        If the command lacks a place for a path, or the kind is unknown.
    """

    def __init__(
        self, command: str, folder: str | Path, kind: str = "mesh", *, first: int = 0
    ) -> None:
        for place in ("{mesh}", "{solution}"):
            if place not in command:
                raise ValueError(f"the solver command must contain {place}: {command!r}")
        if kind not in FILE_KINDS:
            raise ValueError(f"file kind must be one of {', '.join(FILE_KINDS)}, not {kind!r}")
        self.command = shlex.split(command)
        self.folder = Path(folder)
        self.kind = kind
        self.count = first
        self._losses_told = False

    def __call__(self, mesh: Mesh, fields: Mapping[str, Any]) -> dict[str, Field]:
        """Write the mesh, run the command, and return the fields it wrote.

        Raises
        ------
        RuntimeError
            If the command fails or writes no solution.
        FormatError
            If its solution cannot be read, or is one on another mesh.
        """
        mesh_file, solution_file = self._paths()
        solution_file.unlink(missing_ok=True)
        sent = as_fields(mesh, fields) if self.kind in _WITH_FIELDS else {}
        self._tell_losses(mesh_file, mesh, sent)
        put(mesh_file, mesh, sent)
        self._run(mesh_file, solution_file)
        if not solution_file.is_file():
            raise RuntimeError(f"the solver wrote no {solution_file}")
        source = mesh_file if solution_file.suffix in _WITHOUT_MESH else solution_file
        solved, found, report = read_with_report(source)
        try:
            found = renumbering(mesh, solved).carried(found)
        except ValueError as error:
            raise FormatError(f"{source} is not the mesh to solve on: {error}") from error
        if not found:
            reason = "; ".join(report.warnings) or "it holds no field"
            raise FormatError(f"no fields in {solution_file}: {reason}")
        self.count += 1
        return found

    def require_command(self) -> None:
        """Raise RuntimeError if there is no such command."""
        if shutil.which(self.command[0]) is None:
            raise RuntimeError(
                f"cannot run the solver {self.command[0]!r}: there is no such command"
            )

    def _tell_losses(self, path: Path, mesh: Mesh, fields: Mapping[str, Field]) -> None:
        """Log once what the command will not be told of the mesh."""
        if not self._losses_told:
            for text in losses(mesh, fields, path):
                _log.warning("%s: this format does not carry %s", path, text)
        self._losses_told = True

    def _paths(self) -> tuple[Path, Path]:
        mesh_suffix, solution_suffix = FILE_KINDS[self.kind]
        stem = f"step_{self.count:03d}"
        solution = _solution_stem(stem, self.kind)
        return self.folder / (stem + mesh_suffix), self.folder / (solution + solution_suffix)

    def _run(self, mesh_file: Path, solution_file: Path) -> None:
        places = {"{mesh}": str(mesh_file), "{solution}": str(solution_file)}
        words = self.command
        for place, path in places.items():
            words = [word.replace(place, path) for word in words]
        log = mesh_file.with_suffix(".log")
        try:
            with log.open("wb") as output:
                done = subprocess.run(words, stdout=output, stderr=output, check=False)
        except OSError as error:
            raise RuntimeError(f"cannot run the solver {words[0]!r}: {error.strerror}") from error
        if done.returncode != 0:
            said = log.read_text(encoding="utf-8", errors="replace").strip() or "it said nothing"
            raise RuntimeError(
                f"the solver ended with code {done.returncode}: {said.splitlines()[-1]} ({log})"
            )
