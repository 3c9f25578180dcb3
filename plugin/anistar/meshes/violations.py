"""What is wrong with the arrays of a mesh, each rule by itself."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..base.arrays import AnyArray, Bools, Floats, Ints, Longs
from . import overlap
from .topology import (
    LOCAL_FACETS,
    FacetTable,
    RowKeys,
    cell_determinants,
    cell_volumes,
    edge_lengths,
    unique_edges,
)

# The determinant of edge vectors is off by a few units of round-off times the product of their
# lengths; what is not above that has no sign.
ROUND_OFF = 16 * np.finfo(np.float64).eps


# The checks multiply up to four lengths, which must stay below the largest double.
LARGEST = 1e75

# Cells or facets that are looked at together.
CHUNK = 1 << 16


@dataclass(frozen=True)
class Violation:
    """One broken rule.

    Attributes
    ----------
    kind : str
        Which rule, in one word.
    message : str
        What is wrong and where.
    indices : tuple of int
        The offending points, cells, facets or edges, as the message says.
    """

    kind: str
    message: str
    indices: tuple[int, ...] = ()


def violations_at(kind: str, bad: Bools, message: str) -> Iterator[Violation]:
    """Yield a violation when any entry is bad; `{i}` in the message is the first one."""
    indices = np.flatnonzero(bad)
    if len(indices):
        more = f" (and {len(indices) - 1} more)" if len(indices) > 1 else ""
        text = message.replace("{i}", str(indices[0])) + more
        yield Violation(kind, text, tuple(indices.tolist()))


def _index_violation(name: str, rows: Ints, n_points: int) -> Iterator[Violation]:
    outside = (rows < 0) | (rows >= n_points)
    bad = outside.any(axis=1)
    if bad.any():
        worst = rows[outside][0]
        yield from violations_at(
            "index", bad, f"{name} {{i}} refers to point {worst}, the mesh has {n_points} points"
        )


def point_violations(points: Floats) -> Iterator[Violation]:
    """Yield the points whose coordinates cannot be computed with."""
    non_finite = ~np.isfinite(points).all(axis=1)
    yield from violations_at("non_finite", non_finite, "point {i} has a non-finite coordinate")
    huge = (np.abs(points) > LARGEST).any(axis=1) & ~non_finite
    text = f"point {{i}} has a coordinate beyond {LARGEST:g} in magnitude"
    yield from violations_at("non_finite", huge, text)


def cell_violations(points: Floats, cells: Ints) -> Iterator[Violation]:
    """Yield what is wrong with points and cells taken one by one."""
    if len(cells) == 0:
        yield Violation("empty", "the mesh is empty: it has no cells")
        return
    bad_points = list(point_violations(points))
    if bad_points:
        yield from bad_points
        return
    bad_index = list(_index_violation("cell", cells, len(points)))
    if bad_index:
        yield from bad_index
        return
    used = np.zeros(len(points), dtype=bool)
    used[cells] = True
    yield from violations_at("orphan", ~used, "point {i} belongs to no cell")
    yield from volume_violations(points, cells)


def volume_violations(points: Floats, cells: Ints) -> Iterator[Violation]:
    """Yield the cells whose volume is negative, or zero up to round-off."""
    flat, inverted = volume_signs(points, cells)
    for kind, bad, word in (("zero_volume", flat, "zero"), ("inverted", inverted, "negative")):
        if bad.any():
            at = int(np.argmax(bad))
            value = cell_volumes(points, cells[at : at + 1])[0]
            yield from violations_at(kind, bad, f"cell {{i}} has {word} volume: {value:.3g}")


def volume_signs(points: Floats, cells: Ints) -> tuple[Bools, Bools]:
    """Return the (m,) masks of the cells of zero volume up to round-off, and of the inverted."""
    signs = [_volume_signs(points, some) for some in _chunks(cells)]
    flat, inverted = (np.concatenate(masks) for masks in zip(*signs, strict=True))
    return flat, inverted


def _chunks(rows: AnyArray) -> list[AnyArray]:
    """Cut an array into parts of bounded length: what is computed of a mesh outweighs it."""
    return np.array_split(rows, len(rows) // CHUNK + 1)


def _volume_signs(points: Floats, cells: Ints) -> tuple[Bools, Bools]:
    determinants = cell_determinants(points, cells)
    scale = np.ones(len(cells))
    for i in range(1, cells.shape[1]):
        scale *= edge_lengths(points, cells[:, [0, i]])
    flat = ~(np.abs(determinants) > ROUND_OFF * scale)
    return flat, ~flat & (determinants < 0)


def side_violations(points: Floats, cells: Ints, table: FacetTable) -> Iterator[Violation]:
    """Yield cells that meet wrongly: duplicates, overlaps, hanging points, doubled points."""
    crowded = table.counts > 2
    same = _same_side(cells, table)
    if crowded.any() or same.any():
        yield from _duplicate_violations(cells)
    for row in np.flatnonzero(crowded)[:1]:
        a, b = table.cells[row]
        shared = f"{table.counts[row]} cells share facet {nodes_of(table, row)}"
        text = f"cells {a} and {b} overlap: {shared}"
        yield Violation("overlap", text, (int(a), int(b)))
    for row in np.flatnonzero(same & ~crowded)[:1]:
        a, b = table.cells[row]
        shared = f"both are on the same side of facet {nodes_of(table, row)}"
        text = f"cells {a} and {b} overlap: {shared}"
        yield Violation("overlap", text, (int(a), int(b)))
    if not (crowded.any() or same.any()):
        yield from _boundary_violations(points, table)


def nodes_of(table: FacetTable, row: int) -> str:
    """Name a facet of the table by its points."""
    return str(tuple(table.facets[row].tolist()))


def _same_side(cells: Ints, table: FacetTable) -> Bools:
    """Tell which facets are seen in the same sense, not opposite ones, by their two cells."""
    width = cells.shape[1] - 1
    same = np.zeros(len(table.counts), dtype=bool)
    for rows in _chunks(np.flatnonzero(table.counts > 1)):
        first = table.facets[rows]
        second = cells[table.cells[rows, 1][:, None], LOCAL_FACETS[width][table.local[rows, 1]]]
        same[rows] = turn_alike(first, second)
    return same


def turn_alike(first: Ints, second: Ints) -> Bools:
    """Tell which of the facets, with equal points in each row, have the same orientation."""
    if first.shape[1] == 2:
        return np.asarray(first[:, 0] == second[:, 0])
    start = np.argmax(second == first[:, :1], axis=1)
    return np.asarray(second[np.arange(len(second)), (start + 1) % 3] == first[:, 1])


def _duplicate_violations(cells: Ints) -> Iterator[Violation]:
    _, first, inverse = np.unique(
        np.sort(cells, axis=1), axis=0, return_index=True, return_inverse=True
    )
    original = first[inverse.ravel()]
    duplicate = original != np.arange(len(cells))
    if duplicate.any():
        of = original[np.argmax(duplicate)]
        yield from violations_at("duplicate_cell", duplicate, f"cell {{i}} repeats cell {of}")


def _boundary_violations(points: Floats, table: FacetTable) -> Iterator[Violation]:
    outer = np.flatnonzero(table.counts == 1)
    facets, owners = table.facets[outer], table.cells[outer, 0]
    doubled = overlap.coincident_points(points, facets)
    if doubled is not None:
        text = (
            f"points {doubled[0]} and {doubled[1]} of the boundary coincide: cracks with doubled "
            "nodes and unmerged parts are not supported"
        )
        yield Violation("coincident", text, doubled)
        return
    crossing = overlap.crossing_facets(points, facets)
    if crossing is not None:
        a, b = (int(owners[row]) for row in crossing)
        text = f"cells {a} and {b} overlap: their boundary facets cross"
        yield Violation("overlap", text, (a, b))
        return
    touching = overlap.touching_point(points, facets)
    if touching is not None:
        point, row = touching
        text = f"point {point} hangs on a facet of cell {owners[row]} without being its vertex"
        yield Violation("hanging", text, (point, int(owners[row])))
        return
    covered = overlap.covered_facet(points, facets)
    if covered is not None:
        cell = int(owners[covered])
        yield Violation("overlap", f"cell {cell} overlaps other cells beyond its facet", (cell,))


def constraint_violations(
    points: Floats, cells: Ints, facets: Ints, edges: Ints, corners: Ints, table: FacetTable
) -> Iterator[Violation]:
    """Yield what is wrong with facets, edges and corners against the cells."""
    lists = (("facet", facets), ("edge", edges), ("corner", corners[:, None]))
    bad = [v for name, rows in lists for v in _index_violation(name, rows, len(points))]
    if bad:
        yield from bad
        return
    rows = table.find(facets)
    yield from violations_at("facet", rows < 0, "facet {i} is not a facet of any cell")
    yield from _repeated("facet", rows)
    if len(edges):
        keys = RowKeys(edges, len(points)).encode(edges)
        yield from violations_at("edge", ~_is_edge(cells, edges, keys, len(points)), _EDGE)
        yield from _repeated("edge", keys)


_EDGE = "edge {i} is not an edge of any cell"


def _repeated(name: str, keys: Longs) -> Iterator[Violation]:
    _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
    repeated = (first[inverse] != np.arange(len(keys))) & (keys >= 0)
    if repeated.any():
        of = first[inverse][np.argmax(repeated)]
        yield from violations_at(f"duplicate_{name}", repeated, f"{name} {{i}} repeats {name} {of}")


def _is_edge(cells: Ints, edges: Ints, keys: Longs, n_points: int) -> Bools:
    """Tell which edges belong to a cell, looking only at cells with two of their points."""
    marked = np.zeros(n_points, dtype=bool)
    marked[edges] = True
    near = cells[marked[cells].sum(axis=1) >= 2]
    if len(near) == 0:
        return np.zeros(len(edges), dtype=bool)
    known = unique_edges(near, n_points)
    return np.isin(keys, RowKeys(known, n_points).encode(known))


def needs_facet(cell_tags: Ints, table: FacetTable) -> Bools:
    """Tell which facets of the table must be stored: the boundary and region interfaces."""
    tags = cell_tags[table.cells]
    return np.asarray((table.counts == 1) | ((table.counts > 1) & (tags[:, 0] != tags[:, 1])))
