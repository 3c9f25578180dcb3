"""Medit meshes and solutions: `.mesh`, `.meshb`, `.sol`, `.solb`.

A mesh has no fields of its own; those in the solution file of the same name beside it are taken
as its fields. Names of tags and fields are kept in comments, which only the text encoding has.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ...base.arrays import AnyArray
from ...base.atomic import all_replaced, replaced
from ...base.errors import FormatError
from ...meshes.fields import Field
from ...meshes.mesh import Mesh
from ...metric.tensors.orders import to_components
from ..content.notes import height_of, names_of
from ..content.raw import Block, RawMesh, not_read
from ..parsing.reading import reading
from ..suffixes import BINARY, SOLUTION_OF, solution_beside, suffix_of
from . import gmf
from .gmf_container import Container, Solution
from .solution import MeditSolution

_log = logging.getLogger(__name__)

_BLOCKS = {
    "Edges": "line",
    "Triangles": "triangle",
    "Tetrahedra": "tetra",
    "Quadrilaterals": "quad",
    "Prisms": "wedge",
    "Hexahedra": "hexahedron",
    "Pyramids": "pyramid",
    "EdgesP2": "line3",
    "TrianglesP2": "triangle6",
    "TetrahedraP2": "tetra10",
}
_TYPES = {"scalar": 1, "label": 1, "vector": 2, "tensor": 3}


def read_mesh(path: Path) -> RawMesh:
    """Read a mesh and the fields in the solution file of the same name, if there is one."""
    container = gmf.load(path)
    with reading(path):
        raw = _mesh(container)
    companion = solution_beside(path)
    if companion is not None:
        _add_fields(raw, companion, container.dim)
    return raw


def _mesh(container: Container) -> RawMesh:
    if container.points is None:
        raise ValueError("it holds no vertices")
    blocks = [Block(kind, table[:, :-1] - 1, table[:, -1]) for kind, table in _tables(container)]
    nothing = np.zeros((0, 1), np.int64)
    kept = [container.tables.get(keyword, nothing) for keyword in ("Corners", "RequiredVertices")]
    raw = RawMesh(container.points, blocks, np.concatenate(kept)[:, 0] - 1)
    raw.names = names_of(container.notes.get("names", []))
    raw.z = height_of(container.notes.get("z", 0.0))
    raw.warnings += not_read(container.skipped)
    return raw


def _tables(container: Container) -> list[tuple[str, AnyArray]]:
    return [
        (kind, container.tables[keyword])
        for keyword, kind in _BLOCKS.items()
        if len(container.tables.get(keyword, ()))
    ]


def _add_fields(raw: RawMesh, path: Path, dim: int) -> None:
    solution = read_solution(path)
    if solution.dim != dim:
        raise FormatError(f"{path} has dimension {solution.dim}, the mesh beside it {dim}")
    points = solution.arrays("SolAtVertices")
    if any(len(values) != len(raw.points) for values in points.values()):
        text = f"{path.name} is not used: it has another number of points"
        raw.warnings.append(text)
        return
    raw.point_data.update(points)
    cells, kind = ("SolAtTriangles", "triangle") if dim == 2 else ("SolAtTetrahedra", "tetra")
    for block in raw.blocks:
        if block.kind == kind:
            block.data.update(solution.arrays(cells))
    raw.labels = solution.labels
    unread = {*solution.keywords} - {"SolAtVertices", cells}
    raw.warnings += [f"{path.name}: the section {name} is not read" for name in sorted(unread)]


def read_solution(path: Path) -> MeditSolution:
    """Read a solution file.

    Raises
    ------
    FormatError
        If it is damaged, holds no solution, or not those that its comments name.
    """
    container = gmf.load(path)
    with reading(path):
        return MeditSolution(container)


def write_mesh(path: Path, mesh: Mesh, fields: Mapping[str, Field]) -> None:
    """Write a mesh, and its fields to the solution file of the same name."""
    tables = {"Edges": mesh.edges, "Triangles": mesh.facets, "Tetrahedra": mesh.cells}
    tags = {"Edges": mesh.edge_tags, "Triangles": mesh.facet_tags, "Tetrahedra": mesh.cell_tags}
    if mesh.dim == 2:
        tables = {"Edges": mesh.facets, "Triangles": mesh.cells}
        tags = {"Edges": mesh.facet_tags, "Triangles": mesh.cell_tags}
    container = Container(dim=mesh.dim, points=mesh.points)
    for keyword, rows in tables.items():
        if len(rows):
            container.tables[keyword] = np.c_[rows.astype(np.int64) + 1, tags[keyword]]
    if len(mesh.edges):
        container.tables["Ridges"] = np.arange(1, len(mesh.edges) + 1, dtype=np.int64)[:, None]
    if len(mesh.corners):
        container.tables["Corners"] = mesh.corners.astype(np.int64)[:, None] + 1
    _add_notes(container, mesh, path)
    solution = path.with_suffix(SOLUTION_OF[suffix_of(path)])
    # Together, so that no new mesh is left with old fields, nor the reverse, when one fails.
    with all_replaced([path, solution] if fields else [path]) as temporaries:
        gmf.save(temporaries[0], container)
        if fields:
            gmf.save(temporaries[1], _solution_container(solution, mesh, fields))
    if not fields and (stale := solution_beside(path)) is not None:
        _log.warning("%s: %s is left from before and will be read with it", path, stale.name)


def _add_notes(container: Container, mesh: Mesh, path: Path) -> None:
    """Keep names and height in comments, which the binary encoding has not."""
    if suffix_of(path) in BINARY:
        return
    if mesh.names:
        entries = [[dim, tag, name] for (dim, tag), name in sorted(mesh.names.items())]
        container.notes["names"] = entries
    if mesh.z:
        container.notes["z"] = mesh.z


def write_solution(path: Path, mesh: Mesh, fields: Mapping[str, Field]) -> None:
    """Write fields; several fields are interleaved point by point, cell by cell."""
    container = _solution_container(path, mesh, fields)
    with replaced(path) as temporary:
        gmf.save(temporary, container)


def _solution_container(path: Path, mesh: Mesh, fields: Mapping[str, Field]) -> Container:
    container = Container(dim=mesh.dim)
    cells = "SolAtTriangles" if mesh.dim == 2 else "SolAtTetrahedra"
    noted: dict[str, list[list[str]]] = {}
    for keyword, where in (("SolAtVertices", "points"), (cells, "cells")):
        chosen = {name: field for name, field in fields.items() if field.on == where}
        if not chosen:
            continue
        columns = [_columns(path, name, field) for name, field in chosen.items()]
        types = [_TYPES[str(field.kind)] for field in chosen.values()]
        container.solutions[keyword] = Solution(types, np.concatenate(columns, axis=1))
        noted[where] = [[name, str(field.kind)] for name, field in chosen.items()]
    if suffix_of(path) not in BINARY:
        container.notes["fields"] = noted
    return container


def _columns(path: Path, name: str, field: Field) -> AnyArray:
    if field.kind == "tensor":
        try:
            return to_components(field.values, "medit")
        except ValueError as error:
            raise FormatError(f"cannot write field {name!r} to {path}: {error}") from error
    return field.values.reshape(len(field.values), -1).astype(np.float64)
