"""Where progress is shown: a terminal, a notebook, or lines in a log."""

from __future__ import annotations

import html
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from types import TracebackType
from typing import Any, Protocol, Self, TextIO

#: A log gets a line for a new phase, but not more often.
SECONDS_BETWEEN_LINES = 1.0

_BAR = 24

# A VT100 and all since it: erase from the cursor on; keep its place, and take it again.
_ERASE, _KEEP_PLACE, _TAKE_PLACE = "\x1b[J", "\x1b7", "\x1b8"


@dataclass(frozen=True, slots=True)
class Row:
    """One line of a display."""

    name: str
    phase: str
    fraction: float | None
    steps: str
    note: str
    seconds: float
    expected_seconds: float | None

    @property
    def how_far(self) -> str:
        """The steps, or the fraction in per cent."""
        if self.steps or self.fraction is None:
            return self.steps
        return f"{100 * self.fraction:.0f} %"

    @property
    def time(self) -> str:
        """The time that it has taken, and will take as far as that is known."""
        of = "" if self.expected_seconds is None else f" of about {clock(self.expected_seconds)}"
        return f"{clock(self.seconds)}{of}"


def clock(seconds: float) -> str:
    """Return a time as hours, minutes and seconds."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"


class Screen(Protocol):
    """A place to draw rows on, taken for the time of a `with` block and left as it was."""

    def __enter__(self) -> Self: ...

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
        /,
    ) -> None: ...

    def draw(self, rows: Sequence[Row]) -> None:
        """Show these rows instead of those before."""


def screen_for(stream: TextIO | None, *, is_wanted: bool) -> Screen | None:
    """Return a screen, None where nobody would look at it.

    Parameters
    ----------
    stream : text stream or None
        Standard error.
    is_wanted : bool
        Whether lines are written where it is no terminal.
    """
    if _is_worker() and not is_wanted:
        return None  # its brothers write to the same terminal
    if _is_notebook():
        return NotebookScreen()
    # A program that embeds Python, such as ParaView, may put there what can only be written to.
    if stream is None or getattr(stream, "closed", False):
        return None
    if hasattr(stream, "isatty") and stream.isatty():
        return TerminalScreen(stream)
    return LineScreen(stream) if is_wanted else None


def _is_worker() -> bool:
    """Return whether this is one of several processes of a pool."""
    multiprocessing = sys.modules.get("multiprocessing.process")
    return multiprocessing is not None and multiprocessing.parent_process() is not None


def _is_notebook() -> bool:
    """Return whether a kernel of Jupyter runs this, which nothing imports that is not there."""
    shell = sys.modules.get("IPython")
    found = shell.get_ipython() if shell is not None else None
    return found is not None and type(found).__name__ == "ZMQInteractiveShell"


class TerminalScreen:
    """Bars below the line where the program writes, drawn over themselves, and gone at the end.

    Standard output and error stay what they are, and the cursor returns to where it was: whatever
    is written meanwhile, be it by another program, stands where it would stand without the bars.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._console: Any = None

    def __enter__(self) -> Self:
        from rich.console import Console  # takes a while, and most calls end before

        console = Console(file=self._stream)
        if not (console.is_dumb_terminal or console.legacy_windows):
            self._console = console
        return self

    def __exit__(self, *_: object) -> None:
        self._write(_ERASE)

    def draw(self, rows: Sequence[Row]) -> None:
        """Show these rows instead of those before."""
        if self._console is None:
            return
        with self._console.capture() as drawn:
            self._console.print(_table(rows))
        lines = drawn.get().splitlines()[: self._console.height - 1]
        below = "".join(f"\r\n{line}" for line in lines)
        self._write(_room(len(lines)) + _ERASE + _KEEP_PLACE + below + _TAKE_PLACE)

    def _write(self, text: str) -> None:
        if self._console is not None:
            self._stream.write(text)
            self._stream.flush()


def _room(lines: int) -> str:
    """Scroll until there are so many lines below the cursor, which stays in its line."""
    return "\x1bD" * lines + "\x1b[A" * lines


def _table(rows: Sequence[Row]) -> Any:
    from rich.progress_bar import ProgressBar
    from rich.table import Table
    from rich.text import Text

    table = Table.grid(padding=(0, 1))
    for row in rows:
        bar = "" if row.fraction is None else ProgressBar(1.0, row.fraction, width=_BAR)
        words = (row.name, row.phase, row.how_far, row.note, row.time)
        name, phase, how_far, note, time = map(Text, words)
        table.add_row(name, phase, bar, how_far, note, time)
    return table


class NotebookScreen:
    """Bars in the output of a cell, gone at the end."""

    def __init__(self) -> None:
        self._shown: Any = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._shown is not None:
            self._shown.update(_html(""))

    def draw(self, rows: Sequence[Row]) -> None:
        """Show these rows instead of those before."""
        from IPython.display import display  # it is there, or this were no notebook

        page = _html(f"<table>{''.join(map(_html_row, rows))}</table>")
        if self._shown is None:
            self._shown = display(page, display_id=True)
        else:
            self._shown.update(page)


def _html(text: str) -> Any:
    from IPython.display import HTML

    return HTML(text)


def _html_row(row: Row) -> str:
    bar = "" if row.fraction is None else f'<progress value="{row.fraction:.3f}"></progress>'
    words = (html.escape(word) for word in (row.name, row.phase, row.how_far, row.note, row.time))
    name, phase, how_far, note, time = words
    return "<tr><td>" + "</td><td>".join((name, phase, bar, how_far, note, time)) + "</td></tr>"


class LineScreen:
    """A line for every phase, as in the log of a batch job."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._said = ""
        self._when = -SECONDS_BETWEEN_LINES

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._stream.flush()

    def draw(self, rows: Sequence[Row]) -> None:
        """Write a line if there is something new to say."""
        if not rows:
            return
        said = "; ".join(" ".join(filter(None, (r.name, r.phase, r.steps, r.note))) for r in rows)
        if said != self._said and rows[0].seconds - self._when >= SECONDS_BETWEEN_LINES:
            self._said, self._when = said, rows[0].seconds
            self._stream.write(f"anistar: {rows[0].time} {said}\n")
