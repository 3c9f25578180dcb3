"""Write what the cases of `same_bytes_cases` give: digests of arrays, and figures by name."""

from __future__ import annotations

import argparse
import dataclasses
import json
import logging
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from result_digests import digest
from same_bytes_cases import Results, runs

import anistar
from anistar import Mesh


def written(results: Results) -> dict[str, dict[str, Any]]:
    """Return the digest of each array and each figure of the reports."""
    arrays: dict[str, str] = {}
    figures: dict[str, Any] = {}
    for name, result in with_meshes_apart(results):
        if isinstance(result, str):
            arrays[name] = result
        elif isinstance(result, np.ndarray):
            arrays[name] = digest(result)
        else:
            figures |= dict(leaves(name, result))
    return {"arrays": arrays, "figures": figures}


def with_meshes_apart(results: Results) -> Iterator[tuple[str, Any]]:
    """Yield the results by name, of a mesh its arrays and the names of its tags."""
    for name, result in results.items():
        if isinstance(result, Mesh):
            yield from ((f"{name}.{part}", value) for part, value in result.arrays().items())
        else:
            yield name, result


def leaves(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    """Yield numbers and texts of a report by their paths; times are left out."""
    if hasattr(value, "as_dict"):
        value = value.as_dict()
    elif dataclasses.is_dataclass(value):
        value = {item.name: getattr(value, item.name) for item in dataclasses.fields(value)}
    if isinstance(value, Mapping):
        for key, part in value.items():
            if "seconds" not in str(key):
                yield from leaves(f"{name}.{key}", part)
    elif isinstance(value, list | tuple | np.ndarray):
        for k, part in enumerate(value):
            yield from leaves(f"{name}[{k}]", part)
    else:
        yield name, value.item() if isinstance(value, np.generic) else value


def main() -> None:
    """Compute the cases, a line for each, and write the file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path)
    parser.add_argument("--quick", action="store_true")
    arguments = parser.parse_args()
    logging.getLogger("anistar").setLevel(logging.ERROR)
    print(f"anistar of {Path(anistar.__file__).parent}")
    found, begun = {}, time.process_time()
    for run in runs():
        if run.is_quick or not arguments.quick:
            started = time.process_time()
            found[run.name] = written(run.results())
            print(f"{time.process_time() - started:7.2f} CPU s  {run.name}", flush=True)
    arguments.file.write_text(json.dumps(found, indent=1), encoding="utf-8")
    print(f"{len(found)} cases, {time.process_time() - begun:.0f} CPU s")


if __name__ == "__main__":
    main()
