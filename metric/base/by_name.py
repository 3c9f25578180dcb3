"""Classes of options, which take every option by its name."""

from __future__ import annotations

import functools
from dataclasses import fields
from typing import Any, TypeVar

import numpy as np

from .aliases import advice

Class = TypeVar("Class", bound=type)


def by_name(cls: Class) -> Class:
    """Let a dataclass of options say what is wrong with a call of it, with the nearest name.

    Its errors are those of any keyword-only class, a TypeError each.
    """
    names = [item.name for item in fields(cls)]
    plain = cls.__init__  # type: ignore[misc]  # of this very class

    @functools.wraps(plain)
    def init(self: Any, *given: Any, **named: Any) -> None:
        if given:
            raise TypeError(
                f"{cls.__name__} takes its options by name, got {given[0]!r} without one; "
                f"the names are {', '.join(names)}"
            )
        for name in named.keys() - set(names):
            raise TypeError(f"{cls.__name__} has no option {name!r}: {advice(name, names)}")
        plain(self, **named)

    cls.__init__ = init  # type: ignore[misc]
    return cls


def require_numbers(**given: Any) -> None:
    """Raise TypeError if a value that is given is no number."""
    for name, value in given.items():
        if value is not None and not isinstance(value, int | float | np.number):
            raise TypeError(f"{name} must be a number, got {value!r}")
