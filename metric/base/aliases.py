"""Names and values by which PETSc and Mmg say our options."""

from __future__ import annotations

import difflib
from collections.abc import Collection, Iterator, Mapping
from typing import Any

PETSC_PREFIX = "dm_plex_metric"

#: Mmg's spelling of an option of the metric, and ours.
MMG_ALIASES = {"hmin": "h_min", "hmax": "h_max", "hgrad": "gradation_factor"}

#: Another word of ours for an option.
SYNONYMS = {"recovery": "method", "frozen": "frozen_tags"}
_IS_OFF = (False, -1)

#: Options of PETSc and Mmg that we have no counterpart for: values by which they ask for nothing
#: (None: any), and what to do instead.
FOREIGN: dict[str, tuple[tuple[float, ...] | None, str]] = {
    "hausdorff_number": ((), "it is an option of remeshing"),
    "hausd": ((), "it is an option of remeshing, hausdorff_number"),
    "ar": ((), "it is an option of remeshing, ridge_angle"),
    "isotropic": (_IS_OFF, "a_max=1 makes a metric isotropic"),
    "uniform": (_IS_OFF, "anistar.metric.from_sizes makes uniform metrics"),
    "no_insert": (_IS_OFF, "vertices are always inserted where the metric asks for them"),
    "no_swap": (_IS_OFF, "edges and facets are always swapped"),
    "no_move": (_IS_OFF, "vertices are always moved"),
    "no_surf": (_IS_OFF, "frozen_tags keeps boundary facets as they are"),
    "num_iterations": (None, "it is ParMmg's"),
    "verbosity": (None, "logging sets what is told"),
    "hgradreq": (_IS_OFF, "frozen facets have no gradation of their own"),
    "hsiz": ((-1,), "h_min and h_max of one value make a uniform size"),
    "optim": (_IS_OFF, "remesh with the metric that the mesh itself implies"),
    "nr": (_IS_OFF, "ridge_angle=180 finds no ridges"),
    "noinsert": (_IS_OFF, "vertices are always inserted where the metric asks for them"),
    "noswap": (_IS_OFF, "edges and facets are always swapped"),
    "nomove": (_IS_OFF, "vertices are always moved"),
    "nosurf": (_IS_OFF, "frozen_tags keeps boundary facets as they are"),
}


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


def asks_nothing(given: str, value: Any) -> bool:
    """Whether an option of PETSc or Mmg that we do not have is set to what holds here anyway."""
    harmless, _ = FOREIGN.get(our_name(given), ((), ""))
    return harmless is None or (isinstance(value, int | float) and value in harmless)


def advice(given: str, known: Collection[str]) -> str:
    """Say what to give instead of an unknown option: our counterpart, or the nearest name."""
    name = our_name(given)
    if name in FOREIGN:
        return f"it has no counterpart here, {FOREIGN[name][1]}"
    near = difflib.get_close_matches(name, [*known, *MMG_ALIASES, *FOREIGN], n=1)
    return f"did you mean {near[0]!r}?" if near else f"known: {', '.join(sorted(set(known)))}"
