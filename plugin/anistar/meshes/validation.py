"""The validator: every rule of a mesh, and of a mesh against the one it came from."""

from __future__ import annotations

from collections.abc import Iterator
from typing import cast

import numpy as np

from ..metric.base.mesh import AnyMesh, as_mesh
from .mesh import Mesh
from .topology import (
    FacetTable,
    cell_volumes,
    edge_lengths,
    facet_measures,
    facet_table,
    measure_by_tag,
    vector_lengths,
)
from .violations import (
    Violation,
    cell_violations,
    constraint_violations,
    needs_facet,
    nodes_of,
    side_violations,
    turn_alike,
    violations_at,
)


def validate(
    mesh: AnyMesh, reference: AnyMesh | None = None, *, tolerance: float = 1e-10
) -> list[Violation]:
    """Check every rule of a mesh; the empty list means that it is valid.

    Parameters
    ----------
    mesh : Mesh or other mesh object
        The mesh to check.
    reference : Mesh or other mesh object, optional
        The mesh that it was made from: total measure, tags, names, corners and the measure
        carried by each tag must then agree.
    tolerance : float
        Allowed relative difference of measures, and of corner positions relative to the
        domain's size. Straight boundaries are exact; for curved ones give what the Hausdorff
        bound implies.

    Returns
    -------
    list of Violation
    """
    mesh = cast(Mesh, as_mesh(mesh))
    found = [*_length_violations(mesh), *cell_violations(mesh.points, mesh.cells)]
    if any(violation.kind in _BLOCKING for violation in found):
        return found
    table = facet_table(mesh.cells, mesh.n_points)
    if not found:  # sides and overlaps have a meaning for positive cells only
        found += side_violations(mesh.points, mesh.cells, table)
    broken = list(
        constraint_violations(mesh.points, mesh.cells, mesh.facets, mesh.edges, mesh.corners, table)
    )
    found += broken
    if any(violation.kind in _BLOCKING for violation in broken):
        return found
    found += _completeness_violations(mesh, table)
    if reference is not None:
        found += _reference_violations(mesh, cast(Mesh, as_mesh(reference)), tolerance)
    return found


_BLOCKING = {"length", "empty", "non_finite", "index"}


def _length_violations(mesh: Mesh) -> Iterator[Violation]:
    for name, tags, rows in (
        ("cell", mesh.cell_tags, mesh.cells),
        ("facet", mesh.facet_tags, mesh.facets),
        ("edge", mesh.edge_tags, mesh.edges),
    ):
        if len(tags) != len(rows):
            yield Violation("length", f"{len(tags)} {name}_tags for {len(rows)} {name}s")


def _completeness_violations(mesh: Mesh, table: FacetTable) -> Iterator[Violation]:
    rows = table.find(mesh.facets)
    stored = np.zeros(len(table.counts), dtype=bool)
    stored[rows[rows >= 0]] = True
    missing = needs_facet(mesh.cell_tags, table) & ~stored
    for kind, bad, what in (
        ("missing_boundary", missing & (table.counts == 1), "boundary facet"),
        ("missing_interface", missing & (table.counts > 1), "facet between regions"),
    ):
        if bad.any():
            row = int(np.argmax(bad))
            text = f"{what} {nodes_of(table, row)} of cell {table.cells[row, 0]} is not stored"
            yield Violation(kind, text, tuple(np.unique(table.cells[bad, 0]).tolist()))
    known = np.flatnonzero((rows >= 0) & (table.counts[rows] == 1))
    turned = np.zeros(mesh.n_facets, dtype=bool)
    turned[known] = ~turn_alike(mesh.facets[known], table.facets[rows[known]])
    yield from violations_at("orientation", turned, "boundary facet {i} does not point outward")


def _reference_violations(mesh: Mesh, reference: Mesh, tolerance: float) -> Iterator[Violation]:
    if mesh.dim != reference.dim:
        text = f"the mesh has dimension {mesh.dim}, the reference {reference.dim}"
        yield Violation("dimension", text)
        return
    total, expected = (float(cell_volumes(m.points, m.cells).sum()) for m in (mesh, reference))
    if not abs(total - expected) <= tolerance * expected:
        text = f"the domain measures {total:.12g}, the reference {expected:.12g}"
        yield Violation("measure", text)
    for kind, got, want in (
        ("region", _regions(mesh), _regions(reference)),
        ("facet_tag", _facet_tags(mesh), _facet_tags(reference)),
        ("edge_tag", _edge_tags(mesh), _edge_tags(reference)),
    ):
        yield from _tag_violations(kind, got, want, tolerance)
    if mesh.names != reference.names:
        changed = sorted(set(mesh.names.items()) ^ set(reference.names.items()))
        yield Violation("names", f"names differ from the reference's: {changed}")
    yield from _corner_violations(mesh, reference, tolerance)


def _regions(mesh: Mesh) -> dict[int, float]:
    return measure_by_tag(cell_volumes(mesh.points, mesh.cells), mesh.cell_tags)


def _facet_tags(mesh: Mesh) -> dict[int, float]:
    return measure_by_tag(facet_measures(mesh.points, mesh.facets), mesh.facet_tags)


def _edge_tags(mesh: Mesh) -> dict[int, float]:
    return measure_by_tag(edge_lengths(mesh.points, mesh.edges), mesh.edge_tags)


def _tag_violations(
    kind: str, got: dict[int, float], want: dict[int, float], tolerance: float
) -> Iterator[Violation]:
    if got.keys() != want.keys():
        lost, new = sorted(want.keys() - got.keys()), sorted(got.keys() - want.keys())
        yield Violation(f"{kind}_set", f"{kind}s differ: lost {lost}, new {new}", (*lost, *new))
    for tag in sorted(got.keys() & want.keys()):
        if not abs(got[tag] - want[tag]) <= tolerance * want[tag]:
            text = f"{kind} {tag} measures {got[tag]:.12g}, in the reference {want[tag]:.12g}"
            yield Violation(f"{kind}_measure", text, (tag,))


def _corner_violations(mesh: Mesh, reference: Mesh, tolerance: float) -> Iterator[Violation]:
    if len(reference.corners) == 0:
        return
    wanted = reference.points[reference.corners]
    size = float(np.ptp(reference.points, axis=0).max())
    have = mesh.points[mesh.corners]
    distance = np.full(len(wanted), np.inf)
    for i, corner in enumerate(wanted):
        if len(have):
            distance[i] = vector_lengths(have - corner).min()
    lost = ~(distance <= tolerance * size)
    yield from violations_at("corner", lost, "corner {i} of the reference is not kept")
