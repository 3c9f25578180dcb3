"""Delaunay refinement of constrained meshes: bounds, lemmas, identities, ends."""

from fractions import Fraction

import numpy as np
import pytest
from generate.polyhedra import book, cube, cube_with_facet, letter_e, letter_l, rotated, wedge

from anistar.generating.methods.constrained import constrained
from anistar.generating.methods.refinement import RefinementParameters, refined_tetrahedra

NO_LI = RefinementParameters(sliver_dihedral=0.0)
FACETS = np.array([[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]])


def refine(plc, size=None, parameters=None):
    pieces = constrained(plc)
    return pieces, refined_tetrahedra(pieces, size, parameters)


def volumes(mesh):
    x = mesh.points[mesh.cells]
    u, v, w = (x[:, k] - x[:, 0] for k in (1, 2, 3))
    return np.einsum("ij,ij->i", u, np.cross(v, w)) / 6


def areas(mesh):
    x = mesh.points[mesh.walls]
    area = np.linalg.norm(np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]), axis=1) / 2
    return np.bincount(mesh.wall_facets, area)


def lengths(mesh):
    x = mesh.points[mesh.edges]
    return np.bincount(mesh.edge_segments, np.linalg.norm(x[:, 1] - x[:, 0], axis=1))


def ratios(mesh):
    x = mesh.points[mesh.cells]
    u, v, w = (x[:, k] - x[:, 0] for k in (1, 2, 3))
    vw, wu, uv = np.cross(v, w), np.cross(w, u), np.cross(u, v)
    squares = [np.einsum("ij,ij->i", a, a)[:, None] for a in (u, v, w)]
    centre = (squares[0] * vw + squares[1] * wu + squares[2] * uv) / (
        2 * np.einsum("ij,ij->i", u, vw)[:, None]
    )
    edges = np.stack([x[:, i] - x[:, j] for i in range(4) for j in range(i)])
    return np.linalg.norm(centre, axis=1) / np.linalg.norm(edges, axis=2).min(axis=0)


def least_dihedral(mesh):
    x = mesh.points[mesh.cells]
    normals = np.stack(
        [np.cross(x[:, f[1]] - x[:, f[0]], x[:, f[2]] - x[:, f[0]]) for f in FACETS], axis=1
    )
    normals /= np.linalg.norm(normals, axis=2)[:, :, None]
    cosines = [-(normals[:, i] * normals[:, j]).sum(axis=1) for i in range(4) for j in range(i)]
    return np.degrees(np.arccos(np.clip(np.max(cosines, axis=0), -1, 1))).min()


def sides(mesh):
    """Each facet of the cells, sorted, with its cell and the vertex opposite."""
    facets = np.sort(mesh.cells[:, FACETS].reshape(-1, 3), axis=1)
    cells = np.repeat(np.arange(len(mesh.cells)), 4)
    order = np.lexsort(facets.T[::-1])
    return facets[order], cells[order], mesh.cells.reshape(-1)[order]


def assert_valid(mesh, pieces):
    """Conforming, positive, walls and edges unions of what was given, nothing moved."""
    assert (volumes(mesh) > 0).all()
    np.testing.assert_array_equal(mesh.points[: len(pieces.points)], pieces.points)
    facets, _, _ = sides(mesh)
    unique, counts = np.unique(facets, axis=0, return_counts=True)
    walls = {tuple(w) for w in np.sort(mesh.walls, axis=1)}
    assert counts.max() <= 2
    assert walls <= {tuple(f) for f in unique}
    assert {tuple(f) for f in unique[counts == 1]} <= walls
    edges = np.sort(mesh.cells[:, [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]], axis=2)
    assert {tuple(e) for e in np.sort(mesh.edges, axis=1)} <= {
        tuple(e) for e in edges.reshape(-1, 2)
    }
    np.testing.assert_allclose(volumes(mesh).sum(), volumes(pieces).sum(), rtol=1e-11)
    np.testing.assert_allclose(areas(mesh), areas(pieces), rtol=1e-11)
    np.testing.assert_allclose(lengths(mesh), lengths(pieces), rtol=1e-11)


def determinant(rows):
    if len(rows) == 1:
        return rows[0][0]
    return sum(
        (-1) ** k * rows[0][k] * determinant([row[:k] + row[k + 1 :] for row in rows[1:]])
        for k in range(len(rows))
    )


