"""Other codes' names for our options, understood at the boundary only."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from typing import Any

from .metric.options import MMG_ALIASES, PETSC_PREFIX

STAGES = ("metric", "remesh", "transfer")

#: Mmg's spelling of an option, and ours.
MMG = {**MMG_ALIASES, "hausd": "hausdorff_number", "ar": "ridge_angle"}

#: Values by which other codes say "off", where we say None.
_OFF = {"gradation_factor": -1, "a_max": 0}


def canonical(options: Mapping[str, Any], known: Iterable[str]) -> dict[str, Any]:
    """Return the options under our names.

    Parameters
    ----------
    options : mapping
        Options under our names, PETSc's (flat ``dm_plex_metric_*``, or nested below
        ``dm_plex_metric``) or Mmg's, or nested below ``metric``, ``remesh`` or ``transfer``.
        PETSc's and Mmg's values for "off" (gradation -1, anisotropy 0) become None.
    known : iterable of str
        Our names.

    Raises
    ------
    ValueError
        If a name is unknown, or two spellings of one option are given.
    TypeError
        If a group is not a mapping.
    """
    names = tuple(known)
    found: dict[str, Any] = {}
    for given, value in _flattened(options):
        name = MMG.get(given, given.removeprefix(PETSC_PREFIX + "_"))
        if name not in names:
            raise ValueError(_unknown(given, names))
        if name in found:
            raise ValueError(f"option {name!r} is given twice (here as {given!r})")
        found[name] = None if name != given and _is_off(name, value) else value
    return found


def _flattened(options: Mapping[str, Any]) -> Iterable[tuple[str, Any]]:
    for key, value in options.items():
        if key == PETSC_PREFIX or key in STAGES:
            if not isinstance(value, Mapping):
                raise TypeError(f"option group {key!r} must be a mapping, not {value!r}")
            prefix = f"{PETSC_PREFIX}_" if key == PETSC_PREFIX else ""
            yield from ((prefix + name, item) for name, item in value.items())
        else:
            yield str(key), value


def _is_off(name: str, value: Any) -> bool:
    if name not in _OFF or isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return value == _OFF[name]


def _unknown(name: str, known: tuple[str, ...]) -> str:
    near = difflib.get_close_matches(name, (*known, *MMG), n=1)
    hint = f"did you mean {near[0]!r}?" if near else f"options: {', '.join(sorted(known))}"
    return f"unknown option {name!r}: {hint}"
