"""Progress of long calls: one display for a call and for all that it calls."""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar, copy_context
from dataclasses import dataclass, field

from .screens import Row, Screen, screen_for

#: Calls that take less are not shown.
SECONDS_BEFORE_DISPLAY = 1.0
SECONDS_BETWEEN_FRAMES = 0.125

ENVIRONMENT = "ANISTAR_PROGRESS"

Callback = Callable[[str, float], object]
"""``callback(phase, fraction)``, as the user gives it."""

CoreCallback = Callable[[str, float, int], object]
"""The same with the number of vertices, as the core calls it."""

_asked: bool | None = None
_is_quiet: ContextVar[bool] = ContextVar("is_quiet", default=False)
_lock = threading.Lock()


def progress(shown: bool | None) -> None:
    """Say whether long calls show how far they are, from now on.

    Parameters
    ----------
    shown : bool or None
        None, which holds at first, does what the environment variable ``ANISTAR_PROGRESS`` says
        (0 or 1); without it progress is shown on a terminal and in a notebook. True shows it
        elsewhere too, as lines on stderr.
    """
    global _asked
    if shown is not None and not isinstance(shown, bool):
        raise TypeError(f"progress takes True, False or None, not {shown!r}")
    _asked = shown


@contextmanager
def quiet(is_quiet: bool = True) -> Iterator[None]:
    """Show no progress of what this thread does in the block, or leave it as it is."""
    token = _is_quiet.set(is_quiet or _is_quiet.get())
    try:
        yield
    finally:
        _is_quiet.reset(token)


@dataclass(eq=False)
class Task:
    """A call that is under way, and how far it is.

    Attributes
    ----------
    name : str
        What is done.
    total : int or None
        How many steps it takes, if that is known.
    is_shown : bool
        Whether anybody looks.
    phase : str
        What it is about now.
    fraction : float or None
        How far the phase, or of those with a `total` the whole, is.
    note : str
        What else is worth knowing.
    expected_seconds : float or None
        How long it will take, as far as that can be told.
    """

    name: str
    total: int | None = None
    is_shown: bool = False
    phase: str = ""
    fraction: float | None = None
    note: str = ""
    expected_seconds: float | None = None
    steps: int = 0
    began: float = field(default_factory=time.perf_counter)

    def enter(self, phase: str, fraction: float | None = None, note: str | None = None) -> None:
        """Tell the phase, how far it is, and what else is worth knowing; None: as before."""
        self.phase, self.fraction = phase, fraction
        self.note = self.note if note is None else note

    def advance(self, note: str = "") -> None:
        """Tell that one more step is done."""
        self.steps += 1
        self.note = note

    def callback(self, given: Callback | None) -> CoreCallback | None:
        """Return what a phase is to call now and then: `given`, and the display where there is one.

        None where nobody wants to know.
        """
        if not self.is_shown and given is None:
            return None

        def told(phase: str, fraction: float, n_vertices: int) -> None:
            self.enter(phase, fraction, f"{n_vertices:,} points" if n_vertices else None)
            if given is not None:
                given(phase, fraction)

        return told

    def row(self) -> Row:
        """Return what the display shows of it now."""
        fraction = self.fraction
        if self.total:
            fraction = min(1.0, self.steps / self.total)
        return Row(
            name=self.name,
            phase=self.phase,
            fraction=fraction,
            steps=f"{self.steps} of {self.total}" if self.total else "",
            note=self.note,
            seconds=time.perf_counter() - self.began,
            expected_seconds=self.expected_seconds,
        )


@contextmanager
def task(name: str, total: int | None = None) -> Iterator[Task]:
    """Give a task, which is shown for as long as the block takes if that is over a second.

    The tasks that begin inside it, in the same thread, are further rows of the same display.
    """
    made = Task(name, total)
    with _lock:
        display = _Display.running
        if display is not None and display.thread is threading.current_thread():
            joined = True
        elif display is None and (screen := _screen()) is not None:
            joined, display = False, _Display(screen)
            _Display.running = display
        else:
            joined, display = False, None
    if display is None:
        yield made
        return
    made.is_shown = True
    display.tasks.append(made)
    try:
        if not joined:
            display.begin()
        yield made
    finally:
        display.tasks.remove(made)
        if not joined:
            display.end()


def current_task() -> Task | None:
    """Return the innermost task of this thread that is shown, None where nobody looks."""
    display = _Display.running
    if display is None or display.thread is not threading.current_thread() or not display.tasks:
        return None
    return display.tasks[-1]


def _screen() -> Screen | None:
    asked = False if _is_quiet.get() else _asked
    if asked is None and (said := os.environ.get(ENVIRONMENT, "")):
        asked = said not in ("0", "off", "false", "no")
    return None if asked is False else screen_for(sys.stderr, is_wanted=asked is True)


class _Display:
    """What a thread of its own shows of the tasks of another."""

    running: _Display | None = None

    def __init__(self, screen: Screen) -> None:
        self.thread = threading.current_thread()
        self.tasks: list[Task] = []
        self._screen = screen
        self._ended = threading.Event()
        # A notebook knows by the context where the output of a cell goes.
        context = copy_context()
        self._painter = threading.Thread(target=context.run, args=(self._paint,), daemon=True)

    def begin(self) -> None:
        self._painter.start()

    def end(self) -> None:
        self._ended.set()
        try:
            self._painter.join()
        finally:
            with _lock:
                _Display.running = None

    def _paint(self) -> None:
        if self._ended.wait(SECONDS_BEFORE_DISPLAY):
            return
        # a terminal that is gone is no reason to end the call
        with suppress(OSError, ValueError), self._screen as screen:
            while True:
                screen.draw([each.row() for each in list(self.tasks)])
                if self._ended.wait(SECONDS_BETWEEN_FRAMES):
                    return
