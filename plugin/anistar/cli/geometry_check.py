"""Checks of a geometry, of which a mesh is to be made."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from ..generating import PLC, SurfaceReport, read_plc_with_report
from ..generating.checking import PLCProblem, check_plc
from ..generating.checking.marks import write_marks
from . import console
from .files import writable_file

#: So many problems of each kind are marked.
MARKED = 10_000
#: So many of each kind are printed.
PRINTED = 10

#: What a geometry has no use for.
_OF_MESHES = ("metric", "reference", "output", "picture")


def run(arguments: argparse.Namespace) -> int:
    """Print what is wrong with a geometry; 1 if there is no mesh of it."""
    for flag in _OF_MESHES:
        if getattr(arguments, flag):
            raise ValueError(f"--{flag} is for meshes; {arguments.input} is a geometry")
    marks = writable_file(arguments.mark) if arguments.mark else None
    plc, read = read_plc_with_report(arguments.input)
    problems = check_plc(plc, listed=MARKED if marks else PRINTED)
    if marks is not None:
        _mark(marks, plc, problems)
    is_valid = not any(problem.is_severe for problem in problems)
    if arguments.json:
        console.show_json(_told(plc, read, problems, is_valid))
    else:
        _show(arguments.input, plc, read, problems, is_valid)
    return 0 if is_valid else 1


def _mark(path: Path, plc: PLC, problems: list[PLCProblem]) -> None:
    if path.suffix != ".vtu":
        raise ValueError(f"--mark writes .vtu, not {path.suffix}")
    write_marks(path, plc, problems)


def _told(
    plc: PLC, read: SurfaceReport, problems: list[PLCProblem], is_valid: bool
) -> dict[str, Any]:
    return {
        "valid": is_valid,
        "problems": [_as_dict(problem) for problem in problems],
        "read": read,
        **_counts(plc),
    }


def _as_dict(problem: PLCProblem) -> dict[str, Any]:
    names = ("kind", "is_severe", "message", "facets", "edges", "points", "where", "measure")
    return {name: getattr(problem, name) for name in (*names, "alike")}


def _counts(plc: PLC) -> dict[str, int]:
    return {
        "dim": plc.dim,
        "points": plc.n_points,
        "facets": plc.n_facets,
        "triangles": len(plc.triangles),
        "segments": len(plc.segments),
    }


def _show(
    name: str, plc: PLC, read: SurfaceReport, problems: list[PLCProblem], is_valid: bool
) -> None:
    console.show_table(name, ["", ""], [list(row) for row in _counts(plc).items()])
    for warning in read.warnings:
        console.say(f"read: {warning}")
    printed: dict[str, int] = {}
    for problem in problems:
        printed[problem.kind] = printed.get(problem.kind, 0) + 1
        if printed[problem.kind] <= PRINTED:
            word = problem.kind if problem.is_severe else f"{problem.kind} (allowed)"
            console.say(f"{word}: {problem.message}")
        if printed[problem.kind] == min(PRINTED, problem.alike) < problem.alike:
            console.say(f"{problem.kind}: {problem.alike - PRINTED} more")
    console.say("valid" if is_valid else "not valid: no mesh can be made of it")
