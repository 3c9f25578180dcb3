"""Input and output paths of the commands."""

from __future__ import annotations

import os
from pathlib import Path

from ..errors import FormatError


def writable(path: str) -> Path:
    """Return the output path, checked before anything is computed.

    Raises
    ------
    FormatError
        If the folder does not exist or cannot be written, or the path is a folder.
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


def companion(path: str) -> Path | None:
    """Return the medit solution beside a mesh file, if there is one."""
    for suffix in (".sol", ".solb"):
        beside = Path(path).with_suffix(suffix)
        if beside.is_file():
            return beside
    return None
