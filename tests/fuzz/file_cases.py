"""One file that is damaged, read, and judged: refused with its name, or nothing is lost."""

import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from file_mutations import MUTATIONS, WITHOUT_LOSS
from file_seeds import seeds

from anistar import FormatError, formats, validate

TOLD = "cannot be told"
"""What the warning says where a format cannot know whether it is whole."""

XML = ("vtu", "xdmf")
"""Kinds in which a line may be a whole array, which nobody misses."""

MEDIT = (".mesh", ".meshb", ".sol", ".solb")
"""Files in which sections are told apart by the count of their numbers."""


@dataclass(frozen=True, kw_only=True)
class FileCase:
    """A file before and after; `changed` is the name of the one that is damaged."""

    number: int
    kind: str
    mutation: str
    files: dict
    changed: str
    data: bytes
    keeps_all: bool


@dataclass(frozen=True, kw_only=True)
class FileVerdict:
    """A verdict of `fuzz_tables.VERDICTS`, and the words for it."""

    verdict: str
    message: str = ""


def make_file_case(seed, number):
    """Return damaged file `number` of a seed: the same on every machine."""
    rng = np.random.default_rng([seed, number, 17])
    kind, files = seeds()[rng.integers(len(seeds()))]
    changed = list(files)[rng.integers(len(files))]
    mutate = MUTATIONS[rng.integers(len(MUTATIONS))]
    return FileCase(
        number=number,
        kind=kind,
        mutation=mutate.__name__,
        files=files,
        changed=changed,
        data=mutate(rng, files[changed]),
        keeps_all=mutate in WITHOUT_LOSS,
    )


def run_file_case(case):
    """Read both files and compare."""
    with tempfile.TemporaryDirectory() as folder:
        original = _read(Path(folder), case.files)
        try:
            changed = _read(Path(folder), {**case.files, case.changed: case.data})
        except FormatError as error:
            return _judged_refusal(case, folder, str(error))
    return _judged_content(case, original, changed)


def _read(folder, files):
    for name, data in files.items():
        (folder / name).write_bytes(data)
    return formats.read_with_report(folder / next(iter(files)))


def _judged_refusal(case, folder, message):
    if not any(str(Path(folder) / name) in message for name in case.files):
        return FileVerdict(verdict="unclear", message=message)
    if "memory" in message:
        return FileVerdict(verdict="memory", message=message)
    return FileVerdict(verdict="refused", message=message.split(": ", 1)[-1])


def _judged_content(case, original, changed):
    violations = validate(changed[0])
    if violations:
        return FileVerdict(verdict="invalid", message=violations[0].message)
    told = set(changed[2].warnings) - set(original[2].warnings)
    if case.keeps_all:
        told |= {warning for warning in changed[2].warnings if TOLD in warning}
        lost = differences(original, changed)
        if case.mutation.startswith("cut") and _ends_behind_a_section_of_gmsh(case):
            lost = [name for name in lost if not name.startswith("field ")]
    else:
        lost = _fewer(original, changed)
        if case.mutation == "drop_a_line" and any(name in case.kind for name in XML):
            lost = [name for name in lost if name != "fields and tags"]
        if case.mutation == "delete" and case.changed.endswith(MEDIT):
            # what is left of a section may be as long as it and the one behind it announce
            lost = [name for name in lost if name != "fields and tags"]
        if case.kind == "inp":  # sets that come together have no interface
            lost = [name for name in lost if name != "facets"]
    if lost and not told:
        return FileVerdict(verdict="lost", message=f"{case.mutation}: {', '.join(lost)}")
    return FileVerdict(verdict="ok")


def _ends_behind_a_section_of_gmsh(case):
    """Nothing says in a file of others how many sections of data there are."""
    last = case.data.rstrip().rpartition(b"\n")[2]
    return "gmsh" in case.kind and last.startswith(b"$End")


def differences(one, other):
    """What of a mesh and its fields is not the same in another."""
    mesh, fields, _ = one
    arrays = {**mesh.arrays(), **{f"field {name}": f.values for name, f in fields.items()}}
    others = {**other[0].arrays(), **{f"field {n}": f.values for n, f in other[1].items()}}
    names = [] if mesh.names == other[0].names else ["names"]
    return names + [
        name
        for name, values in arrays.items()
        if name != "names" and not _equal(values, others.get(name))
    ]


def _equal(values, other):
    if other is None or np.shape(values) != np.shape(other):
        return False
    return np.array_equal(values, other, equal_nan=np.asarray(values).dtype.kind == "f")


def _fewer(original, changed):
    """What there is less of, where some number or name may have changed."""
    counts = [
        {
            "points": mesh.n_points,
            "cells": mesh.n_cells,
            "facets": len(mesh.facets),
            # an array of tags whose name is damaged becomes a field
            "fields and tags": len(fields) + bool(np.any(mesh.facet_tags)),
        }
        for mesh, fields, _ in (original, changed)
    ]
    return [name for name in counts[0] if counts[1][name] < counts[0][name]]