def is_inside(mesh, cell, vertex):
    """Whether a vertex is inside of the circumsphere of a cell, in rational arithmetic."""
    p = [Fraction(x) for x in mesh.points[vertex]]
    rows = []
    for v in mesh.cells[cell]:
        u = [Fraction(x) - y for x, y in zip(mesh.points[v], p, strict=True)]
        rows.append([*u, sum(x * x for x in u)])
    return determinant(rows) < 0


def suspects(mesh):
    """Pairs of a cell and the vertex across a facet without a wall that are not clearly apart."""
    facets, cells, opposite = sides(mesh)
    walls = {tuple(w) for w in np.sort(mesh.walls, axis=1)}
    pairs = np.flatnonzero((facets[1:] == facets[:-1]).all(axis=1))
    pairs = np.array([k for k in pairs if tuple(facets[k]) not in walls])
    cell, vertex = cells[pairs], opposite[pairs + 1]
    x = mesh.points[mesh.cells[cell]] - mesh.points[vertex][:, None]
    squares = (x**2).sum(axis=2, keepdims=True)
    det = np.linalg.det(np.concatenate([x, squares], axis=2))
    size = np.prod(np.linalg.norm(np.concatenate([x, squares], axis=2), axis=2), axis=1)
    near = det < 1e-9 * size
    return list(zip(cell[near], vertex[near], strict=True))


def assert_locally_delaunay(mesh):
    assert [pair for pair in suspects(mesh) if is_inside(mesh, *pair)] == []


@pytest.mark.parametrize(
    ("plc", "size"),
    [
        (cube(), 0.2),
        (letter_l(), None),
        (letter_l(), 0.3),
        (letter_e(), 0.3),
        (cube_with_facet(), None),
        (cube_with_facet(), 0.15),
    ],
    ids=["cube", "l", "l-sized", "e-sized", "facet", "facet-sized"],
)
def test_refinement_keeps_every_bound_of_the_theory(plc, size):
    pieces, made = refine(plc, size)
    assert_valid(made, pieces)
    assert_locally_delaunay(made)
    record = made.record
    assert made.stop_reason == "finished"
    assert ratios(made).max() <= 2.0
    assert record["largest_ratio"] == pytest.approx(ratios(made).max())
    assert record["above_bound"] == 0
    assert record["edge_lemma"]["violated"] == record["facet_lemma"]["violated"] == 0
    assert record["encroached"]["edges"] == record["encroached"]["facets_otherwise"] == 0
    assert least_dihedral(made) >= 10.0
    assert record["least_dihedral"] == pytest.approx(least_dihedral(made))


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_facets_off_their_planes_by_rounding_do_no_harm(seed):
    pieces, made = refine(rotated(letter_l(), seed), 0.3)
    assert_valid(made, pieces)
    assert made.record["edge_lemma"]["violated"] == made.record["facet_lemma"]["violated"] == 0
    assert ratios(made).max() <= 2.0
    assert least_dihedral(made) >= 10.0


@pytest.mark.parametrize("degrees", [10, 5, 2, 1])
def test_wedges_stay_as_coarse_as_they_are(degrees):
    pieces, made = refine(wedge(degrees))
    assert_valid(made, pieces)
    assert_locally_delaunay(made)
    assert len(made.cells) <= 5 * 5
    assert least_dihedral(made) >= 0.5 * least_dihedral(pieces)
    refusals = made.record["refusals"]
    assert refusals["acute_shortest_edge"] + refusals["acute_facets"] > 0
    assert made.record["clusters"] == 2
    assert made.record["acute_pairs"] == 1


@pytest.mark.parametrize(
    ("plc", "size"),
    [(wedge(10), 0.14), (wedge(10), 0.07), (wedge(5), 0.14), (wedge(2), 0.14), (book(20), 0.17)],
    ids=["10", "10-fine", "5", "2", "book"],
)
def test_small_angles_with_a_size_stay_above_half_of_the_input(plc, size):
    pieces, made = refine(plc, size)
    assert_valid(made, pieces)
    assert made.stop_reason == "finished"
    assert least_dihedral(made) >= 0.5 * least_dihedral(pieces)


def test_a_size_is_met_in_a_wedge_as_well():
    pieces, made = refine(wedge(10), 0.2)
    assert_valid(made, pieces)
    assert made.stop_reason == "finished"
    x = made.points[made.edges]
    assert np.linalg.norm(x[:, 1] - x[:, 0], axis=1).max() <= 1.33 * 0.2


