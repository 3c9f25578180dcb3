"""One run in a folder at a time."""

from __future__ import annotations

import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import NamedTuple, TextIO

from ..base.errors import FormatError
from ..base.processes import is_running

try:
    import fcntl
except ImportError:  # on Windows
    fcntl = None  # type: ignore[assignment]

LOCK = ".anistar.lock"

# Held for a moment by the process that removes the lock of a dead one.
TAKEOVER = f"{LOCK}.takeover"

# How often another run may end, and take its file along, between our opening and locking it.
ATTEMPTS = 100

# The files that this process holds where the system has no locks: not every file with its number
# is its own.
_ours: set[str] = set()


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Keep other runs out of a folder.

    The system frees the lock when the process ends, however it ends, so that one that was killed
    blocks nobody. Where the file system has no locks, the file itself stands for one: it is
    made by one process only, and counts as long as that process lives, or runs on another
    machine.

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
        held.release()


class _Held(NamedTuple):
    """A lock file with the number of this process in it."""

    path: Path
    stream: TextIO
    by_system: bool

    def release(self) -> None:
        if not self.by_system:
            self.stream.close()  # Windows removes no open file
            self.path.unlink(missing_ok=True)
            _ours.discard(os.path.realpath(self.path))
            return
        self.stream.truncate(0)
        with suppress(OSError):  # where it stays, an empty one does no harm
            self.path.unlink()  # before it is freed, while nobody else has it
        self.stream.close()


class _Holder(NamedTuple):
    """The process that a lock file names, by its number and machine."""

    pid: str
    host: str

    def __str__(self) -> str:
        elsewhere = f" on {self.host}" if self.host not in ("", socket.gethostname()) else ""
        return (self.pid or "(unknown)") + elsewhere

    def is_dead(self, path: Path) -> bool:
        """Return whether it is known to have ended; one that was not written yet is not."""
        if not self.pid.isdigit() or self.host not in ("", socket.gethostname()):
            return False
        if int(self.pid) == os.getpid():  # ours, or of a process that had the number before
            return os.path.realpath(path) not in _ours
        return not is_running(int(self.pid))


def _acquired(path: Path) -> _Held:
    for _ in range(ATTEMPTS):
        opened = _opened(path)
        if opened is None:
            continue
        stream, is_new = opened
        try:
            by_system = _lock(stream)
            holder = _holder(stream)
            if by_system is False or (
                by_system is None and not is_new and not holder.is_dead(path)
            ):
                raise FormatError(
                    f"{path.parent} is in use by process {holder}: wait until it ends or "
                    "stop it, or choose another folder"
                )
            if _is_still_at(path, stream) if by_system else is_new:
                return _signed(_Held(path, stream, bool(by_system)))
        except BaseException:
            stream.close()
            raise
        stream.close()
        if by_system is None:
            _remove_if_dead(path)
    raise FormatError(f"cannot lock {path.parent}: remove {LOCK} and {TAKEOVER} if no run is there")


def _opened(path: Path) -> tuple[TextIO, bool] | None:
    """Open the file, and return whether this call made it; None if it was removed meanwhile."""
    is_new = True
    try:
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL, 0o666)
    except FileExistsError:
        try:
            descriptor, is_new = os.open(path, os.O_RDWR), False
        except FileNotFoundError:
            return None
    return os.fdopen(descriptor, "r+", encoding="utf-8", errors="replace"), is_new


def _lock(stream: TextIO) -> bool | None:
    """Return whether the system locks an open file for us, None where it has no locks."""
    if fcntl is not None:
        try:
            fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return True
        except BlockingIOError:
            return False
        except OSError:  # the file system has none
            pass
    return None


def _signed(held: _Held) -> _Held:
    """Write who holds the file into it."""
    if not held.by_system:
        _ours.add(os.path.realpath(held.path))
    held.stream.truncate(0)
    held.stream.write(f"{os.getpid()} {socket.gethostname()}")
    held.stream.flush()
    return held


def _holder(stream: TextIO) -> _Holder:
    stream.seek(0)
    pid, _, host = stream.read().strip().partition(" ")
    stream.seek(0)
    return _Holder(pid, host)


def _remove_if_dead(path: Path) -> None:
    """Remove the file of a dead process, as the only one that does, so that it is no new one."""
    guard = path.with_name(TAKEOVER)
    try:
        os.close(os.open(guard, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
    except FileExistsError:
        return
    try:
        with suppress(FileNotFoundError):
            with path.open(encoding="utf-8", errors="replace") as stream:
                is_dead = _holder(stream).is_dead(path)
            if is_dead:
                path.unlink()
    finally:
        guard.unlink()


def _is_still_at(path: Path, stream: TextIO) -> bool:
    try:
        return os.path.samestat(path.stat(), os.fstat(stream.fileno()))
    except FileNotFoundError:
        return False
