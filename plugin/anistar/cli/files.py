"""Input and output paths of the commands."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from ..base.errors import FormatError
from ..formats import is_known
from ..formats.content.series import numbered
from ..formats.suffixes import SOLUTION_OF, SOLUTIONS, solution_beside, suffix_of
from ..formats.vtk import pvd


def writable(path: str, *, is_mesh: bool = True) -> Path:
    """Return the path of a mesh or a solution, checked before anything is computed.

    Raises
    ------
    FormatError
        If the folder does not exist or cannot be written, the path is a folder, no format has
        its suffix, or the format holds no mesh although `is_mesh`.
    """
    target = writable_file(path)
    if not is_known(target):
        raise FormatError(f"cannot write {target}: no format has the suffix {target.suffix!r}")
    if is_mesh and suffix_of(target) in SOLUTIONS:
        raise FormatError(f"cannot write {target}: a solution file holds no mesh")
    return target


def writable_file(path: str) -> Path:
    """Return the path of any output file, checked before anything is computed.

    Raises
    ------
    FormatError
        If the folder does not exist or cannot be written, or the path is a folder, a file that
        is read-only, or has no suffix.
    """
    target = Path(path)
    if target.is_dir():
        raise FormatError(f"cannot write {target}: it is a folder")
    if not target.suffix:
        raise FormatError(
            f"cannot write {target}: the suffix, which chooses the format, is missing"
        )
    if not target.parent.is_dir():
        raise FormatError(f"cannot write {target}: no such folder {target.parent}")
    if not os.access(target.parent, os.W_OK):
        raise FormatError(f"cannot write {target}: folder {target.parent} is not writable")
    if target.exists() and not os.access(target, os.W_OK):
        raise FormatError(f"cannot write {target}: it is read-only")
    return target


def new_file(path: str, *, force: bool, keep: Iterable[str]) -> Path:
    """Return the path of an output file that replaces no other unless it is told to.

    Parameters
    ----------
    path : str
    force : bool
        It may replace a file.
    keep : iterable of str
        Files that it must not replace in any case, such as the input.

    Raises
    ------
    FormatError
        As `writable_file`, or if there is such a file already.
    """
    target = writable_file(path)
    if any(_is_same(target, Path(other)) for other in keep):
        raise FormatError(f"cannot write {target}: it is the input")
    if target.exists() and not force:
        raise FormatError(f"{target} exists: --force replaces it, or choose another name")
    return target


def replaced_inputs(inputs: Iterable[str | None], output: Path, *others: Path | None) -> list[str]:
    """Return the input files that are about to be replaced by an output.

    A medit mesh stands for its solution as well, among the inputs and the outputs. A hard link is
    another name of what was there before, and keeps it.

    Parameters
    ----------
    inputs : iterable of str or None
        What the command reads, None for what was not given.
    output : Path
        A mesh or a solution.
    *others : Path or None
        Further outputs, which stand for themselves.

    Raises
    ------
    FormatError
        If the output is a series that an input is, or is a part of.
    """
    given = [numbered(Path(path))[0] for path in inputs if path]
    if suffix_of(output) == ".pvd":
        require_apart(given, output, 1)
    beside = SOLUTION_OF.get(suffix_of(output))
    written = [output, *filter(None, others)]
    written += [output.with_suffix(beside)] if beside else []
    read = [*given, *filter(None, map(solution_beside, given)), *_members(given)]
    found = [path for path in read if any(_is_same(path, target) for target in written)]
    return list(dict.fromkeys(map(str, found)))


def require_apart(inputs: Iterable[Path], output: Path, count: int) -> None:
    """Raise if a series of so many meshes goes where an input is.

    Raises
    ------
    FormatError
        Names the input, and what of the series is there.
    """
    files = [output, *pvd.listed(output), *(pvd.member(output, k) for k in range(count))]
    for path in inputs:
        for read in (path, *_members([path])):
            if any(_is_same(read, file) for file in files):
                raise FormatError(
                    f"cannot write the series {output}: {read}, which is read, is a part of it; "
                    "choose another name"
                )


def _members(paths: Iterable[Path]) -> list[Path]:
    """Return the files that the series among some paths list."""
    return [file for path in paths if suffix_of(path) == ".pvd" for file in pvd.listed(path)]


def _is_same(one: Path, other: Path) -> bool:
    """Return whether writing to one path replaces what is at the other."""
    if os.path.realpath(one) == os.path.realpath(other):
        return True
    # As on file systems without capitals. Hard links are several entries, and one is replaced.
    return one.exists() and other.exists() and one.samefile(other) and other.stat().st_nlink == 1


def metric_target(path: str | None, mesh_output: Path) -> Path | None:
    """Return the checked path of the metric, if there is one.

    Raises
    ------
    FormatError
        If the path cannot be written.
    ValueError
        If the mesh or its fields are written there.
    """
    if not path:
        return None
    target = writable(path, is_mesh=False)
    solution = mesh_output.with_suffix(SOLUTION_OF.get(suffix_of(mesh_output), ""))
    if _is_same(target, mesh_output) or _is_same(target, solution):
        raise ValueError(
            f"the metric cannot go to {target}: the mesh or its fields are written there"
        )
    return target
