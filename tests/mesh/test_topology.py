import numpy as np
import pytest
from meshes import cube, square, two_regions

from anistar.meshes import topology
from anistar.meshes.topology import RowKeys


@pytest.mark.parametrize("make", [square, cube])
def test_neighbours_are_mutual_and_share_the_facet(make):
    mesh = make()
    across = topology.neighbours(mesh.cells, mesh.n_points)
    for cell, row in enumerate(across):
        for local, other in enumerate(row):
            if other >= 0:
                assert cell in across[other]
                facet = set(np.delete(mesh.cells[cell], local))
                assert facet < set(mesh.cells[other])
    assert (across < 0).sum() == len(topology.boundary_facets(mesh.cells, mesh.n_points))


@pytest.mark.parametrize("make", [square, cube])
def test_edges_satisfy_the_euler_formula(make):
    mesh = make()
    edges = topology.unique_edges(mesh.cells, mesh.n_points)
    facets = topology.facet_table(mesh.cells, mesh.n_points).facets
    counts = [mesh.n_points, len(edges), mesh.n_cells]
    if mesh.dim == 3:
        counts.insert(2, len(facets))
    assert sum((-1) ** i * count for i, count in enumerate(counts)) == 1


def test_measures_by_tag_add_up():
    mesh = two_regions(4)
    lengths = topology.facet_measures(mesh.points, mesh.facets)
    by_tag = topology.measure_by_tag(lengths, mesh.facet_tags)
    assert by_tag == pytest.approx({1: 1, 2: 1, 3: 1, 4: 1, 9: 1})
    areas = topology.cell_volumes(mesh.points, mesh.cells)
    assert topology.measure_by_tag(areas, mesh.cell_tags) == pytest.approx({1: 0.5, 2: 0.5})


def test_row_keys_of_huge_meshes_tell_rows_apart_and_refuse_unknown_ones():
    # 3 million points: three indices do not fit in 63 bits.
    n = 3_000_000
    rows = np.array([[1, 2, n - 1], [n - 2, n - 3, n - 1], [2, 1, 3]], dtype=np.int32)
    keys = RowKeys(rows, n)
    encoded = keys.encode(rows)
    assert len(set(encoded.tolist())) == 3
    assert (encoded >= 0).all()
    assert keys.encode(rows[:, [2, 0, 1]]).tolist() == encoded.tolist()
    assert keys.encode(np.array([[5, 6, 7]], dtype=np.int32)).tolist() == [-1]


def test_a_huge_facet_table_finds_its_facets():
    table = topology.facet_table(cube(1).cells, 3_000_000)
    assert table.find(table.facets[:, [1, 2, 0]]).tolist() == list(range(len(table.facets)))
