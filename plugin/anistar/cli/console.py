"""Tables and JSON on the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from rich import box
from rich.console import Console
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from ..base.report import to_json
from ..loops.forecast import Forecast
from ..remeshing.report import RemeshReport
from ..remeshing.report.concerns import Level
from .streams import complain, readers_may_leave

#: Shorter work is not foretold.
SECONDS_WORTH_TELLING = 1.0

_STYLES = {"": "", "look": "yellow", "bad": "bold red"}
_MARKS = {"": "", "look": " !", "bad": " !!"}


class Marked(NamedTuple):
    """A cell of a table that may be worth a look, or bad."""

    text: str
    level: Level


class _Terminal(Console):
    """A console that leaves it to its caller what to do when nobody reads any more."""

    def on_broken_pipe(self) -> None:
        """Raise the error, where Rich would end the process."""
        raise


@readers_may_leave()
def show_json(report: Any) -> None:
    """Print the report as JSON on stdout."""
    print(to_json(report))


@readers_may_leave()
def show_table(title: str, columns: Sequence[str], rows: Sequence[Sequence[Any]]) -> None:
    """Print a table on stdout; numbers go to the right."""
    table = Table(title=escape(title), box=box.SIMPLE_HEAD, title_justify="left")
    for index, column in enumerate(columns):
        is_number = bool(rows) and isinstance(rows[0][index], int | float | Marked)
        table.add_column(column, justify="right" if is_number else "left")
    for row in rows:
        table.add_row(*(_cell(value) for value in row))
    _Terminal().print(table)


@readers_may_leave()
def say(text: str) -> None:
    """Print one line on stdout."""
    _Terminal().print(text, highlight=False, markup=False, soft_wrap=True)


def note(text: str, *, beside_json: bool) -> None:
    """Print one line on stdout, or on stderr where stdout is JSON."""
    if beside_json:
        complain(text)
    else:
        say(text)


def say_removed(count: int, folder: Path, *, beside_json: bool) -> None:
    """Tell that files of an earlier run were removed, if there were any."""
    if count:
        note(f"{folder}: {count} files of an earlier run removed", beside_json=beside_json)


def say_replaced(paths: Sequence[str], by: str, *, beside_json: bool) -> None:
    """Tell that the output went to the place of input files, if it did."""
    if paths:
        verb = "are" if len(paths) > 1 else "is"
        note(f"{' and '.join(paths)} {verb} replaced by {by}", beside_json=beside_json)


def say_forecast(expected: Forecast, *, beside_json: bool, of: str = "mesh") -> None:
    """Tell what long work will take, before it begins."""
    if expected.seconds >= SECONDS_WORTH_TELLING:
        note(f"expected {of}: {expected}", beside_json=beside_json)


def _cell(value: Any) -> Text | str:
    if isinstance(value, Marked):
        return Text(value.text + _MARKS[value.level], style=_STYLES[value.level])
    return escape(as_text(value))


def as_text(value: Any) -> str:
    """Return a number or text as a cell of a table."""
    if value is None:
        return "-"
    if isinstance(value, float):
        return f"{value:.4g}"
    return str(value)


def say_stop_and_verdict(report: RemeshReport, verdict: str) -> None:
    """Print why the mesher stopped early, if it did, and the verdict."""
    if not report.converged:
        reason = report.stop_reason
        if reason == "finished":  # all but the insertion of points until the stars agree
            reason = report.consistency["stop_reason"]
        say(f"not converged: the mesher stopped at {reason}, the mesh is valid")
    say(verdict)
