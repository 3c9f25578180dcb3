"""Abaqus input: nodes, elements and the sets that name them.

The format has neither counts nor a mark at its end, so that a cut between two lines cannot be
told; reading says so. Other files that it includes are not opened.

References
----------
Abaqus keywords: *NODE, *ELEMENT, *ELSET; data lines follow a keyword line.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..base.arrays import AnyArray
from ..meshes.topology import vector_lengths
from .content.kinds import KINDS
from .content.raw import Block, RawMesh
from .parsing.allowance import Allowance
from .parsing.numbering import Numbering
from .parsing.reading import reading
from .parsing.text_rows import integers, parsed

_KEYWORD = re.compile(r"^\*([^,\n]*)(.*)$", re.MULTILINE)
_COMMENT = re.compile(r"^\*\*.*$", re.MULTILINE)
_TYPES = {
    "line": ("T2D2", "T2D2H", "T3D2", "T3D2H", "B21", "B21H", "B31", "B31H"),
    "triangle": ("CPS3", "CPE3", "CAX3", "STRI3", "S3", "S3R", "S3RS", "R3D3", "M3D3"),
    "quad": ("CPS4", "CPS4R", "CPE4", "CPE4R", "CAX4", "CAX4P", "S4", "S4R", "M3D4"),
    "tetra": ("C3D4", "C3D4H"),
    "pyramid": ("C3D5", "C3D5H"),
    "wedge": ("C3D6", "C3D6H"),
    "hexahedron": ("C3D8", "C3D8H", "C3D8I", "C3D8R"),
    "line3": ("T2D3", "T2D3H", "T3D3", "T3D3H", "B22", "B22H", "B32", "B32H"),
    "triangle6": ("CPS6", "CPS6M", "CPE6", "CPE6M", "CAX6", "STRI65", "M3D6"),
    "quad8": ("CPS8", "CPS8R", "CPE8", "CPE8R", "CAX8", "S8R", "M3D8"),
    "quad9": ("M3D9", "M3D9R", "S9R5"),
    "tetra10": ("C3D10", "C3D10H", "C3D10M"),
    "wedge15": ("C3D15", "C3D15H"),
    "hexahedron20": ("C3D20", "C3D20H", "C3D20R"),
}
_KIND_OF = {name: kind for kind, names in _TYPES.items() for name in names}
_PARAMETERS = {
    "NODE": ("NSET", "SYSTEM"),
    "ELEMENT": ("TYPE", "ELSET"),
    "ELSET": ("ELSET", "GENERATE", "INSTANCE", "INTERNAL", "UNSORTED"),
}
_MOST_NAMED, _LONGEST_NAME = 5, 60
_GENERATED = 3
"""First, last and step of a set that is generated."""


@dataclass
class _Content:
    """What was read so far; sets may be made of ranges and of other sets, which takes memory."""

    allowance: Allowance
    nodes: list[AnyArray] = field(default_factory=list)
    kinds: list[str] = field(default_factory=list)
    elements: list[AnyArray] = field(default_factory=list)
    of_elements: dict[str, list[AnyArray]] = field(default_factory=dict)
    sets: dict[str, list[AnyArray]] = field(default_factory=dict)
    n_elements: int = 0
    spelled: dict[str, str] = field(default_factory=dict)
    respelled: list[str] = field(default_factory=list)

    def defined(self, name: str) -> str:
        """Return the name of a set as it was spelled first: capitals do not count in Abaqus."""
        first = self.spelled.setdefault(name.upper(), name)
        if first != name:
            self.respelled.append(f"{first!r} of {name[:_LONGEST_NAME]!r}")
        return first

    def members(self, name: str) -> list[AnyArray] | None:
        """Return the elements in a set, None if there is none of this name."""
        first = self.spelled.get(name.upper(), name)
        return self.sets.get(first, self.of_elements.get(first))


def read(path: Path) -> RawMesh:
    """Read a mesh; the sets of elements become tags with names, the last one of a cell counts.

    Raises
    ------
    FormatError
        If the file is damaged, includes another one, or has elements that are not known.
    """
    with reading(path):
        return _mesh(path.read_text(encoding="utf-8-sig", errors="replace"))


def _mesh(text: str) -> RawMesh:
    content = _Content(Allowance(len(text)))
    clean = _COMMENT.sub("", text)
    found = list(_KEYWORD.finditer(clean))
    if not found or clean[: found[0].start()].strip():
        raise ValueError("it does not begin with a keyword such as *HEADING")
    ends = [match.start() for match in found[1:]] + [len(clean)]
    for match, end in zip(found, ends, strict=True):
        keyword = match[1].strip().upper()
        _read(content, keyword, _parameters(match[2]), clean[match.end() : end])
    if not content.nodes or not content.elements:
        raise ValueError("it is truncated: it has no *NODE or no *ELEMENT")
    return _raw(content)


def _read(content: _Content, keyword: str, parameters: dict[str, str], body: str) -> None:
    _check_understood(keyword, parameters, body)
    if keyword == "NODE":
        content.nodes.append(_nodes(body))
    elif keyword == "ELEMENT":
        kind = _KIND_OF.get(parameters.get("TYPE", "").upper())
        if kind is None:
            raise ValueError(f"elements of type {parameters.get('TYPE', '')[:40]!r} are not known")
        width = KINDS[kind].n_nodes
        rows = _integers(keyword, body)
        if len(rows) % (width + 1):
            raise ValueError(f"*ELEMENT has {len(rows)} numbers, no rows of {width + 1}")
        rows = rows.reshape(-1, width + 1)
        content.kinds.append(kind)
        content.elements.append(rows)
        content.n_elements += len(rows)
        if "ELSET" in parameters:
            name = content.defined(parameters["ELSET"])
            content.of_elements.setdefault(name, []).append(rows[:, 0])
    elif keyword == "ELSET":
        name = content.defined(parameters.get("ELSET", ""))
        members = _members(content, body, is_generated="GENERATE" in parameters)
        content.allowance.spend(members.nbytes)
        content.sets.setdefault(name, []).append(members)


def _check_understood(keyword: str, parameters: dict[str, str], body: str) -> None:
    """Raise if a keyword says what is not understood here, or sends to another file."""
    if keyword == "INCLUDE" or (keyword in _PARAMETERS and "INPUT" in parameters):
        raise ValueError("it includes another file, which is not opened: put it in here")
    unknown = sorted(parameters.keys() - set(_PARAMETERS.get(keyword, parameters)))
    if unknown:
        raise ValueError(f"the parameter {unknown[0][:40]} of *{keyword} is not known")
    if (system := parameters.get("SYSTEM", "R")).upper() != "R" and keyword == "NODE":
        raise ValueError(f"*NODE has SYSTEM={system[:20]}: give the nodes in Cartesian coordinates")
    if keyword == "SYSTEM" and body.strip():
        raise ValueError("it has *SYSTEM, which moves its nodes: give them in one system")


def _parameters(text: str) -> dict[str, str]:
    pairs = (word.partition("=") for word in text.split(","))
    return {name.strip().upper(): value.strip() for name, _, value in pairs if name.strip()}


def _nodes(body: str) -> AnyArray:
    first = body.strip().partition("\n")[0]
    width = len(first.strip().rstrip(",").split(","))
    if width not in (3, 4):
        raise ValueError(f"*NODE has {width} numbers in a line, not a number and coordinates")
    numbers = _numbers("NODE", body)
    if len(numbers) % width:
        raise ValueError(f"*NODE has {len(numbers)} numbers, no rows of {width}")
    return numbers.reshape(-1, width)


def _members(content: _Content, body: str, *, is_generated: bool) -> AnyArray:
    """Return the numbers of the elements in a set, which may be made of other sets."""
    words = [word.strip() for word in body.replace("\n", ",").split(",") if word.strip()]
    if words and not words[0].isdecimal():
        parts = []
        for word in dict.fromkeys(words):
            known = content.members(word)
            if known is None:
                raise ValueError(f"a set is made of {word[:40]!r}, which is not given")
            parts += known
        content.allowance.spend(sum(part.nbytes for part in parts))
        # what is in a set twice does not grow when that is put into others
        return np.unique(np.concatenate(parts))
    members = _integers("ELSET", body)
    if not is_generated:
        return members
    if len(members) % _GENERATED:
        raise ValueError(f"*ELSET, GENERATE has {len(members)} numbers, no rows of {_GENERATED}")
    parts = [np.zeros(0, np.int64)]
    for first, last, step in members.reshape(-1, _GENERATED).tolist():
        if step < 1 or last < first or (last - first) // step >= content.n_elements:
            raise ValueError(f"*ELSET generates {first} to {last}, more than there are elements")
        parts.append(np.arange(first, last + 1, step))
    return np.concatenate(parts)


def _numbers(keyword: str, body: str) -> AnyArray:
    try:
        return parsed(body.replace(",", " "))
    except ValueError as error:
        raise ValueError(f"*{keyword} {error}") from error


def _integers(keyword: str, body: str) -> AnyArray:
    numbers = _numbers(keyword, body)
    try:
        return integers(numbers)
    except ValueError as error:
        raise ValueError(f"*{keyword} {error}") from error


def _raw(content: _Content) -> RawMesh:
    if len({rows.shape[1] for rows in content.nodes}) > 1:
        raise ValueError("some of its nodes have two coordinates, others three")
    nodes = np.concatenate(content.nodes)
    number = Numbering("node", nodes[:, 0])
    raw = RawMesh(np.ascontiguousarray(nodes[:, 1:]), [])
    tags = _tags(content, raw)
    starts = np.cumsum([0, *(len(rows) for rows in content.elements)])
    raw.blocks = [
        Block(
            kind, _in_order(kind, number.rows(rows[:, 1:]), raw.points), tags[start:][: len(rows)]
        )
        for kind, rows, start in zip(content.kinds, content.elements, starts, strict=False)
    ]
    if content.respelled:
        raw.warnings.append(
            "capitals do not count in names of sets, the first spelling is kept: "
            + ", ".join(dict.fromkeys(content.respelled[:_MOST_NAMED]))
        )
    raw.warnings.append(
        "Abaqus input has neither counts nor an end, so a file that was cut cannot be told: "
        f"{len(raw.points)} points and {len(tags)} elements were read"
    )
    return raw


def _in_order(kind: str, rows: AnyArray, points: AnyArray) -> AnyArray:
    """Return rows with the node in the middle of a line behind its ends, wherever it is given.

    Beams have it between them, other lines behind them, and not all programs keep to that.
    """
    if kind != "line3" or len(rows) == 0:
        return rows
    first, second, third = (points[rows[:, i]] for i in range(3))
    is_between = vector_lengths(third - first) > vector_lengths(second - first)
    return np.where(is_between[:, None], rows[:, [0, 2, 1]], rows)


def _tags(content: _Content, raw: RawMesh) -> AnyArray:
    """Return the number of the last set that each element is in, and give the names to `raw`."""
    number = Numbering("element", np.concatenate([rows[:, 0] for rows in content.elements]))
    dims = np.concatenate(
        [
            np.full(len(rows), KINDS[kind].dim)
            for kind, rows in zip(content.kinds, content.elements, strict=True)
        ]
    )
    # sets of their own come last: they say more than the groups in which elements were written
    sets = [
        (name, np.concatenate(parts))
        for named in (content.of_elements, content.sets)
        for name, parts in named.items()
    ]
    tags = np.zeros(len(number), np.int64)
    n_lost = 0
    for tag, (name, members) in enumerate(sets, start=1):
        chosen = number.rows(members)
        n_lost += int(np.count_nonzero(tags[chosen]))
        tags[chosen] = tag
        raw.names |= {(int(dim), tag): name for dim in np.unique(dims[chosen])}
    if n_lost:
        raw.warnings.append(f"{n_lost} element(s) are in several sets, the last one is kept")
    return tags