@pytest.mark.parametrize(("degrees", "most"), [(20, 5 * 336), (5, 5 * 782)])
def test_pages_of_a_book_end(degrees, most):
    pieces, made = refine(book(degrees))
    assert_valid(made, pieces)
    assert made.stop_reason == "finished"
    assert len(made.cells) <= most
    assert made.record["edge_lemma"]["violated"] == made.record["facet_lemma"]["violated"] == 0


def test_long_edges_side_by_side_do_not_block_each_other():
    pieces, made = refine(book(20), 0.09)
    assert_valid(made, pieces)
    record = made.record
    assert record["reduced_cavities"] > 0
    assert record["not_delaunay"] == 0
    assert record["refusals"]["no_cavity"] == 0
    assert record["edge_lemma"]["violated"] == record["facet_lemma"]["violated"] == 0
    x = made.points[made.edges]
    assert np.linalg.norm(x[:, 1] - x[:, 0], axis=1).max() <= 1.33 * 0.09


def test_edges_of_a_cluster_are_split_on_spheres_of_radii_that_are_powers_of_two():
    pieces, made = refine(wedge(20), 0.15)
    assert_valid(made, pieces)
    new = np.arange(len(pieces.points), len(made.points))
    apex = made.points[0]  # where the two long edges of one side meet
    on_edges = np.intersect1d(made.edges, new)
    height = made.points[on_edges, 2] == 0.0
    away = np.linalg.norm(made.points[on_edges[height]] - apex, axis=1)
    nearest = away.min()
    assert nearest == 2.0 ** np.round(np.log2(nearest))


def test_slivers_are_eliminated():
    _, without = refine(cube(), 0.12, NO_LI)
    _, made = refine(cube(), 0.12)
    assert least_dihedral(without) < 8.0
    assert least_dihedral(made) >= 11.9
    assert made.record["sliver_elimination"]["tetrahedra"] > 0
    assert made.record["l_2"] == pytest.approx(0.9**3 * made.record["l_1"] / 4)


def test_sizes_may_vary():
    pieces = constrained(cube())
    by_function = refined_tetrahedra(pieces, lambda x: 0.08 + 0.3 * x[:, 0])
    by_point = refined_tetrahedra(pieces, 0.08 + 0.3 * pieces.points[:, 0])
    np.testing.assert_array_equal(by_function.cells, by_point.cells)
    assert_valid(by_function, pieces)
    middle = by_function.points[by_function.cells].mean(axis=1)[:, 0]
    left, right = (volumes(by_function)[s].mean() for s in (middle < 0.2, middle > 0.8))
    assert left < 0.15 * right


def test_the_same_input_gives_the_same_bytes():
    one, other = (refine(letter_e(), 0.4)[1] for _ in range(2))
    assert one.points.tobytes() == other.points.tobytes()
    assert one.cells.tobytes() == other.cells.tobytes()
    _, seeded = refine(letter_e(), 0.4, RefinementParameters(seed=1))
    assert seeded.points.tobytes() != one.points.tobytes()


@pytest.mark.parametrize(
    ("parameters", "reason"),
    [({"max_vertices": 300}, "max_vertices"), ({"max_seconds": 0.05}, "max_seconds")],
)
def test_a_stop_leaves_a_valid_mesh(parameters, reason):
    pieces, made = refine(cube(), 0.02, RefinementParameters(**parameters))
    assert made.stop_reason == reason
    assert_valid(made, pieces)


def test_a_smaller_bound_is_tried_under_a_guard():
    _, made = refine(letter_l(), None, RefinementParameters(bound=1.5, max_vertices=20_000))
    assert made.stop_reason == "finished"
    assert ratios(made).max() <= 1.5


def test_constants_that_the_theorem_excludes_are_refused():
    with pytest.raises(ValueError, match="do not meet the conditions"):
        RefinementParameters(delta=0.25)
    with pytest.raises(ValueError, match="bound must be at least 1"):
        RefinementParameters(bound=0.5)


def test_sizes_that_are_none_are_refused():
    pieces = constrained(cube())
    with pytest.raises(ValueError, match="size 0 is not positive"):
        refined_tetrahedra(pieces, 0.0)
    with pytest.raises(ValueError, match="one for each of 8 points"):
        refined_tetrahedra(pieces, np.ones(3))


def test_a_callback_can_interrupt():
    def stop(phase, fraction, n_vertices):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        refined_tetrahedra(constrained(cube()), 0.05, callback=stop)
