"""Objects that say what matters of them: in one line, and as a table in a notebook."""

from __future__ import annotations

import html
import itertools
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

#: A notebook shows so many rows of a table at most.
MOST_ROWS = 40


class Told(ABC):
    """What tells its figures by name, instead of all its arrays."""

    __slots__ = ()

    @abstractmethod
    def _figures(self) -> Mapping[str, Any]:
        """Return what matters, by name."""

    def _table(self) -> tuple[Sequence[str], Iterable[Sequence[Any]]] | None:
        """Return the columns and rows that a notebook shows beside the figures, if any."""
        return None

    def _drawing(self) -> str:
        """Return a drawing for a notebook, as SVG; empty if there is none."""
        return ""

    def __repr__(self) -> str:
        told = ", ".join(f"{name}={_said(value)}" for name, value in self._figures().items())
        return f"{type(self).__name__}({told})"

    def _repr_html_(self) -> str:
        parts = [
            f"<strong>{html.escape(type(self).__name__)}</strong>",
            html_table((), self._figures().items()),
        ]
        if (table := self._table()) is not None:
            parts.append(html_table(*table))
        return f"<div>{''.join(parts)}{self._drawing()}</div>"


def html_table(columns: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """Return a table as HTML; without columns it has no head.

    Parameters
    ----------
    columns : sequence of str
    rows : iterable of sequence
        Numbers and texts; the rows after the fortieth are left out, and that is said.
    """
    listed = list(itertools.islice(rows, MOST_ROWS + 1))
    head = "".join(f"<th>{html.escape(column)}</th>" for column in columns)
    lines = [f"<tr>{head}</tr>"] if columns else []
    for row in listed[:MOST_ROWS]:
        cells = "".join(f"<td>{html.escape(_said(value))}</td>" for value in row)
        lines.append(f"<tr>{cells}</tr>")
    if len(listed) > MOST_ROWS:
        lines.append("<tr><td>…</td></tr>")
    return f"<table>{''.join(lines)}</table>"


def _said(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{name}: {_said(item)}" for name, item in value.items()) + "}"
    return "-" if value is None else str(value)
