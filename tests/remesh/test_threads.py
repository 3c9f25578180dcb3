"""The result is the same for any number of threads, on meshes large enough for several blocks."""

import numpy as np
import pytest
from meshes import annulus, square, two_regions
from shapes import arc_metric, linear_metric, rotating_metric, sectors, stretched

import anistar
from anistar.remeshing.remesh import RemeshOptions, remesh

SEVERAL_BLOCKS = 8 * 1024  # vertices; see Blocks in plugin/core/mesh/blocks.h


def graded(mesh, M):
    return anistar.metric.graded(mesh, M, factor=1.5)


def layer():
    mesh = square(60)
    return mesh, arc_metric(mesh, 9000)


def graded_layer():
    mesh = square(60)
    return mesh, graded(mesh, arc_metric(mesh, 9000))


def curved_boundary():
    mesh = annulus(20)
    return mesh, graded(mesh, linear_metric(mesh, 9000))


def turning_interface():
    mesh = two_regions(24)
    return mesh, rotating_metric(mesh, 9000)


def sharp_corners():
    mesh = sectors([9, 31, 17, 24, 40, 12, 35, 28], np.linspace(1, 0.7, 9))
    angle = mesh.points @ [9.0, -5.0]
    return mesh, stretched(0.024, 0.006, angle)


def bytes_of(done):
    mesh = done.mesh
    arrays = (mesh.points, mesh.cells, mesh.cell_tags, mesh.facets, mesh.facet_tags, done.metric)
    return [array.tobytes() for array in arrays]


@pytest.mark.parametrize(
    ("make", "options"),
    [
        (layer, {}),
        (graded_layer, {}),
        (curved_boundary, {}),
        (turning_interface, {}),
        (sharp_corners, {"agreement": True}),
        (sharp_corners, {"agreement": True, "until_consistent": True}),
    ],
)
def test_the_bytes_do_not_depend_on_the_number_of_threads(make, options):
    mesh, M = make()
    one = remesh(mesh, M, RemeshOptions(threads=1, **options))
    assert one.mesh.n_points > SEVERAL_BLOCKS
    assert anistar.validate(one.mesh) == []
    for threads in (2, 3, 4):
        many = remesh(mesh, M, RemeshOptions(threads=threads, **options))
        assert bytes_of(many) == bytes_of(one)
        assert many.report.consistency == one.report.consistency
        assert many.report.counts == one.report.counts
        assert many.report.statistics == one.report.statistics


def test_the_case_of_sharp_corners_moves_vertices_and_inserts_until_consistent():
    mesh, M = sharp_corners()
    done = remesh(mesh, M, RemeshOptions(agreement=True, until_consistent=True))
    assert anistar.validate(done.mesh, mesh) == []
    assert done.report.counts["protected_corners"] >= 8
    assert done.report.counts["relocations"] > 0
    assert done.report.consistency["inconsistency"] > 0


def test_a_vertex_budget_is_met_at_the_same_vertex_by_any_number_of_threads():
    mesh, M = layer()
    one, three = (
        remesh(mesh, M, RemeshOptions(threads=n, max_vertices=6000, agreement=False))
        for n in (1, 3)
    )
    assert one.report.stop_reason == "max_vertices"
    assert one.mesh.n_points <= 6000
    assert anistar.validate(one.mesh, mesh) == []
    assert bytes_of(three) == bytes_of(one)


@pytest.mark.parametrize("phase", ["size", "shape", "agreement", "certificate"])
def test_an_exception_in_the_callback_ends_all_threads(phase):
    mesh, M = layer()
    heard = []

    def stop(name, fraction):
        heard.append(name)
        if heard.count(phase) == (3 if phase != "certificate" else 1):
            raise RuntimeError(f"enough of {name}")

    with pytest.raises(RuntimeError, match=f"enough of {phase}"):
        remesh(mesh, M, RemeshOptions(threads=3, agreement=True, callback=stop))


def test_blocks_leave_no_trace_in_the_lengths_along_their_borders():
    mesh, M = graded_layer()
    done = remesh(mesh, M, RemeshOptions(agreement=False, threads=2))
    statistics = done.report.statistics
    assert statistics["edge_unit"] > 0.995
    assert statistics["q_min"] > 0.4
    assert np.isfinite(done.metric).all()
    assert anistar.validate(done.mesh, mesh) == []
