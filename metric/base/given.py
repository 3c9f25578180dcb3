"""Fields as users give them: by name, as one array, or as all that the mesh object holds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from .mesh import Background, values_of

AnyFields: TypeAlias = Mapping[str, Any] | ArrayLike | str | None
"""Fields by name, one array, names of fields in the mesh object, or None for all of them."""

#: The name of a field that is given as one array.
UNNAMED = "u"


class Given(NamedTuple):
    """The fields of a call, and the names of those that are meant; None if none is singled out."""

    fields: dict[str, Any]
    names: tuple[str, ...] | None

    def named(self) -> dict[str, Any]:
        """Return the fields that are singled out, or all."""
        return {name: self.fields[name] for name in self.names or self.fields}

    def for_metric(self) -> dict[str, Any]:
        """Return the fields that are singled out, or all scalars and vectors.

        Those in cells count where there are none at the points.
        """
        if self.names is not None:
            return self.named()
        usable = {name: field for name, field in self.fields.items() if _is_usable(field)}
        at_points = {name: field for name, field in usable.items() if field.on == "points"}
        return at_points or usable


def given_fields(held: Mapping[str, Any], given: Any) -> Given:
    """Return the fields that a call is about.

    Parameters
    ----------
    held : mapping of str to Field
        The fields in the mesh object, which stay beside those that are given.
    given : mapping, array, name, sequence of names, or None
        New fields by name; one array, which is called ``u``; names of fields in the object; or
        None, for all of those.

    Raises
    ------
    ValueError
        If a name is unknown, or there is no field at all.
    """
    if isinstance(given, Mapping):
        fields = {name: values_of(values) for name, values in given.items()}
        return Given({**held, **fields}, tuple(fields))
    names = _names(given)
    if names is None and given is not None:
        name = UNNAMED
        while name in held:  # which stays
            name += "_"
        return Given({**held, name: values_of(given)}, (name,))
    for name in names or ():
        if name not in held:
            known = ", ".join(map(repr, held)) or "none"
            raise ValueError(f"the mesh object has no field {name!r}; it has {known}")
    if not held:
        raise ValueError("no fields are given, and the mesh object has none: give {'u': array}")
    return Given(dict(held), names)


def given_values(held: Background, u: Any) -> Any:
    """Return values, or the field of the mesh object that has the name `u`."""
    if isinstance(u, str):
        return given_fields(held.fields, u).fields[u]
    return values_of(u)


def refuse_masked(values: Any) -> None:
    """Raise ValueError if some of the values are masked: nobody knows what they are."""
    if np.ma.is_masked(values):
        rows = np.ma.getmaskarray(values).reshape(len(values), -1).any(axis=1)
        raise ValueError(
            f"{rows.sum()} values are masked, the first is value {np.argmax(rows)}: give what is "
            "to stand there, such as values.filled(0.0)"
        )


def _names(given: Any) -> tuple[str, ...] | None:
    if isinstance(given, str):
        return (given,)
    if isinstance(given, Sequence) and len(given) and all(isinstance(item, str) for item in given):
        return tuple(given)
    return None


def _is_usable(field: Any) -> bool:
    return field.on in ("points", "cells") and field.kind in ("scalar", "vector")
