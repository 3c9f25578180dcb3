"""Walls nearer to each other than the size asked for: the least quality is kept."""

import numpy as np
import pytest
from domains import changed, uniform
from meshes import cube, two_region_cube

from anistar import RemeshOptions, remesh, validate
from anistar.judging.quality import mean_ratios


def plate(n, thickness):
    base = cube(n)
    return changed(base, points=base.points * [1.0, 1.0, thickness])


def arch(n, thickness):
    """A plate that is bent around a cylinder."""
    base = cube(n)
    turn, radius = 2.0 * base.points[:, 0], 1.0 + thickness * base.points[:, 2]
    points = np.stack([radius * np.sin(turn), base.points[:, 1], radius * np.cos(turn)], 1)
    return changed(base, points=points)


def bodies(n, thickness):
    """Two bodies, the second of them thin."""
    base = two_region_cube(n)
    points = base.points.copy()
    thin = points[:, 0] > 0.5
    points[thin, 0] = 0.5 + thickness * (points[thin, 0] - 0.5)
    return changed(base, points=points)


DOMAINS = {
    "plate": lambda: plate(5, 0.1),
    "thin plate": lambda: plate(8, 0.01),
    "arch": lambda: arch(8, 0.1),
    "thin arch": lambda: arch(8, 0.02),
    "bodies": lambda: bodies(6, 0.05),
}
OPTIONS = RemeshOptions(agreement=False)


@pytest.mark.parametrize("size", [0.5, 0.15])
@pytest.mark.parametrize("domain", DOMAINS)
def test_the_least_quality_is_kept(domain, size):
    mesh = DOMAINS[domain]()
    M = uniform(mesh, size)
    kept = min(mean_ratios(mesh, M).min(), 0.2)
    done = remesh(mesh, M, OPTIONS)
    assert validate(done.mesh) == []
    assert done.report.kept_quality == pytest.approx(kept, rel=1e-9)
    assert mean_ratios(done.mesh, done.metric).min() >= 0.999 * kept


def test_it_is_the_same_for_any_number_of_threads():
    mesh = arch(8, 0.02)
    first, second = (
        remesh(mesh, uniform(mesh, 0.3), RemeshOptions(agreement=False, threads=n)).mesh
        for n in (1, 3)
    )
    assert first.points.tobytes() == second.points.tobytes()
    assert first.cells.tobytes() == second.cells.tobytes()
