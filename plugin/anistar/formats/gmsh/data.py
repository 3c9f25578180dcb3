"""Values at nodes and in elements of a Gmsh file, and what our files note about them."""

from __future__ import annotations

import json
import math
from collections import Counter
from dataclasses import dataclass

import numpy as np

from ...base.arrays import AnyArray
from ..content.notes import labels_of, note_of
from ..content.raw import RawMesh
from ..parsing.allowance import Allowance
from ..parsing.numbering import Numbering
from .elements import Elements
from .streams import Stream

_LABELS, _DATA = "anistar:labels ", "anistar:data "
_LONGEST_LIST = 1000
_STEP, _COMPONENTS, _ROWS = 0, 1, 2


@dataclass
class Data:
    """One section of values."""

    name: str
    step: int
    numbers: AnyArray
    values: AnyArray


@dataclass
class Note:
    """What our files say about themselves: which data are labels, and which there are at all."""

    labels: set[str]
    data: set[str]


def comment(labels: list[str], data: list[str]) -> str:
    """Return a section with the names of labels, which Gmsh stores as doubles, and of all data.

    Sections have no mark behind the last one, so that only this tells when data are cut off.
    """
    return f"$Comments\n{_LABELS}{json.dumps(labels)}\n{_DATA}{json.dumps(data)}\n$EndComments\n"


def note_in(body: str) -> Note | None:
    """Return what `comment` noted, None in a section that is not ours."""
    found: dict[str, set[str]] = {}
    for line in body.splitlines():
        for key in (_LABELS, _DATA):
            if line.startswith(key):
                found[key] = labels_of(note_of(line.removeprefix(key)))
    if _LABELS not in found:
        return None
    return Note(found[_LABELS], found.get(_DATA, set()))


def check_complete(note: Note | None, data: dict[str, list[Data]]) -> None:
    """Raise ValueError if data that a file of ours names are missing."""
    given = {part.name for parts in data.values() for part in parts}
    missing = sorted(note.data - given) if note else []
    if missing:
        raise ValueError(f"it is truncated: the data {missing[0]!r} are missing")


def read_data(stream: Stream) -> Data:
    """Return name, time step, numbers and values of a section."""
    strings = [stream.line() for _ in range(_count(stream.line()))]
    for _ in range(_count(stream.line())):
        stream.line()
    integers = [_integer(stream.line()) for _ in range(_count(stream.line()))]
    if not strings or len(integers) <= _ROWS:
        raise ValueError("the head of a section of data is damaged")
    name, components = strings[0].strip('"'), integers[_COMPONENTS]
    if components < 1:
        raise ValueError(f"the data {name!r} have {components} components")
    numbers, values = stream.table(integers[_ROWS], components)
    stream.finish()
    values = values[:, 0] if components == 1 else values
    return Data(name, integers[_STEP], numbers, values.copy())


def _count(line: str) -> int:
    count = _integer(line)
    if not 0 <= count <= _LONGEST_LIST:
        raise ValueError(f"the head of a section of data announces {count} lines")
    return count


def _integer(line: str) -> int:
    longest = len(str(-(2**63)))
    if not line.removeprefix("-").isdecimal() or len(line) > longest:
        raise ValueError(f"the head of a section of data has {line[:40]!r} for an integer")
    return int(line)


def add_node_data(raw: RawMesh, nodes: Numbering, data: Data, allowance: Allowance) -> None:
    """Give values to the points; those that are left out get NaN."""
    Numbering(f"node of {data.name!r}", data.numbers)
    full = _unset(len(raw.points), data, allowance)
    full[nodes.rows(data.numbers)] = data.values
    raw.point_data[data.name] = full


def _unset(n_rows: int, data: Data, allowance: Allowance) -> AnyArray:
    shape = (n_rows, *data.values.shape[1:])
    allowance.spend(np.dtype(np.float64).itemsize * math.prod(shape))
    return np.full(shape, np.nan)


def add_element_data(raw: RawMesh, runs: list[Elements], data: Data, allowance: Allowance) -> None:
    """Spread values over the blocks; elements that are left out get NaN."""
    Numbering(f"element of {data.name!r}", data.numbers)
    own, row_of = np.unique(np.concatenate([run.numbers for run in runs]), return_inverse=True)
    full = _unset(len(own), data, allowance)
    full[Numbering("element", own).rows(data.numbers)] = data.values
    starts = np.cumsum([0, *(len(run.numbers) for run in runs)])
    for block, start in zip(raw.blocks, starts, strict=False):
        block.data[data.name] = full[row_of.ravel()[start : start + len(block.rows)]]


def last_steps(parts: list[Data], warnings: list[str]) -> list[Data]:
    """Return one section for each name: that of the last step.

    Raises
    ------
    ValueError
        If a name is given twice for one step.
    """
    last: dict[str, Data] = {}
    seen: set[tuple[str, int]] = set()
    for part in parts:
        if (part.name, part.step) in seen:
            raise ValueError(f"the data {part.name!r} are given twice for step {part.step}")
        seen.add((part.name, part.step))
        if part.name not in last or part.step > last[part.name].step:
            last[part.name] = part
    n_steps = Counter(name for name, _ in seen)
    several = [name for name, n in n_steps.items() if n > 1]
    if several:
        warnings.append(f"{len(several)} field(s) have several steps, the last one is kept")
    return list(last.values())
