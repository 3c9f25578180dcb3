"""Input and output paths of the commands."""

from __future__ import annotations

import os
from pathlib import Path

from ..errors import FormatError
from ..formats import is_known
from ..formats.suffixes import SOLUTION_OF, SOLUTIONS, suffix_of


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
        If the folder does not exist or cannot be written, or the path is a folder or has no
        suffix.
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
    return target


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
    if target in (
        mesh_output,
        mesh_output.with_suffix(SOLUTION_OF.get(suffix_of(mesh_output), "")),
    ):
        raise ValueError(
            f"the metric cannot go to {target}: the mesh or its fields are written there"
        )
    return target
