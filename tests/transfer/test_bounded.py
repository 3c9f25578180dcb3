import numpy as np
import pytest
from hypothesis import given, settings
from meshes import annulus
from pairs import centroids, disc_indicator, halves, jittered, pairs, scattered, with_regions

from anistar import Field, TransferOptions, transfer, transfer_operator
from anistar.judging.interpolation_error import l2_error
from anistar.transfer import supermesh


def extrema_by_hand(source, target, u):
    """Extrema of u over the source cells that overlap the cells around each target point."""
    cells = supermesh(source, target).cells.tocsr()
    low, high = np.full(target.n_points, np.inf), np.full(target.n_points, -np.inf)
    for row, corners in enumerate(target.cells):
        columns = cells.indices[cells.indptr[row] : cells.indptr[row + 1]]
        values = u[source.cells[columns]]
        low[corners] = np.minimum(low[corners], values.min())
        high[corners] = np.maximum(high[corners], values.max())
    return low, high


@given(pairs())
@settings(max_examples=25)
def test_values_keep_within_the_extrema_of_the_source_cells_around_them(pair):
    source, target = pair
    u = np.random.default_rng(source.n_cells).normal(size=source.n_points)
    done = transfer(source, {"u": u}, target, method="bounded")
    low, high = extrema_by_hand(source, target, u)
    assert np.all(done.fields["u"] >= low)
    assert np.all(done.fields["u"] <= high)
    before, after = done.report.changes["u"].integral
    assert abs(after[0] - before[0]) < 1e-12


@given(pairs())
@settings(max_examples=25)
def test_values_in_cells_and_at_their_nodes_keep_within_the_extrema(pair):
    source, target = pair
    random = np.random.default_rng(target.n_cells)
    fields = {
        "p0": Field(random.normal(size=source.n_cells), "cells"),
        "dg": Field(random.normal(size=(source.n_cells, source.dim + 1)), "cell_nodes"),
    }
    done = transfer(source, fields, target, method="bounded")
    cells = supermesh(source, target).cells
    for name, field in fields.items():
        by_cell = field.values.reshape(source.n_cells, -1)
        carried = done.fields[name].values.reshape(target.n_cells, -1)
        for row in range(target.n_cells):
            columns = cells.indices[cells.indptr[row] : cells.indptr[row + 1]]
            assert carried[row].min() >= by_cell[columns].min()
            assert carried[row].max() <= by_cell[columns].max()
        before, after = done.report.changes[name].integral
        assert abs(after[0] - before[0]) < 1e-12


def test_a_discontinuity_does_not_ring():
    source, target = jittered(2, 20, 0), jittered(2, 23, 1)
    u = disc_indicator(source.points)
    free = transfer(source, {"u": u}, target, method="conservative").fields["u"]
    held = transfer(source, {"u": u}, target, method="bounded").fields["u"]
    assert free.min() < -0.05
    assert free.max() > 1.05
    assert held.min() >= 0
    assert held.max() <= 1


def test_limiting_keeps_most_of_what_lumping_loses():
    source, target = jittered(2, 20, 0), jittered(2, 23, 1)

    def cone(x):
        return np.maximum(0, 1 - np.linalg.norm(x - 0.5, axis=-1) / 0.3)

    u = cone(source.points)
    lumped = transfer_operator(source, target, "lumped") @ u
    values = {
        method: transfer(source, {"u": u}, target, method=method).fields["u"]
        for method in ("bounded", "conservative")
    }
    errors = {name: l2_error(target, value, cone) for name, value in values.items()}
    assert errors["bounded"] < 1.1 * errors["conservative"]
    assert errors["bounded"] < 0.6 * l2_error(target, lumped, cone)


def test_bounds_win_over_conservation_where_the_domains_differ():
    source, target = annulus(3), annulus(4)
    u = Field((source.points[:, 0] > 0).astype(float))
    done = transfer(source, {"u": u}, target, method="bounded", outside="nearest")
    assert done.fields["u"].values.min() >= 0
    assert done.fields["u"].values.max() <= 1
    assert done.report.changes["u"].defects[0][0] != 0


def test_a_field_that_jumps_keeps_integral_and_bounds_in_each_region():
    source, target = with_regions(halves(3, 0)), with_regions(halves(5, 1))
    values = np.where(source.cell_tags == 7, 10.0, 0.0) + centroids(source)[:, 1]
    change = transfer(source, {"q": Field(values, "cells")}, target, method="bounded").report
    defects = change.changes["q"].defects
    assert max(abs(row[0]) for row in defects.values()) < 1e-13


@pytest.mark.parametrize("factor", [1e-200, 1e200])
def test_the_size_of_the_values_does_not_matter(factor):
    source, target = scattered(5, 0), jittered(2, 6, 1)
    u = disc_indicator(source.points)
    options = TransferOptions(method="bounded")
    plain = transfer(source, {"u": u}, target, options).fields["u"]
    scaled = transfer(source, {"u": factor * u}, target, options).fields["u"]
    assert np.allclose(scaled / factor, plain, rtol=0, atol=1e-12)
