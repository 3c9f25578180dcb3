"""The JSON that our files carry in comments: names of tags, height, names and kinds of fields."""

from __future__ import annotations

import json
import math
from collections.abc import Collection
from typing import Any

Names = dict[tuple[int, int], str]


def note_of(text: str) -> Any:
    """Return the values of a note.

    Raises
    ------
    ValueError
        If it is not JSON, nested too deeply, or holds what JSON has no number for.
    """
    try:
        return json.loads(text, parse_constant=_refuse_constant)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"a comment of anistar is not JSON: {error}") from error


def _refuse_constant(name: str) -> None:
    raise ValueError(f"{name} is no number of JSON")


def names_of(entries: Any) -> Names:
    """Return the names in ``[[dim, tag, name], ...]`` by (dim, tag).

    Raises
    ------
    ValueError
        If the note has another form, or names a tag twice.
    """
    names: Names = {}
    for entry in _listed(entries, "names"):
        dim, tag, name = _entry(entry, (int, int, str), "names")
        if not 0 <= dim <= 3 or not -(2**31) <= tag < 2**31:
            raise ValueError(f"the names in its comments are damaged: no tag {tag} in {dim}D")
        if (dim, tag) in names:
            raise ValueError(f"the names in its comments give tag {tag} in {dim}D two names")
        names[dim, tag] = name
    return names


def fields_of(note: Any, places: Collection[str]) -> dict[str, list[tuple[str, str]]]:
    """Return names and kinds in ``{place: [[name, kind], ...], ...}``.

    Raises
    ------
    ValueError
        If the note has another form, or names a field twice at one place.
    """
    if not isinstance(note, dict) or not note.keys() <= set(places):
        raise ValueError("the fields in its comments are damaged")
    found = {}
    for place, entries in note.items():
        pairs = [_entry(entry, (str, str), "fields") for entry in _listed(entries, "fields")]
        if len({name for name, _ in pairs}) < len(pairs):
            raise ValueError("the fields in its comments are damaged: a name is given twice")
        found[place] = pairs
    return found


def labels_of(values: Any) -> set[str]:
    """Return the names of labels in ``[name, ...]``; raise ValueError if it has another form."""
    if not all(isinstance(name, str) for name in _listed(values, "labels")):
        raise ValueError("the labels in its comments are damaged: a name is no text")
    return set(values)


def height_of(value: Any) -> float:
    """Return the height of a plane; raise ValueError if it is no finite number."""
    if type(value) not in (int, float) or not math.isfinite(value):
        raise ValueError(f"the height z in its comments is damaged: {str(value)[:60]}")
    return float(value)


def _listed(values: Any, what: str) -> list[Any]:
    if not isinstance(values, list):
        raise ValueError(f"the {what} in its comments are damaged: they are no list")
    return values


def _entry(entry: Any, types: tuple[type, ...], what: str) -> Any:
    # exact types: a bool is an int as well
    if not isinstance(entry, list) or tuple(map(type, entry)) != types:
        raise ValueError(f"the {what} in its comments are damaged: {str(entry)[:60]}")
    return tuple(entry)
