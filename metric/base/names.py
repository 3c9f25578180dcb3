"""Names of tags, where either may stand."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping, Sequence
from operator import index
from typing import TypeAlias, cast

import numpy as np

from .arrays import Ints

Names: TypeAlias = Mapping[tuple[int, int], str]
"""Names by (dimension, tag)."""

Tag: TypeAlias = int | str
"""A tag, or its name."""


def tags_called(
    wanted: Tag | Sequence[Tag], names: Names, dim: int, present: Ints, *, kind: str = "facet"
) -> list[int]:
    """Return the tags of a dimension that are called, or are, what is wanted.

    Parameters
    ----------
    wanted : int, str, or sequence of these
        A name may belong to several tags.
    names : mapping of (dim, tag) to str
    dim : int
        Of the tagged entities.
    present : (k,) int array
        The tags that the entities have.
    kind : str
        What the entities are called in messages.

    Raises
    ------
    ValueError
        If no entity has such a tag or name; the nearest name is suggested.
    """
    found: list[int] = []
    there = set(np.unique(present).tolist())
    for one in _listed(wanted):
        tags = _tags_of_name(one, names, dim, there, kind) if isinstance(one, str) else [index(one)]
        missing = sorted(set(tags) - there)
        if len(missing) == len(tags):
            raise ValueError(
                f"no {kind} has tag {missing[0]}; the tags are "
                f"{', '.join(map(str, sorted(there))) or 'none'}"
            )
        found += tags
    return found


def _tags_of_name(name: str, names: Names, dim: int, there: set[int], kind: str) -> list[int]:
    """Return the tags with a name; digits that are no name are a tag, as on a command line."""
    tags = [tag for (d, tag), known in names.items() if d == dim and known == name]
    as_tag = int(name) if name.lstrip("-").isdecimal() else None
    if tags and as_tag in there and as_tag not in tags:
        raise ValueError(
            f"{name!r} is the name of the {kind}s with tag {tags[0]}, and another tag: say which "
            "by a name of its own, or in Python by the number"
        )
    if not tags and as_tag is None:
        raise ValueError(unknown_name(name, names, dim, kind))
    return tags or [cast(int, as_tag)]


def unknown_name(name: str, names: Names, dim: int, kind: str) -> str:
    """Return what to say of a name that no entity of a dimension has."""
    known = sorted({other for (d, _), other in names.items() if d == dim})
    near = difflib.get_close_matches(name, known, n=1)
    if near:
        return f"no {kind} is called {name!r}: did you mean {near[0]!r}?"
    return f"no {kind} is called {name!r}; the names are {', '.join(known) or 'none'}"


def _listed(wanted: Tag | Sequence[Tag] | Iterable[Tag]) -> list[Tag]:
    if isinstance(wanted, str):
        return [wanted]
    return list(np.atleast_1d(np.asarray(wanted, dtype=object)))
