"""Points on common circles make flat cells, which are taken away."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from generate import plcs
from generate.exact_checks import violations
from generate.test_generate import icosphere
from scipy.spatial import ConvexHull

import anistar
from anistar.base.arrays import Floats
from anistar.generating.first_mesh import FirstMesh
from anistar.generating.geometry.plc import PLC
from anistar.generating.methods.constrained import constrained

SCALES = [0.3, 0.5, 0.8, 0.95]
Shell = tuple[Floats, list[list[int]]]


def hull(seed: int) -> Shell:
    points = np.random.default_rng(seed).normal(size=(40, 3))
    corners = points[ConvexHull(points).vertices]
    corners -= corners.mean(axis=0)
    return corners, ConvexHull(corners).simplices.tolist()


def sphere(rounds: int) -> Shell:
    points, triangles = icosphere(rounds)
    return points, triangles.tolist()


SHELLS = {
    "icosahedron": sphere(0),
    "sphere": sphere(1),
    "fine sphere": sphere(2),
    "box": plcs.box(-1.0, 1.0),
    "hull": hull(1),
    "prism": plcs.drum(10),
    "drum": plcs.drum(12, rings=4),
}


def turned(shell: Shell, seed: int | None) -> Shell:
    points, facets = shell
    return (points if seed is None else np.einsum("ij,nj->ni", plcs.rotation(seed), points)), facets


def hollow_drums() -> Iterator[PLC]:
    """Yield solids whose caps are planar but for round-off: some flat cells stay by swaps."""
    for n in (8, 9, 10, 11, 12):
        for scale in SCALES:
            yield plcs.concentric(*turned(plcs.drum(n, rings=3), seed=n), scale)


@pytest.mark.parametrize("seed", [None, 1, 2])
@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("name", SHELLS)
def test_solids_hollow_like_themselves_have_no_flat_cells(
    name: str, scale: float, seed: int | None
) -> None:
    plc = plcs.concentric(*turned(SHELLS[name], seed), scale)
    made = constrained(plc)
    assert made.warnings == ()
    assert violations(plc, made) == []
    assert anistar.validate(FirstMesh.of(plc, made).mesh) == []


@pytest.mark.parametrize("method", ["constrained", "refine", "remesh"])
@pytest.mark.parametrize("name", ["icosahedron", "sphere", "box", "prism"])
def test_every_method_meshes_solids_hollow_like_themselves(name: str, method: str) -> None:
    plc = plcs.concentric(*SHELLS[name], 0.8)
    sizes = () if method == "constrained" else (0.5,)
    assert anistar.validate(anistar.generate(plc, *sizes, method=method).mesh) == []


def test_points_in_the_volume_take_flat_cells_away_where_no_swap_does() -> None:
    n_points = 0
    for plc in hollow_drums():
        made = constrained(plc, facets_may_flip=False)
        assert made.warnings == ()
        assert violations(plc, made) == []
        assert anistar.validate(FirstMesh.of(plc, made).mesh) == []
        n_points += made.counts["steiner_points_in_volumes"]
    assert n_points > 0


def test_sizes_are_known_at_points_in_the_volume() -> None:
    for plc in hollow_drums():
        first = FirstMesh.of(plc, constrained(plc, facets_may_flip=False))
        sizes = first.at_points(np.full(plc.n_points, 0.25))
        assert sizes == pytest.approx(np.full(first.mesh.n_points, 0.25))


def test_points_in_the_volume_are_the_same_on_every_run() -> None:
    for plc in hollow_drums():
        one, other = (constrained(plc, facets_may_flip=False) for _ in range(2))
        assert one.points.tobytes() == other.points.tobytes()
        assert one.cells.tobytes() == other.cells.tobytes()


def test_flat_triangles_of_the_input_are_named_in_a_warning() -> None:
    points, facets = plcs.box()
    beside_the_edge_from_0_to_4 = [0.5, -1e-12, -1e-12]
    sliver, pieces = [0, 4, 8], [[0, 8, 1], [8, 5, 1], [8, 4, 5]]
    others = [facet for facet in facets if facet != [0, 4, 5, 1]]
    plc = PLC(np.vstack([points, [beside_the_edge_from_0_to_4]]), facets=[*others, sliver, *pieces])
    made = constrained(plc)
    assert made.counts["flat_on_flat_walls"] > 0
    assert "no area to speak of" in made.warnings[-1]
