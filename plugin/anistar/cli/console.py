"""Tables and JSON on the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rich import box
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from ..base.report import to_json
from ..remeshing.report import RemeshReport
from .streams import complain, readers_may_leave


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
        is_number = bool(rows) and isinstance(rows[0][index], int | float)
        table.add_column(column, justify="right" if is_number else "left")
    for row in rows:
        table.add_row(*(escape(as_text(value)) for value in row))
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


def as_text(value: Any) -> str:
    """Return a number or text as a cell of a table."""
    if value is None:
        return "-"
    if isinstance(value, float):
        return f"{value:.4g}"
    return str(value)


def show_remeshed(
    title: str, rows: Sequence[Sequence[Any]], report: RemeshReport, verdict: str
) -> None:
    """Print the sizes of both meshes, why the mesher stopped early, and the verdict."""
    show_table(title, ["mesh", "points", "cells"], rows)
    if not report.converged:
        reason = report.stop_reason
        if reason == "finished":  # all but the insertion of points until the stars agree
            reason = report.consistency["stop_reason"]
        say(f"not converged: the mesher stopped at {reason}, the mesh is valid")
    say(verdict)
