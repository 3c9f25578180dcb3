"""Settings of loops: those of their own, and those of the adaptations in them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields
from typing import Any, TypeVar

from ..base.option_names import canonical
from .adapt_options import AdaptOptions

Options = TypeVar("Options")

#: The stage of the options that are the loop's own, in the tables of names.
OWN = "loop"


def with_adapt_settings(
    kind: Callable[..., Options],
    options: Options | None,
    settings: Mapping[str, Any],
    *,
    adapt: AdaptOptions,
) -> Options:
    """Return options of a class with an `adapt`, with settings in place of theirs.

    A name that the loop and a stage of its adaptations share is the loop's. Without `options`
    its adaptations have those of `adapt`.

    Raises
    ------
    ValueError
        If a name is unknown or given twice, or a value is wrong.
    """
    names = [item.name for item in fields(kind)]  # type: ignore[arg-type]
    known = {OWN: names, **AdaptOptions.names()}
    found = canonical(settings, known)
    given = {} if options is None else {name: getattr(options, name) for name in names}
    merged = {**given, **found.pop(OWN)}
    stages: AdaptOptions = merged.pop("adapt", adapt)
    return kind(adapt=stages.with_settings(found), **merged)
