"""Flags for the options of every stage, under our names, PETSc's and Mmg's."""

from __future__ import annotations

import argparse
import csv
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from ..base.option_names import MMG
from ..loops.adapt_options import AdaptOptions
from ..metric.base.aliases import PETSC_PREFIX, asks_nothing, our_name, our_value
from ..transfer import METHODS, OUTSIDE

Number = TypeVar("Number", int, float)


def _number_or_off(name: str) -> Any:
    def parsed(text: str) -> Any:
        if text == "auto":
            return text
        return None if text == "off" else our_value(name, float(text))

    parsed.__name__ = "number or 'off'"
    return parsed


def numbers(text: str) -> tuple[float, ...]:
    """Parse comma-separated numbers."""
    return _listed(text, float, "numbers")


def _names(text: str) -> tuple[str, ...]:
    """Parse names or tags between commas; a name with a comma stands in double quotes."""
    (parts,) = csv.reader([text], skipinitialspace=True)
    return tuple(part.strip() for part in parts if part.strip())


def _size_at(text: str) -> tuple[tuple[str, float], ...]:
    """Parse sizes by tags or names: ``wall=0.1,hole small=0.02``."""
    sizes: list[tuple[str, float]] = []
    for part in _names(text):
        name, _, size = part.rpartition("=")
        try:
            sizes.append((name.strip(), float(size)))
        except ValueError as error:
            raise argparse.ArgumentTypeError(
                f"{text!r} is no list of sizes by name like wall=0.1,hole=0.02"
            ) from error
    return tuple(sizes)


def _listed(text: str, kind: Callable[[str], Number], what: str) -> tuple[Number, ...]:
    try:
        return tuple(kind(part) for part in text.split(",") if part)
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"{text!r} is no list of {what} like 1,2,3") from error


def _scale(text: str) -> Any:
    """Parse the scale of the fields: a word, a number, or one for each field."""
    if "=" in text:
        pairs = (pair.partition("=") for pair in text.split(","))
        return {name: _scale(value) for name, _, value in pairs}
    try:
        return float(text)
    except ValueError:
        return text


_SWITCH = {"on": True, "1": True, "true": True, "off": False, "0": False, "false": False}


def _switch(text: str) -> bool:
    """Parse on or off; PETSc says 1, true or nothing."""
    if text not in _SWITCH:
        raise argparse.ArgumentTypeError(f"must be on or off, not {text!r}")
    return _SWITCH[text]


_METRIC: dict[str, tuple[Any, str]] = {
    "target_complexity": (
        float,
        "complexity of the metric; a 2D mesh gets about 1.15 times as many points",
    ),
    "target_elements": (float, "number of elements to aim at, instead of a complexity"),
    "target_error": (float, "interpolation error to aim at, in units of the scale"),
    "max_elements": (float, "number of elements never to exceed"),
    "scale": (
        _scale,
        "what fields are compared by: complexity, range, std, none, a number, or u=range,v=2",
    ),
    "intersection_rule": (str, "of more than two metrics: pairwise or john"),
    "p": (float, "norm Lp in which the interpolation error is smallest (default 2)"),
    "h_min": (float, "smallest size, in mesh units (Mmg: -hmin)"),
    "h_max": (float, "largest size, in mesh units (Mmg: -hmax)"),
    "size_at": (
        _size_at,
        "largest sizes at facets or regions, by name or tag: wall=0.1,hole=0.02",
    ),
    "a_max": (_number_or_off("a_max"), "largest anisotropy, or off"),
    "restrict_anisotropy_first": (
        _switch,
        "apply the largest anisotropy to the Hessians as well: on or off",
    ),
    "max_coarsening": (
        _number_or_off("max_coarsening"),
        "growth of sizes against those of the mesh at most, or off (default)",
    ),
    "gradation_factor": (
        _number_or_off("gradation_factor"),
        "growth of sizes from edge to edge, or off, or auto (Mmg: -hgrad)",
    ),
    "gradation_model": (str, "physical, metric or mixed"),
    "max_distortion": (
        _number_or_off("max_distortion"),
        "bound on ln gamma, how much the metric changes over one unit edge, or off",
    ),
    "method": (
        str,
        "recovery of the Hessian: auto, quadratic, l2, mixed_l2, zz, clement or green; also "
        "--recovery",
    ),
    "recovery_mass": (str, "mass matrix of l2: lumped or consistent"),
    "recovery_boundary": (str, "at the boundary: auto, one_sided or extrapolated"),
    "interfaces": (_switch, "recover the sides of interfaces apart: on (default) or off"),
    "noise": (float, "standard deviation of the values; estimated if not given"),
}


