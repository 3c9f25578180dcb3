"""Write a file under a temporary name and move it, so that no crash leaves half a file."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ..errors import FormatError


def remove_leftovers(folder: Path) -> None:
    """Remove the temporary files that a killed process left in a folder."""
    for path in folder.glob(".*.part*"):
        path.unlink()


@contextmanager
def replaced(path: Path) -> Iterator[Path]:
    """Give a temporary path in the same folder; move it to `path` when the block succeeds.

    Raises
    ------
    FormatError
        If the folder does not exist or cannot be written.
    """
    # The suffix is kept because some writers choose the format by it.
    temporary = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    try:
        if path.is_dir():
            raise FormatError(f"cannot write {path}: it is a folder")
        temporary.touch()
        yield temporary
        temporary.replace(path)
    except OSError as error:
        raise FormatError(f"cannot write {path}: {error.strerror or error}") from error
    finally:
        temporary.unlink(missing_ok=True)
