"""The arrays on the points and cells of a legacy VTK file."""

from __future__ import annotations

from dataclasses import dataclass, field
from urllib.parse import unquote

import numpy as np

from ...base.arrays import AnyArray
from .legacy_numbers import LegacyNumbers

_FIXED_WIDTHS = {
    "VECTORS": 3,
    "NORMALS": 3,
    "TENSORS": 9,
    "TENSORS6": 6,
    "GLOBAL_IDS": 1,
    "PEDIGREE_IDS": 1,
    "EDGE_FLAGS": 1,
}
_NO_FIELDS = ("COLOR_SCALARS", "TEXTURE_COORDINATES", "GLOBAL_IDS", "PEDIGREE_IDS", "EDGE_FLAGS")
_COLORS_IN_TABLE = 4


@dataclass
class Arrays:
    """The arrays on the points, on the cells, or of the whole file.

    Attributes
    ----------
    section : {"POINT_DATA", "CELL_DATA", ""}
        Where they are; those of the whole file are not kept.
    n_rows : int
    has_codes : bool
        Whether blanks and other characters in names are written as %20 and the like.
    kept : dict of str to (n_rows, ...) array
    skipped : list of str
        What is no field.
    """

    section: str = ""
    n_rows: int = 0
    has_codes: bool = True
    kept: dict[str, AnyArray] = field(default_factory=dict)
    skipped: list[str] = field(default_factory=list)

    def read(self, words: list[str], numbers: LegacyNumbers) -> None:
        """Read what begins with a line of words: one array, or a field of several."""
        section = words[0].upper()
        if section == "METADATA":
            numbers.skip_metadata()
        elif section == "FIELD":
            for _ in range(count_in(words, 2)):
                self._read_in_field(numbers)
        elif section == "LOOKUP_TABLE" and self.section:
            n = _COLORS_IN_TABLE * count_in(words, 2)
            numbers.read(_type_of_colors(numbers), n)
        elif self.section:
            self._read_attribute(section, words, numbers)
        else:
            raise ValueError(f"the section {section[:40]!r} is not known")

    def _read_in_field(self, numbers: LegacyNumbers) -> None:
        words = numbers.next_words()
        while words[:1] == ["METADATA"]:
            numbers.skip_metadata()
            words = numbers.next_words()
        if len(words) != 4:
            raise ValueError("it is truncated: a field has fewer arrays than announced")
        name, kind = self._name(words[0]), words[3]
        width, n = count_in(words, 1), count_in(words, 2)
        if self.section and n != self.n_rows:
            raise ValueError(f"field {name!r} has {n} values, not {self.n_rows}")
        values = _values(numbers, kind, n, width)
        if self.section:
            self._keep(name, values)

    def _read_attribute(self, section: str, words: list[str], numbers: LegacyNumbers) -> None:
        name = self._name(word_in(words, 1))
        if section == "SCALARS":
            kind, width = word_in(words, 2), count_in(words, 3) if len(words) > 3 else 1
            if numbers.peek().upper().startswith("LOOKUP_TABLE"):
                numbers.next_words()
        elif section == "COLOR_SCALARS":
            kind, width = _type_of_colors(numbers), count_in(words, 2)
        elif section == "TEXTURE_COORDINATES":
            kind, width = word_in(words, 3), count_in(words, 2)
        elif section in _FIXED_WIDTHS:
            kind, width = word_in(words, 2), _FIXED_WIDTHS[section]
        else:
            raise ValueError(f"the section {section[:40]!r} is not known")
        values = _values(numbers, kind, self.n_rows, width)
        self._keep(name, None if section in _NO_FIELDS else values)

    def _name(self, word: str) -> str:
        return unquote(word) if self.has_codes else word

    def _keep(self, name: str, values: AnyArray | None) -> None:
        if values is None:
            self.skipped.append(f"{self.section} {name}")
            return
        if values.shape[1] == 0:
            raise ValueError(f"the array {name!r} has no components")
        values = values[:, 0] if values.shape[1] == 1 else values
        # VTK writes what are its scalars and its vectors at once as both
        is_same = name in self.kept and np.array_equal(
            self.kept[name], values, equal_nan=values.dtype.kind == "f"
        )
        if name in self.kept and not is_same:
            raise ValueError(f"it has two different arrays {name!r}: only one can be meant")
        self.kept[name] = values


def _values(numbers: LegacyNumbers, kind: str, n_rows: int, width: int) -> AnyArray | None:
    """Return the next rows, none if they are words."""
    if kind.lower() == "string":
        numbers.skip_strings(n_rows * width)
        return None
    return numbers.read(kind, n_rows * width).reshape(n_rows, width)


def _type_of_colors(numbers: LegacyNumbers) -> str:
    return "float" if numbers.is_text else "unsigned_char"


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