def _agreement(text: str) -> bool | str:
    """Parse the flag of the agreement phase."""
    known: dict[str, bool | str] = {"auto": "auto", "on": True, "off": False}
    if text not in known:
        raise argparse.ArgumentTypeError(f"must be auto, on or off, not {text!r}")
    return known[text]


def _until_consistent(text: str) -> bool | str:
    """Parse the value of the flag of Algorithm 2."""
    if text not in ("on", "pure"):
        raise argparse.ArgumentTypeError(f"must be pure or nothing, not {text!r}")
    return text if text == "pure" else True


_REMESH: dict[str, tuple[Any, str]] = {
    "hausdorff_number": (
        float,
        "largest distance from a curved boundary, relative to the size "
        "(default 0.019, of surfaces 0.1; Mmg: -hausd)",
    ),
    "shape": (
        str,
        "smooth (default): the facets sample smooth curves and surfaces; "
        "polyhedron: they are the domain; faceted: the same, flat to the accuracy of floats",
    ),
    "ridge_angle": (float, "angle in degrees from which a corner is kept (Mmg: -ar)"),
    "max_vertices": (int, "stop at this number of vertices"),
    "max_seconds": (float, "stop after this time"),
    "max_memory": (float, "refuse what takes more bytes; inf: nothing (default: what is free)"),
    "max_refinement": (
        _number_or_off("max_refinement"),
        "factor by which sizes shrink against those of the mesh at most, or off, or auto "
        "(default): only where the mesh cannot resolve the metric",
    ),
    "frozen_tags": (
        _names,
        "tags or names of facets that are kept as they are, comma-separated; also --frozen",
    ),
    "agreement": (
        _agreement,
        "change the mesh until the stars agree: on, off, or auto (default): where the metric "
        "varies slowly enough",
    ),
    "until_consistent": (
        _until_consistent,
        "then insert points until every star is Delaunay in its own metric; "
        "pure: only that, from the boundary alone",
    ),
    "seed": (int, "of the random moves"),
    "threads": (int, "that work side by side; the result does not depend on it"),
}

_GENERATE: dict[str, tuple[Any, str]] = {
    "method": (
        str,
        "remesh (default): the mesher of anistar remesh; refine: Delaunay refinement with proved "
        "bounds; constrained: no more points than the facets need",
    ),
    "shape": (
        str,
        "polyhedron (default): the facets are the domain; smooth: samples of smooth surfaces",
    ),
    "ridge_angle": (float, "angle in degrees from which a smooth surface has a ridge"),
    "inside": (str, "what is meshed: regions (default), winding or nonzero"),
    "repair": (
        str,
        "what may be changed of what is wrong: none (default), orient, stitch, resolve",
    ),
    "bound": (float, "of refine: largest ratio of circumradius and shortest edge"),
    "sliver_dihedral": (
        float,
        "of refine: dihedral angle in degrees below which cells are slivers",
    ),
    "size_at": (_size_at, "largest sizes at facets or regions, by name or tag: wall=0.1,hole=0.02"),
    "growth": (float, "growth of sizes from edge to edge (default 1.5)"),
    "follow_widths": (
        _switch,
        "keep sizes below the widths of facets: on or off (default: on where there is no size)",
    ),
    "max_vertices": (int, "stop at this number of vertices"),
    "max_seconds": (float, "stop after this time"),
    "seed": (int, "of random choices"),
    "threads": (int, "that work side by side; the result does not depend on it"),
}

_REPEATED = ("frozen_tags", "size_at")
"""Flags that add to each other."""

_OPTIONAL_VALUE = {
    "until_consistent": ("pure",),
    "restrict_anisotropy_first": tuple(_SWITCH),
}
"""Flags that may stand alone, and then mean "on"; else one of these words follows."""


