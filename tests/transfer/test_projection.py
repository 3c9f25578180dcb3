import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from meshes import annulus, cube, square, two_regions
from pairs import (
    centroids,
    disc_indicator,
    flattened,
    halves,
    jittered,
    linear,
    pairs,
    scattered,
    smooth,
    thin_cells,
    with_regions,
)

from anistar import Field, MeshingError, TransferOptions, transfer
from anistar.judging.interpolation_error import l2_error
from anistar.meshes.mesh import Mesh
from anistar.meshes.topology import cell_volumes
from anistar.transfer import integral
from anistar.transfer.regions import common_regions, sums_by_region
from anistar.transfer.values.measure import cell_integrals

PROJECTIONS = ("conservative", "bounded")


def every_kind(mesh, u):
    corners = mesh.points[mesh.cells]
    return {
        "p1": Field(u(mesh.points)),
        "p0": Field(u(centroids(mesh)), "cells"),
        "dg": Field(u(corners), "cell_nodes"),
    }


def relative_defect(report, name):
    change = report.changes[name]
    before, after = np.array(change.integral)
    return np.abs(after - before).max() / np.abs(before).max()


@pytest.mark.parametrize("method", PROJECTIONS)
@given(pairs())
@settings(max_examples=25)
def test_integrals_are_kept(method, pair):
    source, target = pair
    report = transfer(source, every_kind(source, smooth), target, method=method).report
    for name in ("p1", "p0", "dg"):
        assert relative_defect(report, name) < 1e-12


@pytest.mark.parametrize("method", ["interpolate", *PROJECTIONS])
@given(pairs())
@settings(max_examples=25)
def test_linear_fields_are_carried_exactly(method, pair):
    source, target = pair
    fields = every_kind(source, linear)
    carried = transfer(source, {k: fields[k] for k in ("p1", "dg")}, target, method=method).fields
    assert np.abs(carried["p1"].values - linear(target.points)).max() < 1e-11
    assert np.abs(carried["dg"].values - linear(target.points[target.cells])).max() < 1e-11


@pytest.mark.parametrize("method", PROJECTIONS)
@given(st.integers(1, 4), st.integers(1, 4), st.integers(0, 100))
@settings(max_examples=20)
def test_integrals_are_kept_region_by_region(method, n, m, seed):
    source, target = (with_regions(halves(k, seed + k)) for k in (n, m))
    report = transfer(source, every_kind(source, smooth), target, method=method).report
    for change in report.changes.values():
        scale = max(abs(value) for value in change.integral[0])
        assert set(change.defects) == {5, 7}
        assert max(abs(row[0]) for row in change.defects.values()) < 1e-12 * scale


@pytest.mark.parametrize("method", ["interpolate", *PROJECTIONS])
def test_fields_that_jump_between_regions_stay_sharp(method):
    source, target = with_regions(halves(3, 0)), with_regions(halves(4, 1))

    def jump(mesh):
        return np.where(mesh.cell_tags == 7, 100.0, -1.0)

    fields = {
        "p0": Field(jump(source), "cells"),
        "dg": Field(np.repeat(jump(source)[:, None], 3, axis=1), "cell_nodes"),
    }
    carried = transfer(source, fields, target, method=method).fields
    assert np.abs(carried["p0"].values - jump(target)).max() < 1e-12
    assert np.abs(carried["dg"].values - jump(target)[:, None]).max() < 1e-11


@pytest.mark.parametrize("method", PROJECTIONS)
@pytest.mark.parametrize(
    ("source", "target"),
    [(annulus(3), annulus(4)), (annulus(4), annulus(2)), (square(4), jittered(2, 5, 0))],
)
def test_constants_are_exact_on_curved_boundaries_too(method, source, target):
    fields = every_kind(source, lambda x: np.full(x.shape[:-1], 3.0))
    done = transfer(source, fields, target, method=method, outside="nearest")
    for field in done.fields.values():
        assert np.abs(field.values - 3).max() < 1e-13


