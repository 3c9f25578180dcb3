"""One run in a folder at a time."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TextIO

from .errors import FormatError
from .processes import is_running

try:
    import fcntl
except ImportError:  # on Windows
    fcntl = None  # type: ignore[assignment]

LOCK = ".anistar.lock"

# How often another run may end, and take its file along, between our opening and locking it.
ATTEMPTS = 100


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Keep other runs out of a folder.

    The system frees the lock when the process ends, however it ends, so that one that was killed
    blocks nobody. Where the file system has no locks, a file with the number of a living process
    stands for one.

    Raises
    ------
    FormatError
        If a run in this folder goes on; names the folder and the process. Or if the folder
        cannot be written.
    """
    path = folder / LOCK
    try:
        held = _acquired(path)
    except OSError as error:
        raise FormatError(f"cannot write {path}: {error.strerror or error}") from error
    try:
        yield
    finally:
        held.truncate(0)
        with suppress(OSError):  # where open files stay, an empty one does no harm
            path.unlink()  # before it is freed, while nobody else has it
        held.close()


def _acquired(path: Path) -> TextIO:
    """Return the locked file, with the number of this process in it."""
    for _ in range(ATTEMPTS):
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        stream = os.fdopen(descriptor, "r+", encoding="ascii", errors="replace")
        try:
            if not _is_free(stream):
                raise FormatError(
                    f"{path.parent} is in use by process {_holder(stream)}: wait until it ends or "
                    "stop it, or choose another folder"
                )
            if _is_still_at(path, stream):
                stream.truncate(0)
                stream.write(str(os.getpid()))
                stream.flush()
                return stream
        except BaseException:
            stream.close()
            raise
        stream.close()
    raise FormatError(f"cannot lock {path.parent}: {path.name} does not stay where it is")


def _is_free(stream: TextIO) -> bool:
    """Lock an open file for this process, and return whether that was possible."""
    if fcntl is not None:
        try:
            fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return True
        except BlockingIOError:
            return False
        except OSError:  # the file system has no locks
            pass
    holder = _holder(stream)
    return not holder.isdigit() or int(holder) == os.getpid() or not is_running(int(holder))


def _holder(stream: TextIO) -> str:
    """Return the number of the process that a lock file names."""
    stream.seek(0)
    said = stream.read().strip()
    stream.seek(0)
    return said or "(unknown)"


def _is_still_at(path: Path, stream: TextIO) -> bool:
    try:
        return os.path.samestat(path.stat(), os.fstat(stream.fileno()))
    except FileNotFoundError:
        return False
