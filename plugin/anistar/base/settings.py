"""Options given by name, one by one, beside or in place of an object that holds all of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from typing import Any, TypeVar

from .arguments import require
from .option_names import canonical

Options = TypeVar("Options")


def chosen(
    kind: Callable[[], Options], options: Options | None, settings: Mapping[str, Any]
) -> Options:
    """Return options with settings in place of theirs.

    Parameters
    ----------
    kind : class of options
    options : its instance, optional
        The defaults of the class if None.
    settings : mapping
        Single options by our names, PETSc's or Mmg's.

    Raises
    ------
    TypeError
        If `options` is of another class.
    ValueError
        If a name is unknown or given twice; the nearest name is suggested.
    """
    base = kind() if options is None else options
    require(type(kind()), options=base)
    if not settings:
        return base
    names = [item.name for item in fields(base)]  # type: ignore[arg-type]
    return replace(base, **canonical(settings, {"options": names})["options"])  # type: ignore[type-var]
