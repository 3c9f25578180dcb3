"""Standard streams that are closed, or that nobody reads any more.

A command does its work all the same, and its exit code tells of the work.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress


def open_closed_streams() -> None:
    """Put nothing in the place of streams that the caller closed, as a shell does by ``>&-``.

    The numbers 0, 1 and 2 are taken as well, so that no file that is opened later gets one of
    them, and with it what another library prints.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.set_inheritable(os.open(os.devnull, os.O_RDWR), True)  # the lowest free number
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, os.fdopen(os.open(os.devnull, os.O_WRONLY), "w"))


@contextmanager
def readers_may_leave() -> Iterator[None]:
    """Print as long as somebody reads: that `head` has seen enough is no error.

    Raises
    ------
    RuntimeError
        If what is printed is lost for another reason, such as a full disk.
    """
    _take_no_signal()
    try:
        yield
        sys.stdout.flush()
    except BrokenPipeError:
        _print_to_nowhere()
    except OSError as error:
        _print_to_nowhere()
        raise RuntimeError(f"cannot print: {error.strerror or error}") from error


def complain(text: str) -> None:
    """Print one line on stderr, if anybody reads it."""
    _take_no_signal()
    with suppress(BrokenPipeError):
        print(text, file=sys.stderr)


def _take_no_signal() -> None:
    """Get an exception where the reader has gone; PETSc would end the process at the signal."""
    with suppress(AttributeError, ValueError):  # no such signal, or not in the main thread
        signal.signal(signal.SIGPIPE, signal.SIG_IGN)


def _print_to_nowhere() -> None:
    """Drop what is printed from now on, and what would fail again when it is flushed at exit."""
    with suppress(OSError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
