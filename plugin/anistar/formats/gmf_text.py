"""The text encoding of GMF: `.mesh` and `.sol`."""

from __future__ import annotations

import json
import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import FormatError
from .gmf_container import ENTITIES, SOLUTIONS, Container, Solution, checked_dim, columns_of
from .text_rows import integers, parsed, printed

_KEYWORD = re.compile(r"(?<![\w.+-])(?!Inf|Nan|NaN)([A-Z][a-z][A-Za-z0-9]+)")
_NOTE = re.compile(r"^\s*#\s*anistar:(\w+) (.*)$", re.MULTILINE)


def from_text(text: str) -> Container:
    """Return the content of a text file; raise FormatError if it is not what it says."""
    notes = {name: _note(value) for name, value in _NOTE.findall(text)}
    clean = re.sub(r"#.*", "", text)
    found = list(_KEYWORD.finditer(clean))
    if not found or found[0].group() != "MeshVersionFormatted":
        raise FormatError("it does not begin with MeshVersionFormatted")
    ends = [match.start() for match in found[1:]] + [len(clean)]
    sections = {
        match.group(): clean[match.end() : end] for match, end in zip(found, ends, strict=True)
    }
    if "Dimension" not in sections:
        raise FormatError("it has no Dimension")
    # Solution files written by hand often lack it; their one section is checked by its count.
    if "End" not in sections and "Vertices" in sections:
        raise FormatError("it is truncated: the keyword End is missing")
    first = _numbers("Dimension", sections["Dimension"])[:1]
    dim = checked_dim(int(_integers("Dimension", first)[0]))
    container = Container(dim=dim, notes=notes)
    for keyword, body in sections.items():
        if keyword == "Vertices":
            rows = _table(keyword, _numbers(keyword, body), dim + 1)
            container.points = rows[:, :dim].copy()
            container.point_refs = _integers(keyword, rows[:, dim])
        elif keyword in ENTITIES:
            rows = _table(keyword, _numbers(keyword, body), ENTITIES[keyword][1])
            container.tables[keyword] = _integers(keyword, rows)
        elif keyword in SOLUTIONS:
            container.solutions[keyword] = _text_solution(keyword, _numbers(keyword, body), dim)
    return container


def _note(value: str) -> Any:
    try:
        return json.loads(value)
    except json.JSONDecodeError as error:
        raise FormatError(f"a comment of anistar is not JSON: {error}") from error


def _numbers(keyword: str, body: str) -> NDArray[np.float64]:
    try:
        numbers = parsed(body)
    except ValueError as error:
        raise FormatError(f"{keyword} {error}") from error
    if len(numbers) == 0:
        raise FormatError(f"it is truncated: {keyword} has no numbers")
    return numbers


def _integers(keyword: str, numbers: NDArray[np.float64]) -> NDArray[np.int64]:
    try:
        return integers(numbers)
    except ValueError as error:
        raise FormatError(f"{keyword} {error}") from error


def _table(keyword: str, numbers: NDArray[np.float64], width: int) -> NDArray[np.float64]:
    count = int(_integers(keyword, numbers[:1])[0])
    if len(numbers) - 1 != count * width:
        raise FormatError(
            f"{keyword} announces {count} rows of {width} numbers, "
            f"but {len(numbers) - 1} numbers follow"
        )
    return numbers[1:].reshape(count, width)


def _text_solution(keyword: str, numbers: NDArray[np.float64], dim: int) -> Solution:
    n_types = int(_integers(keyword, numbers[1:2])[0]) if len(numbers) > 1 else 0
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