def test_the_defect_on_a_curved_boundary_is_reported():
    source, target = annulus(3), annulus(6)
    report = transfer(
        source, {"u": np.ones(source.n_points)}, target, method="conservative", outside="nearest"
    ).report
    areas = [cell_volumes(mesh.points, mesh.cells).sum() for mesh in (source, target)]
    assert report.changes["u"].defects[0][0] == pytest.approx(areas[1] - areas[0], rel=1e-10)
    assert report.coverage.cells > 0
    assert report.coverage.max_distance == report.max_distance > 0
    assert report.points_outside == 0


@pytest.mark.parametrize("method", PROJECTIONS)
def test_volume_outside_raises_and_names_the_cell(method):
    source, target = annulus(3), annulus(4)
    with pytest.raises(ValueError, match=r"% of target cell \d+ at .* is not covered by the sou"):
        transfer(source, {"u": np.ones(source.n_points)}, target, method=method)


@pytest.mark.parametrize("method", ["interpolate", *PROJECTIONS])
def test_smooth_fields_are_carried_with_the_second_order_on_anisotropic_pairs(method):
    errors = []
    for n in (6, 12, 24):
        source, target = jittered(2, n, 0, 4 * n), jittered(2, 4 * n, 1, n)
        u = transfer(source, {"u": smooth(source.points)}, target, method=method).fields["u"]
        errors.append(l2_error(target, u, smooth))
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert rates.min() > 1.85


@pytest.mark.parametrize("method", ["interpolate", *PROJECTIONS])
def test_smooth_fields_are_carried_with_the_second_order_in_three_dimensions(method):
    errors = []
    for n in (3, 6):
        source, target = jittered(3, n, 0), jittered(3, n + 1, 1)
        u = transfer(source, {"u": smooth(source.points)}, target, method=method).fields["u"]
        errors.append(l2_error(target, u, smooth))
    assert np.log(errors[0] / errors[1]) / np.log(7 / 4) > 1.8


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("method", PROJECTIONS)
def test_a_hundred_transfers_there_and_back_lose_no_mass(dim, method):
    meshes = (scattered(6, 0), jittered(2, 7, 1)) if dim == 2 else (cube(2), jittered(3, 3, 0))
    u = disc_indicator(meshes[0].points)
    mass = integral(meshes[0], Field(u))
    for step in range(100):
        source, target = meshes[step % 2], meshes[1 - step % 2]
        u = transfer(source, {"u": u}, target, method=method).fields["u"]
        if method == "bounded":
            assert u.min() >= 0
            assert u.max() <= 1
    assert integral(meshes[0], Field(u)) == pytest.approx(mass, rel=1e-10)


@pytest.mark.parametrize("method", PROJECTIONS)
def test_a_hundred_transfers_keep_every_kind_of_field_in_every_region(method):
    meshes = with_regions(halves(3, 0)), with_regions(halves(4, 1))
    start = every_kind(meshes[0], disc_indicator)
    fields = start
    for step in range(100):
        source, target = meshes[step % 2], meshes[1 - step % 2]
        fields = transfer(source, fields, target, method=method).fields
    regions = common_regions(*meshes[:1] * 2)
    for name, field in start.items():
        before, after = (
            sums_by_region(cell_integrals(meshes[0], f), regions.source, regions.count)
            for f in (field, fields[name])
        )
        assert np.abs(after - before).max() < 1e-10 * before.sum()


@pytest.mark.parametrize("method", PROJECTIONS)
def test_pairs_of_thin_cells_that_cross_keep_integrals_and_linear_fields(method):
    source, target = thin_cells(12, 0.4, 0), thin_cells(14, 1.7, 1)
    for mesh in (source, target):
        corners = mesh.points[mesh.cells]
        sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=-1).max(axis=1)
        aspect = sides**2 / (2 * cell_volumes(mesh.points, mesh.cells))
        assert np.quantile(aspect, 0.95) > 400
        assert aspect.max() > 1e3
    done = transfer(source, every_kind(source, linear), target, method=method)
    for name in done.fields:
        assert relative_defect(done.report, name) < 1e-12
    assert np.abs(done.fields["p1"].values - linear(target.points)).max() < 1e-9