def add_metric_options(parser: argparse.ArgumentParser, *, without: Sequence[str] = ()) -> None:
    """Add the flags of `MetricOptions`, except those of which the command has its own."""
    table = {name: entry for name, entry in _METRIC.items() if name not in without}
    _add(parser.add_argument_group("metric"), table)


def add_remesh_options(parser: argparse.ArgumentParser) -> None:
    """Add the flags of `RemeshOptions`."""
    _add(parser.add_argument_group("remesh"), _REMESH)


def add_generate_options(parser: argparse.ArgumentParser) -> None:
    """Add the flags of `GenerateOptions`."""
    _add(parser.add_argument_group("generate"), _GENERATE)


def generate_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the options of `generate` that were given as flags."""
    given = vars(arguments)
    options = {name: given[name] for name in _GENERATE if name in given}
    if "size_at" in options:
        options["size_at"] = dict(options["size_at"])
    return options


def add_outside_option(parser: argparse.ArgumentParser, default: str) -> None:
    """Add the flag for target points outside the source mesh."""
    parser.add_argument(
        "--outside",
        choices=OUTSIDE,
        default=default,
        help=f"values at points outside the source mesh (default {default})",
    )


def add_transfer_method_option(parser: argparse.ArgumentParser) -> None:
    """Add the flag for how fields are carried to the adapted mesh."""
    parser.add_argument(
        "--transfer-method",
        choices=METHODS,
        default=METHODS[0],
        help=f"how fields are carried over (default {METHODS[0]})",
    )


def adapt_options(arguments: argparse.Namespace, **extra: Any) -> AdaptOptions:
    """Return the options that were given as flags."""
    given = vars(arguments)
    options = {name: given[name] for name in (*_METRIC, *_REMESH) if name in given}
    if "size_at" in options:
        options["size_at"] = dict(options["size_at"])
    carried = {"method": given.get("transfer_method"), "outside": given.get("outside")}
    transfer = {name: value for name, value in carried.items() if value is not None}
    return AdaptOptions.from_dict({**options, "transfer": transfer, **extra})


def canonical_flags(words: Sequence[str]) -> list[str]:
    """Return the words with PETSc's and Mmg's flags replaced by ours.

    ``-hmin``, ``--hmin``, ``--h_min`` and ``-dm_plex_metric_h_min`` all become ``--h-min``. A flag
    that may stand alone does so unless one of its values follows, so that it never takes the name
    of a file. PETSc's flags that ask for what holds anyway are left out.
    """
    found: list[str] = []
    rest = list(words)
    while rest:
        word = rest.pop(0)
        flag, equals, value = word.partition("=")
        name = our_name(flag.lstrip("-").replace("-", "_"), MMG)
        if not flag.startswith("-") or flag == "-p":
            found.append(word)
        elif name in (*_METRIC, *_REMESH, *_GENERATE):
            alone = not equals and name in _OPTIONAL_VALUE
            if alone and (not rest or rest[0] not in _OPTIONAL_VALUE[name]):
                equals, value = "=", "on"
            found.append(f"--{name.replace('_', '-')}{equals}{value}")
        elif flag.lstrip("-").startswith(PETSC_PREFIX):
            follows = not equals and bool(rest) and _petsc_value(rest[0]) is not None
            given = _petsc_value(rest[0] if follows else value or "true")
            if not asks_nothing(name, given):
                found.append(word)
            elif follows:
                rest.pop(0)
        else:
            found.append(word)
    return found


def _petsc_value(text: str) -> float | None:
    """Return the number that PETSc reads in a word, also of switches; None where there is none."""
    if text in _SWITCH:
        return float(_SWITCH[text])
    try:
        return float(text)
    except ValueError:
        return None


def _add(group: argparse._ArgumentGroup, table: dict[str, tuple[Any, str]]) -> None:
    for name, (kind, text) in table.items():
        optional: dict[str, Any] = {}
        if name in _OPTIONAL_VALUE:
            optional = {"nargs": "?", "const": True}
        if name in _REPEATED:
            optional = {"action": "extend"}
        group.add_argument(
            f"--{name.replace('_', '-')}",
            dest=name,
            type=kind,
            default=argparse.SUPPRESS,
            **optional,
            metavar="X" if kind is not str else "NAME",
            help=text,
        )
