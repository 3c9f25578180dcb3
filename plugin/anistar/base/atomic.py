"""Write a file under a temporary name and move it, so that no crash leaves half a file."""

from __future__ import annotations

import itertools
import os
import re
import shutil
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from .errors import FormatError
from .processes import is_running

# Tells apart what the threads of one process write at the same time.
_counter = itertools.count()

_TEMPORARY = re.compile(r"\.(?P<stem>.+)\.(?P<pid>\d+)(-\d+)?\.part(?P<suffix>(\.\w+)?)")


def remove_leftovers(folder: Path, is_own: Callable[[str], bool]) -> None:
    """Remove the temporary files that a killed process left in a folder, and nothing else.

    Parameters
    ----------
    folder : path
    is_own : callable
        Whether a name is one of those that the caller writes into the folder. A temporary file
        of another name stays, and so does one that a living process may still be writing.
    """
    for path in folder.iterdir():
        match = _TEMPORARY.fullmatch(path.name)
        if match is None or not is_own(match["stem"] + match["suffix"]):
            continue
        # A file with our own number is of a process that had it before us.
        is_alive = int(match["pid"]) != os.getpid() and is_running(int(match["pid"]))
        if path.is_file() and not is_alive:
            path.unlink(missing_ok=True)


@contextmanager
def replaced(path: Path) -> Iterator[Path]:
    """Give a temporary path in the same folder; move it to `path` when the block succeeds.

    Raises
    ------
    FormatError
        If the folder does not exist or cannot be written.
    """
    with all_replaced([path]) as (temporary,):
        yield temporary


@contextmanager
def all_replaced(paths: Sequence[Path]) -> Iterator[list[Path]]:
    """Give a temporary path for each path; move all of them when the block succeeds.

    Nothing is moved before everything has reached the disk, so that files that belong together
    are replaced together, in the order of `paths`. A link keeps pointing to where it does: its
    target is replaced.

    Raises
    ------
    FormatError
        If a folder does not exist or cannot be written; names the path.
    """
    targets = [Path(os.path.realpath(path)) for path in paths]
    temporaries = [
        _temporary(target, path.suffix) for target, path in zip(targets, paths, strict=True)
    ]
    staged = list(zip(paths, temporaries, targets, strict=True))
    try:
        for path, temporary, _ in staged:
            with _writing(path):
                if path.is_dir():
                    raise FormatError(f"cannot write {path}: it is a folder")
                temporary.touch()
        with _writing(paths[0]):
            yield temporaries
        for path, temporary, _ in staged:
            with _writing(path):
                _bring_to_disk(temporary)
        for path, temporary, target in staged:
            with _writing(path):
                if target.exists():
                    shutil.copymode(target, temporary)
                temporary.replace(target)
    finally:
        for temporary in temporaries:
            with suppress(OSError):  # it was moved, or there is no such folder
                temporary.unlink()
    for folder in {target.parent for target in targets}:
        # The files are whole in any case; some systems cannot do this for a folder.
        with suppress(OSError):
            _bring_to_disk(folder)


@contextmanager
def _writing(path: Path) -> Iterator[None]:
    """Name the path in the error of the system."""
    try:
        yield
    except OSError as error:
        raise FormatError(f"cannot write {path}: {error.strerror or error}") from error


def _temporary(target: Path, suffix: str) -> Path:
    # The suffix is kept because some writers choose the format by it.
    return target.with_name(f".{target.stem}.{os.getpid()}-{next(_counter)}.part{suffix}")


def _bring_to_disk(path: Path) -> None:
    """Wait until a file, or what a folder lists, would outlast a loss of power."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
