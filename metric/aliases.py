"""Names and values by which PETSc and Mmg say our options."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

PETSC_PREFIX = "dm_plex_metric"

#: Mmg's spelling of an option of the metric, and ours.
MMG_ALIASES = {"hmin": "h_min", "hmax": "h_max", "hgrad": "gradation_factor"}

#: Another word of ours for an option.
SYNONYMS = {"recovery": "method"}


def flattened(options: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Yield names and values with PETSc's group ``{"dm_plex_metric": {...}}`` opened.

    Raises
    ------
    TypeError
        If the group is not a mapping.
    """
    for key, value in options.items():
        if key == PETSC_PREFIX:
            if not isinstance(value, Mapping):
                raise TypeError(f"option group {key!r} must be a mapping, not {value!r}")
            yield from ((f"{PETSC_PREFIX}_{name}", item) for name, item in value.items())
        else:
            yield str(key), value


def our_name(given: str, mmg: Mapping[str, str] = MMG_ALIASES) -> str:
    """Return our name of an option that may be PETSc's or Mmg's."""
    name = mmg.get(given, given.removeprefix(PETSC_PREFIX + "_"))
    return SYNONYMS.get(name, name)


def our_value(name: str, value: Any) -> Any:
    """Return None for the numbers by which other codes say "off", else the value.

    These are a gradation factor below 0 and an anisotropy of 0.
    """
    if isinstance(value, bool) or not isinstance(value, int | float):
        return value
    is_off = (name == "gradation_factor" and value < 0) or (name == "a_max" and value == 0)
    return None if is_off else value
