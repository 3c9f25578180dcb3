"""Walls nearer to each other than the size asked for: the least quality is kept."""

import json

import numpy as np
import pytest
from meshes import annulus, square
from shapes import uniform

from anistar import Mesh, RemeshOptions, remesh, validate
from anistar.judging.quality import mean_ratios
from anistar.remeshing.report.bad_cells import quality_bound


def strip(n, thickness):
    """A strip of length one and as fine along it as it is thick, or coarser."""
    base = square(n)
    return Mesh(
        points=base.points * [1.0, thickness * n], cells=base.cells, facets=base.facets,
        facet_tags=base.facet_tags,
    )  # fmt: skip


def one_row(n, thickness):
    """A strip of one row of cells."""
    x = np.linspace(0.0, 1.0, n + 1)
    points = np.concatenate([np.stack([x, 0 * x], 1), np.stack([x, 0 * x + thickness], 1)])
    a = np.arange(n)
    cells = np.concatenate(
        [np.stack([a, a + 1, a + n + 2], 1), np.stack([a, a + n + 2, a + n + 1], 1)]
    )
    return Mesh(points=points, cells=cells)


def ring(n, thickness):
    return annulus(n, inner=1.0 - thickness, outer=1.0)


def parted(n, gap):
    """Two bodies with a thin one between them."""
    half = np.linspace(0.0, 0.5 - gap / 2, n + 1)
    y = np.concatenate([half, 1.0 - half[::-1]])
    base = square(2 * n + 1)
    rows = np.rint(base.points[:, 1] * (2 * n + 1)).astype(int)
    points = np.stack([base.points[:, 0], y[rows]], 1)
    row_of_cell = rows[base.cells].min(axis=1)
    return Mesh(points=points, cells=base.cells, cell_tags=1 + np.sign(row_of_cell - n))


def layered(mesh):
    """Much finer along x in the middle than at the ends."""
    size = 0.02 + 0.2 * np.abs(mesh.points[:, 0] - 0.5)
    M = np.zeros((mesh.n_points, 2, 2))
    M[:, 0, 0], M[:, 1, 1] = size**-2.0, 0.1**-2.0
    return M


DOMAINS = {
    "plate": lambda: one_row(50, 0.02),
    "fine plate": lambda: one_row(400, 0.0025),
    "coarse plate": lambda: one_row(20, 0.001),
    "three rows": lambda: strip(3, 0.01),
    "ring": lambda: ring(6, 0.05),
    "gap": lambda: parted(8, 0.01),
    "thin gap": lambda: parted(8, 0.001),
}
METRICS = {
    "coarse": lambda mesh: uniform(mesh, 0.3),
    "fine": lambda mesh: uniform(mesh, 0.02),
    "layer": layered,
}


@pytest.mark.parametrize("metric", METRICS)
@pytest.mark.parametrize("domain", DOMAINS)
def test_the_least_quality_is_kept(domain, metric):
    mesh = DOMAINS[domain]()
    M = METRICS[metric](mesh)
    kept = min(mean_ratios(mesh, M).min(), 0.2)
    done = remesh(mesh, M)
    assert validate(done.mesh) == []
    assert done.report.kept_quality == pytest.approx(kept, rel=1e-9)
    assert mean_ratios(done.mesh, done.metric).min() >= 0.999 * kept
    assert done.report.n_bad_cells == 0 or kept < 1e-3


def test_a_thin_strip_gets_no_more_cells_than_its_quality_needs():
    thin = one_row(400, 0.0025)
    done = remesh(thin, uniform(thin, 0.3))
    # edges at most some ten times as long as the strip is thick have a quality of .2
    assert done.report.n_cells < 400


def test_what_cannot_be_kept_is_named():
    # the curve through the corners of this polygon bends by more than the strip is thick
    x = np.linspace(0.0, 2.0, 81)
    low = np.stack([x, 0.2 * np.sin(2 * np.pi * x)], 1)
    points = np.concatenate([low, low + np.array([0.0, 0.002])])
    a, n = np.arange(80), 81
    cells = np.concatenate([np.stack([a, a + 1, a + n + 1], 1), np.stack([a, a + n + 1, a + n], 1)])
    mesh = Mesh(points=points, cells=cells)
    done = remesh(mesh, uniform(mesh, 0.3), RemeshOptions(hausdorff_number=0.1))
    assert validate(done.mesh) == []
    ratios = mean_ratios(done.mesh, done.metric)
    report = done.report
    bound = quality_bound(report.kept_quality)
    assert report.n_bad_cells == np.count_nonzero(ratios < bound) > 0
    assert [bad.quality for bad in report.bad_cells] == sorted(ratios[ratios < bound])[:10]
    assert json.loads(json.dumps(report.as_dict()))["kept_quality"] == report.kept_quality