@pytest.mark.parametrize("aspect", [1e3, 1e6])
@pytest.mark.parametrize("dim", [2, 3])
def test_flat_meshes_keep_integrals_and_linear_fields(dim, aspect):
    source = flattened(jittered(dim, 4, 0), aspect)
    target = flattened(jittered(dim, 5, 1), aspect)
    done = transfer(
        source, every_kind(source, linear), target, method="conservative", outside="nearest"
    )
    for name in done.fields:
        assert relative_defect(done.report, name) < 1e-12
    error = np.abs(done.fields["p1"].values - linear(target.points)).max()
    assert error < 1e-14 * aspect + 1e-12


def test_the_projection_is_the_best_approximation():
    source, target = jittered(2, 5, 0), jittered(2, 6, 1)
    u = np.random.default_rng(0).normal(size=source.n_points)

    def distance(method):
        options = TransferOptions(method=method, l2_difference=True)
        return transfer(source, {"u": u}, target, options).report.changes["u"].l2_difference[0]

    assert distance("conservative") < distance("bounded") < 2 * distance("conservative")
    assert distance("conservative") < distance("interpolate")


def test_a_field_carried_to_its_own_mesh_does_not_change():
    mesh = scattered(5, 1)
    fields = every_kind(mesh, disc_indicator)
    for method in PROJECTIONS:
        done = transfer(mesh, fields, mesh, method=method)
        for name, field in fields.items():
            assert np.abs(done.fields[name].values - field.values).max() < 1e-12
            assert done.report.changes[name].l2_difference[0] < 1e-7


def test_the_l2_difference_is_that_of_a_known_pair():
    # A hat of height one carried from one cell of P0 to two halves of another split.
    source = Mesh(points=[[0, 0], [1, 0], [1, 1], [0, 1]], cells=[[0, 1, 2], [0, 2, 3]])
    target = Mesh(points=[[0, 0], [1, 0], [1, 1], [0, 1]], cells=[[0, 1, 3], [1, 2, 3]])
    done = transfer(source, {"u": Field([0.0, 1.0], "cells")}, target, method="conservative")
    assert done.fields["u"].values == pytest.approx([0.5, 0.5])
    assert done.report.changes["u"].l2_difference == [pytest.approx(0.5)]


def test_tensors_stay_positive_and_symmetric_when_their_logarithms_are_carried():
    source, target = scattered(6, 2), jittered(2, 7, 3)
    random = np.random.default_rng(0)
    turn = np.linalg.qr(random.normal(size=(source.n_points, 2, 2)))[0]
    M = turn @ (10.0 ** random.uniform(-4, 4, (source.n_points, 2))[:, :, None] * np.eye(2)[None])
    M = M @ turn.transpose(0, 2, 1)
    M = (M + M.transpose(0, 2, 1)) / 2
    for method in ("interpolate", *PROJECTIONS):
        options = TransferOptions(method=method, log_euclidean=True)
        carried = transfer(source, {"M": M}, target, options).fields["M"]
        assert np.array_equal(carried, carried.transpose(0, 2, 1))
        assert np.linalg.eigvalsh(carried).min() > 0


def test_a_tensor_without_logarithm_is_named():
    mesh = square(2)
    M = np.tile(np.eye(2), (mesh.n_points, 1, 1))
    M[3, 1, 1] = -2.0
    with pytest.raises(ValueError, match=r"\[3\] is not positive definite, its smallest .* -2"):
        transfer(mesh, {"M": M}, mesh, TransferOptions(log_euclidean=True))


@pytest.mark.parametrize("method", PROJECTIONS)
def test_vectors_are_carried_component_by_component(method):
    source, target = jittered(2, 4, 0), jittered(2, 5, 1)
    v = np.stack([smooth(source.points), linear(source.points)], axis=1)
    carried = transfer(source, {"v": v, "u": v[:, 0]}, target, method=method).fields
    assert np.array_equal(carried["v"][:, 0], carried["u"])


