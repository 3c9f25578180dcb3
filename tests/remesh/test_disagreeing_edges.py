"""The count of edges about which the metrics of four vertices disagree, by looking at all edges."""

import time

import numpy as np
import pytest
from meshes import square
from shapes import rotating_metric, sectors, stretched

import anistar
from anistar.remeshing.remesh import RemeshOptions, remesh


def disagreeing(mesh, M):
    """Count the edges that one of their four vertices would flip, and walls seen too closely."""
    walls = {tuple(sorted(facet)) for facet in mesh.facets.tolist()}
    apexes = {}
    for cell in mesh.cells.tolist():
        for a, b, c in (cell, cell[1:] + cell[:1], cell[2:] + cell[:2]):
            apexes.setdefault((min(a, b), max(a, b)), []).append((a, b, c))
    inner = [sides for edge, sides in apexes.items() if len(sides) == 2 and edge not in walls]
    flipped = sum(_would_flip(mesh.points, M, *first, second[2]) for first, second in inner)
    return flipped + sum(
        any(_is_obtuse(mesh.points, M, *side) for side in apexes[edge]) for edge in walls
    )


def _is_obtuse(points, M, a, b, c):
    """Whether c sees the edge ab at an obtuse angle, in the metric of one of its ends."""
    u, w = points[a] - points[c], points[b] - points[c]
    return any(u @ M[v] @ w < -1e-12 * np.sqrt((u @ M[v] @ u) * (w @ M[v] @ w)) for v in (a, b))


def _would_flip(points, M, a, b, c, e):
    """The in-circle determinant in each of the four metrics, above its round-off."""
    u = points[[a, b, c]] - points[e]
    for v in (a, b, c, e):
        squares = np.einsum("ni,ij,nj->n", u, M[v], u)
        slack = 1e-12 * np.abs(u).max() ** 2 * squares.max()
        if np.linalg.det(np.column_stack([u, squares])) > slack:
            return True
    return False


@pytest.mark.parametrize("seed", [7, 18, 43])
def test_the_report_counts_every_edge_on_which_metrics_disagree_at_sharp_corners(seed):
    rng = np.random.default_rng(seed)
    mesh = sectors(rng.uniform(5, 60, 5), rng.uniform(0.3, 1, 6), turn=rng.uniform(0, 6))
    angle = rng.uniform(0, 6) + mesh.points @ rng.uniform(-4, 4, 2)
    M = stretched(0.12, 0.12 / rng.uniform(2, 6), angle)
    done = remesh(mesh, M, RemeshOptions(agreement=True))
    assert anistar.validate(done.mesh, mesh) == []
    assert done.report.counts["star_moves"] == 0  # they come after the count
    assert done.report.counts["disagreeing_after"] == disagreeing(done.mesh, done.metric)


def test_a_stopped_agreement_counts_what_it_did_not_visit_and_says_what_stopped_it():
    mesh = square(20)
    M = rotating_metric(mesh, 3000)

    def dawdle(phase, fraction):
        if phase == "agreement":
            time.sleep(max(0.0, start + 4.5 - time.monotonic()))

    start = time.monotonic()
    options = RemeshOptions(agreement=True, max_seconds=4.0, callback=dawdle)
    done = remesh(mesh, M, options)
    assert anistar.validate(done.mesh, mesh) == []
    assert done.report.agreement == "stopped by max_seconds"
    assert done.report.counts["disagreeing_after"] == disagreeing(done.mesh, done.metric) > 0
