"""The GMF container behind `.mesh`, `.meshb`, `.sol` and `.solb`, in either encoding.

Both are read into, and written from, one `Container`. Keywords that are not listed there are
skipped and told.
"""

from __future__ import annotations

from pathlib import Path

from ..parsing.reading import reading
from ..suffixes import BINARY, suffix_of
from .gmf_binary import from_bytes, to_bytes
from .gmf_container import Container
from .gmf_text import from_text, to_text


def load(path: Path) -> Container:
    """Read either encoding; the suffix tells which.

    Raises
    ------
    FormatError
        If the file is unreadable, truncated or not what it says.
    """
    with reading(path):
        if suffix_of(path) in BINARY:
            return from_bytes(path.read_bytes())
        return from_text(path.read_text(encoding="utf-8-sig", errors="replace"))


def save(path: Path, container: Container) -> None:
    """Write the encoding that the suffix names."""
    if suffix_of(path) in BINARY:
        path.write_bytes(to_bytes(container))
    else:
        path.write_text(to_text(container), encoding="utf-8")
