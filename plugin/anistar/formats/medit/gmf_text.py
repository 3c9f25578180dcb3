"""The text encoding of GMF: `.mesh` and `.sol`."""

from __future__ import annotations

import json
import re
from typing import Any

import numpy as np

from ...base.arrays import Floats, Longs
from ..content.notes import note_of
from ..parsing.text_rows import integers, parsed, printed
from .gmf_container import (
    ENTITIES,
    NOTES,
    SOLUTIONS,
    WITHOUT_CONTENT,
    Container,
    Solution,
    checked_dim,
    columns_of,
)

_KEYWORD = re.compile(r"(?<![\w.+-])(?!Inf|Nan|NaN)([A-Z][a-z][A-Za-z0-9]+)")
# Names of files, where a keyword or a # would be none, and comments.
_NO_CONTENT = re.compile(r'"[^"\n]*"|#.*')
# Blanks are no line breaks here: a run of empty lines would be searched from each of them.
_NOTE = re.compile(r"^[ \t]*#[ \t]*anistar:(\w+) (.*)$", re.MULTILINE)
_FIRST, _LAST = "MeshVersionFormatted", "End"


def from_text(text: str) -> Container:
    """Return the content of a text file; raise ValueError if it is not what it says."""
    sections = _sections(_NO_CONTENT.sub("", text))
    if "Dimension" not in sections:
        raise ValueError("it has no Dimension")
    container = Container(dim=_dimension(sections["Dimension"]), notes=_notes(text))
    _check_end(container, sections, text)
    for keyword, body in sections.items():
        _read(container, keyword, body)
    return container


def _sections(clean: str) -> dict[str, str]:
    """Return the text behind each keyword."""
    found = list(_KEYWORD.finditer(clean))
    if not found or found[0].group() != _FIRST or clean[: found[0].start()].strip():
        raise ValueError(f"it does not begin with {_FIRST}")
    ends = [match.start() for match in found[1:]] + [len(clean)]
    sections: dict[str, str] = {}
    for match, end in zip(found, ends, strict=True):
        keyword = match.group()
        if keyword in sections:
            raise ValueError(f"it has two sections {keyword}: only one can be meant")
        if _LAST in sections:
            raise ValueError(f"the section {keyword} follows its keyword {_LAST}")
        sections[keyword] = clean[match.end() : end]
    return sections


def _check_end(container: Container, sections: dict[str, str], text: str) -> None:
    """Raise if the keyword End is missing where it is needed.

    Solution files written by hand often lack it; their one section is checked by its count, and its
    last number by the blank behind it.
    """
    if _LAST in sections:
        if sections[_LAST].strip():
            raise ValueError(f"something follows its keyword {_LAST}")
    elif "Vertices" in sections or container.notes or not text[-1:].isspace():
        raise ValueError(f"it is truncated: the keyword {_LAST} is missing")


def _read(container: Container, keyword: str, body: str) -> None:
    if keyword == "Vertices":
        rows = _table(keyword, _numbers(keyword, body), container.dim + 1)
        container.points = rows[:, : container.dim].copy()
        container.point_refs = _integers(keyword, rows[:, container.dim])
    elif keyword in ENTITIES:
        rows = _table(keyword, _numbers(keyword, body), ENTITIES[keyword][1])
        container.tables[keyword] = _integers(keyword, rows)
    elif keyword in SOLUTIONS:
        numbers = _numbers(keyword, body)
        container.solutions[keyword] = _solution(keyword, numbers, container.dim)
    elif keyword not in (_FIRST, "Dimension", _LAST, *WITHOUT_CONTENT):
        container.skipped.append(keyword)


def _notes(text: str) -> dict[str, Any]:
    notes: dict[str, Any] = {}
    for name, value in _NOTE.findall(text):
        if name in notes or name not in NOTES:
            raise ValueError(f"the comment anistar:{name} is given twice or not known")
        notes[name] = note_of(value)
    return notes


def _dimension(body: str) -> int:
    first = _numbers("Dimension", body)[:1]
    return checked_dim(int(_integers("Dimension", first)[0]))


def _numbers(keyword: str, body: str) -> Floats:
    try:
        numbers = parsed(body)
    except ValueError as error:
        raise ValueError(f"{keyword} {error}") from error
    if len(numbers) == 0:
        raise ValueError(f"it is truncated: {keyword} has no numbers")
    return numbers


def _integers(keyword: str, numbers: Floats) -> Longs:
    try:
        return integers(numbers)
    except ValueError as error:
        raise ValueError(f"{keyword} {error}") from error


def _table(keyword: str, numbers: Floats, width: int) -> Floats:
    count = int(_integers(keyword, numbers[:1])[0])
    if count < 0 or len(numbers) - 1 != count * width:
        raise ValueError(
            f"{keyword} announces {count} rows of {width} numbers, "
            f"but {len(numbers) - 1} numbers follow"
        )
    return numbers[1:].reshape(count, width)


def _solution(keyword: str, numbers: Floats, dim: int) -> Solution:
    n_types = int(_integers(keyword, numbers[1:2])[0]) if len(numbers) > 1 else 0
    if not 0 < n_types <= len(numbers) - 2:
        raise ValueError(f"{keyword} announces {n_types} fields, which it does not have")
    types = _integers(keyword, numbers[2 : 2 + n_types]).tolist()
    body = np.r_[numbers[0], numbers[2 + n_types :]]
    return Solution(types, _table(keyword, body, sum(columns_of(types, dim))).copy())


def to_text(container: Container) -> str:
    """Return a container as text."""
    parts = ["MeshVersionFormatted 2\n"]
    parts += [f"# anistar:{name} {json.dumps(value)}\n" for name, value in container.notes.items()]
    parts.append(f"Dimension {container.dim}\n")
    if container.points is not None:
        refs = container.references()
        parts += [f"Vertices\n{len(refs)}\n", printed(container.points, refs)]
    for keyword, table in container.tables.items():
        parts += [f"{keyword}\n{len(table)}\n", printed(table)]
    for keyword, solution in container.solutions.items():
        types = " ".join(str(code) for code in (len(solution.types), *solution.types))
        parts += [f"{keyword}\n{len(solution.values)}\n{types}\n", printed(solution.values)]
    return "".join([*parts, "End\n"])