@pytest.mark.parametrize("method", PROJECTIONS)
def test_values_that_are_not_finite_are_named(method):
    mesh = square(2)
    u = np.ones(mesh.n_points)
    u[4] = np.nan
    with pytest.raises(ValueError, match=r"field 'u' is not finite at points\[4\]"):
        transfer(mesh, {"u": u}, square(3), method=method)


def test_quadratic_fields_are_refused_by_projections():
    mesh = square(2)
    field = Field(np.ones((mesh.n_cells, 6)), "cell_nodes")
    with pytest.raises(ValueError, match="'u' is quadratic: the conservative method carries lin"):
        transfer(mesh, {"u": field}, mesh, method="conservative")


def test_nan_outside_is_refused_by_projections():
    with pytest.raises(ValueError, match="outside='nan' needs method='interpolate'"):
        TransferOptions(method="bounded", outside="nan")


@pytest.mark.parametrize("threads", [0, 257])
def test_threads_out_of_their_bounds_are_named(threads):
    with pytest.raises(ValueError, match=rf"threads must be in \[1, 256\], got {threads}"):
        TransferOptions(threads=threads)


def test_a_mass_matrix_that_cannot_be_solved_is_an_error():
    from anistar.transfer.projection.mass import mass

    with pytest.raises(MeshingError, match="9 unknowns came upon numbers that are not finite"):
        mass(square(2)).solved(np.full(9, np.nan))


@pytest.mark.parametrize("method", PROJECTIONS)
def test_an_interface_that_is_curved_keeps_constants_of_each_region(method):
    source, target = (
        Mesh(
            points=mesh.points,
            cells=mesh.cells,
            cell_tags=(np.linalg.norm(centroids(mesh), axis=1) > 0.75).astype(int),
        )
        for mesh in (annulus(4), annulus(6))
    )
    values = np.where(source.cell_tags == 1, 5.0, 2.0)
    fields = {"q": Field(values, "cells"), "one": np.ones(source.n_points)}
    done = transfer(source, fields, target, method=method, outside="nearest")
    assert np.abs(done.fields["q"].values - np.where(target.cell_tags == 1, 5.0, 2.0)).max() < 1e-12
    assert np.abs(done.fields["one"] - 1).max() < 1e-12
    assert done.report.coverage.cells > 0


def test_regions_without_points_of_their_own_keep_their_integrals_where_they_can():
    source, target = (
        Mesh(
            points=mesh.points, cells=mesh.cells, cell_tags=(4 * centroids(mesh)[:, 0]).astype(int)
        )
        for mesh in (square(4), square(8))
    )
    report = transfer(source, every_kind(source, smooth), target, method="conservative").report
    for change in report.changes.values():
        assert set(change.defects) == {0, 1, 2, 3}
        assert max(abs(row[0]) for row in change.defects.values()) < 1e-13


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("unit", [2.0**-200, 2.0**130])
@pytest.mark.parametrize("method", PROJECTIONS)
def test_the_unit_of_length_does_not_matter(dim, unit, method):
    meshes = [jittered(dim, 2, 0), jittered(dim, 3, 1)]
    scaled = [Mesh(points=unit * mesh.points, cells=mesh.cells) for mesh in meshes]
    plain = transfer(meshes[0], every_kind(meshes[0], smooth), meshes[1], method=method).fields
    other = transfer(scaled[0], every_kind(meshes[0], smooth), scaled[1], method=method).fields
    for name, field in plain.items():
        assert np.abs(other[name].values - field.values).max() < 1e-13


def test_region_tags_that_only_one_mesh_has_make_it_one_region():
    source, target = two_regions(4), square(4)
    report = transfer(source, every_kind(source, smooth), target, method="conservative").report
    assert report.changes["p1"].defects == {}
    assert relative_defect(report, "p1") < 1e-12
