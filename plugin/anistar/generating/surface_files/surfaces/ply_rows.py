"""The rows of a PLY file: numbers, and lists that begin with their length."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....base.arrays import AnyArray
from ....formats.parsing.cursor import Cursor
from ..content.raw_surface import Faces

_TYPES = {
    "char": "i1",
    "uchar": "u1",
    "short": "i2",
    "ushort": "u2",
    "int": "i4",
    "uint": "u4",
    "float": "f4",
    "double": "f8",
    "int8": "i1",
    "uint8": "u1",
    "int16": "i2",
    "uint16": "u2",
    "int32": "i4",
    "uint32": "u4",
    "float32": "f4",
    "float64": "f8",
}

Rows = dict[str, AnyArray | Faces]


@dataclass(frozen=True)
class Property:
    """What every row of an element has: a number, or a list where there is a type of its length.

    Types are those of NumPy.
    """

    name: str
    kind: str
    size_kind: str | None = None

    @classmethod
    def of(cls, words: list[str], line: int) -> Property:
        """Return what a line of the header says."""
        is_list = words[:1] == ["list"]
        types, name = words[is_list:-1], words[-1:]
        if len(types) != 1 + is_list or not all(word in _TYPES for word in types):
            raise ValueError(f"line {line}: property {' '.join(words)[:60]!r} is not known")
        kinds = [_TYPES[word] for word in types]
        if is_list and kinds[0][0] == "f":
            raise ValueError(f"line {line}: the length of a list is no integer")
        return cls(name[0], kinds[-1], kinds[0] if is_list else None)


def text_rows(words: list[bytes], name: str, count: int, properties: list[Property]) -> Rows:
    """Take the rows of an element away from the words of a file.

    Raises
    ------
    ValueError
        If there are fewer, or a word is no number.
    """
    if all(item.size_kind is None for item in properties):
        width = len(properties)
        table = _numbers(_taken(words, name, count * width), name).reshape(-1, width or 1)
        return {item.name: table[:, k] for k, item in enumerate(properties)}
    found: dict[str, list[bytes]] = {item.name: [] for item in properties}
    sizes: dict[str, list[int]] = {item.name: [] for item in properties}
    at = 0
    for _ in range(count):
        for item in properties:
            size = 1
            if item.size_kind is not None:
                size = int(words[at]) if at < len(words) and words[at].isdigit() else -1
                at += 1
            if size < 0 or at + size > len(words):
                raise ValueError(f"it is truncated or damaged within its elements {name}")
            found[item.name] += words[at : at + size]
            sizes[item.name].append(size)
            at += size
    del words[:at]
    rows: Rows = {}
    for item in properties:
        values = _numbers(found[item.name], name)
        is_list = item.size_kind is not None
        rows[item.name] = _faces(values, sizes[item.name]) if is_list else values
    return rows


def _taken(words: list[bytes], name: str, count: int) -> list[bytes]:
    if count > len(words):
        raise ValueError(
            f"it is truncated: its elements {name} take {count} numbers, {len(words)} are there"
        )
    taken = words[:count]
    del words[:count]
    return taken


def _numbers(words: list[bytes], name: str) -> AnyArray:
    try:
        return np.array([float(word) for word in words], np.float64)
    except ValueError as error:
        raise ValueError(f"its elements {name} hold something that is no number") from error


def _faces(values: AnyArray, sizes: list[int]) -> Faces:
    if not (np.isfinite(values) & (values == np.floor(values))).all():
        raise ValueError("a list holds something else than integers")
    return Faces(values.astype(np.int64), np.array(sizes, np.int64))


def binary_rows(cursor: Cursor, name: str, count: int, properties: list[Property]) -> Rows:
    """Return the next rows of an element.

    Raises
    ------
    ValueError
        If the file ends before.
    """
    if not properties:
        return {}
    lists = [item for item in properties if item.size_kind is not None]
    if not lists:
        table = cursor.take(_row(properties, {}), count)
        return {item.name: table[item.name] for item in properties}
    parts: dict[str, list[AnyArray]] = {item.name: [] for item in properties}
    sizes: dict[str, list[AnyArray]] = {item.name: [] for item in lists}
    done = 0
    while done < count:
        run = _run(cursor, properties, count - done)
        for item in properties:
            values = run[item.name]
            parts[item.name].append(values.ravel())
            if item.size_kind is not None:
                sizes[item.name].append(np.full(len(run), values.shape[1], np.int64))
        done += len(run)
    rows: Rows = {}
    for item in properties:
        values = np.concatenate([np.zeros(0, item.kind), *parts[item.name]])
        is_list = item.size_kind is not None
        none = np.zeros(0, np.int64)
        rows[item.name] = (
            Faces(values.astype(np.int64), np.concatenate([none, *sizes[item.name]]))
            if is_list
            else values
        )
    return rows


_FIRST_LOOK = 16


def _run(cursor: Cursor, properties: list[Property], most: int) -> AnyArray:
    """Return the longest run of rows whose lists are as long as those of the next one.

    The work is in proportion to what is returned.
    """
    row = _row(properties, _sizes(cursor, properties))
    fields = [_size_of(item.name) for item in properties if item.size_kind is not None]
    start, ahead = cursor.at, _FIRST_LOOK
    while True:
        held = (len(cursor.data) - start) // row.itemsize
        n = min(ahead, most, max(held, 1))
        cursor.at = start
        rows = cursor.take(row, n)
        same = np.ones(n, bool)
        for name in fields:
            same &= rows[name] == rows[name][0]
        if not same.all() or n in (most, held):
            n = n if same.all() else int(np.argmin(same))
            cursor.at = start + n * row.itemsize
            return rows[:n]
        ahead *= 2


def _sizes(cursor: Cursor, properties: list[Property]) -> dict[str, int]:
    """Return the lengths of the lists in the next row, without going on."""
    start, sizes = cursor.at, {}
    for item in properties:
        size = 1
        if item.size_kind is not None:
            size = cursor.integer(item.size_kind)
            if size < 0:
                raise ValueError(f"a list {item.name} has {size} entries")
            sizes[item.name] = size
        cursor.take(item.kind, size)
    cursor.at = start
    return sizes


def _size_of(name: str) -> str:
    return f"size of {name}"


def _row(properties: list[Property], sizes: dict[str, int]) -> np.dtype[np.void]:
    fields: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
    for item in properties:
        if item.size_kind is None:
            fields.append((item.name, item.kind))
        else:
            fields.append((_size_of(item.name), item.size_kind))
            fields.append((item.name, item.kind, (sizes[item.name],)))
    return np.dtype(fields)
