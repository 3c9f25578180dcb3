"""The arrays on the points and cells of a legacy VTK file."""

from __future__ import annotations

import numpy as np

from .raw import Array
from .vtk_numbers import LegacyNumbers

_FIXED_WIDTHS = {"VECTORS": 3, "NORMALS": 3, "TENSORS": 9, "TENSORS6": 6}


def read_arrays(
    data: dict[str, Array] | None, n_rows: int, words: list[str], numbers: LegacyNumbers
) -> None:
    """Read what begins with `words`: one array, or a field of several.

    A field before the data of points and cells is about the whole file, and not kept.
    """
    section = words[0].upper()
    if section == "METADATA":
        numbers.skip_metadata()
    elif section == "FIELD":
        for _ in range(count_in(words, 2)):
            name, width, n, kind = _head_in_field(numbers)
            values = numbers.read(kind, width * n)
            if data is not None:
                if n != n_rows:
                    raise ValueError(f"field {name!r} has {n} values, not {n_rows}")
                _keep(data, name, values.reshape(n, width))
    elif data is None:
        raise ValueError(f"the section {section[:40]!r} is not known")
    elif section == "SCALARS":
        width = count_in(words, 3) if len(words) > 3 else 1
        if numbers.peek().upper().startswith("LOOKUP_TABLE"):
            numbers.next_words()
        _keep(
            data,
            word_in(words, 1),
            numbers.read(word_in(words, 2), width * n_rows).reshape(n_rows, width),
        )
    elif section == "LOOKUP_TABLE":
        numbers.read("float" if numbers.is_text else "unsigned_char", 4 * count_in(words, 2))
    elif section in _FIXED_WIDTHS:
        width = _FIXED_WIDTHS[section]
        _keep(
            data,
            word_in(words, 1),
            numbers.read(word_in(words, 2), width * n_rows).reshape(n_rows, width),
        )
    else:
        raise ValueError(f"the section {section[:40]!r} is not known")


def _head_in_field(numbers: LegacyNumbers) -> tuple[str, int, int, str]:
    words = numbers.next_words()
    while words[:1] == ["METADATA"]:
        numbers.skip_metadata()
        words = numbers.next_words()
    if len(words) != 4:
        raise ValueError("it is truncated: a field has fewer arrays than announced")
    return words[0], count_in(words, 1), count_in(words, 2), words[3]


def _keep(data: dict[str, Array], name: str, values: Array) -> None:
    if values.shape[1] == 0:
        raise ValueError(f"the array {name!r} has no components")
    values = values[:, 0] if values.shape[1] == 1 else values
    # VTK writes what are its scalars and its vectors at once as both
    is_same = name in data and np.array_equal(
        data[name], values, equal_nan=values.dtype.kind == "f"
    )
    if name in data and not is_same:
        raise ValueError(f"it has two different arrays {name!r}: only one can be meant")
    data[name] = values


def word_in(words: list[str], at: int) -> str:
    """Return the word at a place in a line, where there must be one."""
    if at >= len(words):
        raise ValueError(f"{' '.join(words)[:60]!r} has no name or type")
    return words[at]


def count_in(words: list[str], at: int) -> int:
    """Return the number of things at a place in a line."""
    longest = len(str(2**63))
    if at >= len(words) or not words[at].isdecimal() or len(words[at]) > longest:
        raise ValueError(f"{' '.join(words)[:60]!r} has no count")
    return int(words[at])
