"""Other codes' names for our options, understood at the boundary only."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from ..metric.base.aliases import (
    MMG_ALIASES,
    advice,
    asks_nothing,
    flattened,
    our_name,
    our_value,
)

#: Mmg's spelling of an option, and ours.
MMG = {**MMG_ALIASES, "hausd": "hausdorff_number", "ar": "ridge_angle"}

Known = Mapping[str, Sequence[str]]


def canonical(options: Mapping[str, Any], known: Known) -> dict[str, dict[str, Any]]:
    """Return the options under our names, sorted by the stage they belong to.

    Parameters
    ----------
    options : mapping
        Options under our names, PETSc's (flat ``dm_plex_metric_*``, or nested below
        ``dm_plex_metric``) or Mmg's, or nested below the name of a stage. PETSc's and Mmg's
        values for "off" (gradation -1, anisotropy 0) become None.
    known : mapping of str to sequence of str
        Our names by stage. A name that several stages have belongs to the first of them, unless
        it is nested below another.

    Raises
    ------
    ValueError
        If a name is unknown, or two spellings of one option are given.
    TypeError
        If a group is not a mapping.
    """
    found: dict[str, dict[str, Any]] = {stage: {} for stage in known}
    for stages, given, value in _placed(options, known):
        name = our_name(given, MMG)
        owner = next((stage for stage in stages if name in known[stage]), None)
        if owner is None:
            if asks_nothing(given, value):
                continue
            names = [item for stage in stages for item in known[stage]]
            raise ValueError(f"unknown option {given!r}: {advice(given, names)}")
        if name in found[owner]:
            raise ValueError(f"option {name!r} is given twice (here as {given!r})")
        found[owner][name] = value if name == given else our_value(name, value)
    return found


def _placed(options: Mapping[str, Any], known: Known) -> Iterable[tuple[tuple[str, ...], str, Any]]:
    """Yield each option with the stages that it may belong to.

    The options of a whole stage may be an option themselves.
    """
    stages = tuple(known)
    for key, value in flattened(options):
        if key in stages and isinstance(value, Mapping):
            yield from (((key,), name, item) for name, item in flattened(value))
        elif key in stages and not any(key in names for names in known.values()):
            raise TypeError(f"option group {key!r} must be a mapping, not {value!r}")
        else:
            yield stages, key, value
