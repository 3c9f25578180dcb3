"""Flags of what makes loops settle."""

from __future__ import annotations

import argparse
from typing import Any

from ..loops.keeping import KeepOptions
from ..loops.settling import Settled
from .options import numbers

OFF = "off"

_KEPT = {
    "under": "share of edges longer than sqrt(2)",
    "misplaced": "share of edges shorter than 1/sqrt(2), where some are too long,",
    "over": "share of points beyond what the metric needs",
    "longest": "longest edge",
}
"""Bounds of `KeepOptions`."""


def add_settling_options(parser: argparse.ArgumentParser, *, is_loop: bool) -> None:
    """Add the flags that loops have beyond one adaptation; a study has fewer."""
    group = parser.add_argument_group("loop")
    group.add_argument(
        "--max-coarsening",
        dest="hold",
        type=_ratio,
        default=argparse.SUPPRESS,
        metavar="X",
        help="growth of sizes from one mesh to the next at most (default 2), or off",
    )
    group.add_argument(
        "--settled",
        type=_settled,
        default=argparse.SUPPRESS,
        metavar="P,E",
        help="leave out repeats of a complexity when points and errors change by less than these "
        f"shares (default {_default(is_loop)}), or off",
    )
    if not is_loop:
        return
    for name, text in _KEPT.items():
        group.add_argument(
            f"--keep-{name}",
            type=float,
            default=argparse.SUPPRESS,
            metavar="X",
            help=f"leave them out also when the mesh fits: {text} at most",
        )


def settling_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the options of a loop that were given as flags."""
    given = vars(arguments)
    found: dict[str, Any] = {}
    if "hold" in given:
        found["max_coarsening"] = given["hold"]
    if "settled" in given:
        found["settled"] = given["settled"]
    bounds = {name: given[f"keep_{name}"] for name in _KEPT if f"keep_{name}" in given}
    if bounds:
        found["keep"] = KeepOptions(**bounds)
    return found


def _default(is_loop: bool) -> str:
    return f"{Settled().points:g},{Settled().error:g}" if is_loop else OFF


def _ratio(text: str) -> float | None:
    """Parse a factor or off."""
    return None if text == OFF else float(text)


def _settled(text: str) -> Settled | None:
    """Parse two shares or off."""
    if text == OFF:
        return None
    found = numbers(text)
    if len(found) != 2:
        raise argparse.ArgumentTypeError(f"{text!r} must be two shares, of points and errors")
    return Settled(points=found[0], error=found[1])
