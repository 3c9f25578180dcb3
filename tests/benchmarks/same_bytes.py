"""Compare every result of two installed versions of anistar, to the bit.

usage: python tests/benchmarks/same_bytes.py against FOLDER [--quick]
       python tests/benchmarks/same_bytes.py write FILE.json [--quick]
       python tests/benchmarks/same_bytes.py compare BEFORE.json AFTER.json

`write` digests the meshes, metrics and fields of many cases and writes down every figure of the
reports but times, with the anistar that this Python imports. `compare` names each that differs.
`against` does both for the anistar installed in a folder (``pip install --target``) and for the
one imported: exit status 0 says that a change of the sources changed no result.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

TESTS = Path(__file__).resolve().parents[1]
HELPERS = [TESTS, TESTS / "remesh", TESTS / "same_bytes"]
WRITER = Path(__file__).with_name("written_results.py")

SHOWN = 6
"""Of the figures of one case that differ, how many are printed."""

MISSING = "-"

Figures = Mapping[str, Any]
Case = Mapping[str, Figures]


def write(file: Path, *, quick: bool, site: Path | None = None) -> None:
    """Write the results of the anistar in a folder, or of the one that is imported."""
    command = [sys.executable, str(WRITER), str(file), *(["--quick"] if quick else [])]
    given = [os.environ["PYTHONPATH"]] if os.environ.get("PYTHONPATH") else []
    path = [*([str(site)] if site else []), *given, *map(str, HELPERS)]
    subprocess.run(command, env={**os.environ, "PYTHONPATH": os.pathsep.join(path)}, check=True)


def differences(before: Mapping[str, Case], after: Mapping[str, Case]) -> list[str]:
    """Return a line for each case that differs."""
    lines = [f"{name}: only before" for name in before if name not in after]
    lines += [f"{name}: only after" for name in after if name not in before]
    for name in before:
        if name in after and (found := difference(before[name], after[name])):
            lines.append(f"{name}: {found}")
    return lines


def difference(before: Case, after: Case) -> str:
    """Return which arrays and figures of a case differ, an empty text if none."""
    arrays = changed(before["arrays"], after["arrays"])
    figures = changed(before["figures"], after["figures"])
    if not arrays and not figures:
        return ""
    told = [f"arrays differ: {', '.join(arrays)}" if arrays else "arrays equal"]
    if figures:
        old, new = before["figures"], after["figures"]
        shown = [f"{name} {old.get(name, MISSING)} -> {new.get(name, MISSING)}" for name in figures]
        more = [f"{len(figures) - SHOWN} more"] if len(figures) > SHOWN else []
        told.append(f"figures differ: {', '.join(shown[:SHOWN] + more)}")
    return "; ".join(told)


def changed(before: Figures, after: Figures) -> list[str]:
    """Return the names whose values differ or that only one of two has."""
    return [
        name
        for name in {**before, **after}
        if bits(before.get(name, MISSING)) != bits(after.get(name, MISSING))
    ]


def bits(value: Any) -> str:
    """Return a value as text that tells floats apart to the bit, and a count from none."""
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return float(value).hex() if is_number else str(value)


def compare(before: Path, after: Path) -> int:
    """Print what differs between two files; 1 if anything does."""
    first, second = (json.loads(file.read_text(encoding="utf-8")) for file in (before, after))
    lines = differences(first, second)
    print(*lines, f"{len(first.keys() | second.keys())} cases, {len(lines)} differ", sep="\n")
    return 1 if lines else 0


def against(site: Path, *, quick: bool) -> int:
    """Compare the anistar in a folder with the one that is imported."""
    with tempfile.TemporaryDirectory() as folder:
        before, after = Path(folder) / "before.json", Path(folder) / "after.json"
        write(before, quick=quick, site=site)
        write(after, quick=quick)
        return compare(before, after)


def main(arguments: list[str] | None = None) -> int:
    """Write, compare, or do both."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    commands = parser.add_subparsers(dest="command", required=True)
    for name, argument in (("write", "file"), ("against", "site")):
        command = commands.add_parser(name)
        command.add_argument(argument, type=Path)
        command.add_argument("--quick", action="store_true", help="the small cases alone")
    command = commands.add_parser("compare")
    command.add_argument("before", type=Path)
    command.add_argument("after", type=Path)
    chosen = parser.parse_args(arguments)
    if chosen.command == "compare":
        return compare(chosen.before, chosen.after)
    if chosen.command == "against":
        if not (chosen.site / "anistar").is_dir():  # else the version imported meets itself
            parser.error(f"{chosen.site} has no installed anistar")
        return against(chosen.site, quick=chosen.quick)
    write(chosen.file, quick=chosen.quick)
    return 0


if __name__ == "__main__":
    sys.exit(main())
