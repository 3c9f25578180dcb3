"""Gmsh `.msh` is written as text of version 2.2, which all programs read."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ...base.arrays import AnyArray
from ...base.atomic import replaced
from ...base.errors import FormatError
from ...meshes.fields import Field
from ...meshes.mesh import Mesh
from ..content.export import exported, padded
from ..content.raw import RawMesh
from ..parsing.text_rows import printed
from .data import comment

_TYPE = {"line": 1, "triangle": 2, "tetra": 4, "vertex": 15}


def write(path: Path, mesh: Mesh, fields: Mapping[str, Field]) -> None:
    """Write version 2.2 with physical names and the fields as node and element data."""
    for name in [*mesh.names.values(), *fields]:
        if '"' in name or "\n" in name:
            raise FormatError(f"cannot write {path}: a quote or line break in the name {name!r}")
    content = exported(mesh, {})
    labels = [name for name, field in fields.items() if field.kind == "label"]
    parts = ["$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", comment(labels, list(fields)), _names(mesh)]
    numbers = np.arange(1, mesh.n_points + 1)
    parts += [f"$Nodes\n{mesh.n_points}\n", printed(numbers, content.points), "$EndNodes\n"]
    parts += _elements(content)
    for name, field in fields.items():
        section = "NodeData" if field.on == "points" else "ElementData"
        parts += _data(section, name, padded(field).astype(np.float64))
    with replaced(path) as temporary:
        temporary.write_text("".join(parts), encoding="utf-8")


def _names(mesh: Mesh) -> str:
    if not mesh.names:
        return ""
    lines = [f'{dim} {tag} "{name}"\n' for (dim, tag), name in sorted(mesh.names.items())]
    return "".join([f"$PhysicalNames\n{len(lines)}\n", *lines, "$EndPhysicalNames\n"])


def _elements(content: RawMesh) -> list[str]:
    """Return the elements, cells first, so that element data counts from 1 as the cells do."""
    total = sum(len(block.rows) for block in content.blocks)
    parts = [f"$Elements\n{total}\n"]
    starts = itertools.accumulate((len(block.rows) for block in content.blocks), initial=1)
    for block, start in zip(content.blocks, starts, strict=False):
        tags = np.asarray(block.tags)
        head = np.empty((len(tags), 5), np.int64)
        head[:, 0] = np.arange(start, start + len(tags))
        head[:, 1] = _TYPE[block.kind]
        head[:, 2] = 2
        # Gmsh refuses elementary tags below 1; the physical one is what counts.
        head[:, 3], head[:, 4] = tags, np.maximum(tags, 1)
        parts.append(printed(head, block.rows.astype(np.int64) + 1))
    return [*parts, "$EndElements\n"]


def _data(section: str, name: str, values: AnyArray) -> list[str]:
    components = values.shape[1] if values.ndim > 1 else 1
    numbers = np.arange(1, len(values) + 1)
    head = f'${section}\n1\n"{name}"\n1\n0\n3\n0\n{components}\n{len(values)}\n'
    return [head, printed(numbers, values), f"$End{section}\n"]
