"""Constrained Delaunay tetrahedra conform to every complex, exactly."""

from __future__ import annotations

import numpy as np
import pytest
from generate import plcs
from generate.exact_checks import not_locally_delaunay, violations, volume
from hypothesis import given, settings
from hypothesis import strategies as st

from anistar import Mesh, MeshingError
from anistar.generating.first_mesh import FirstMesh
from anistar.generating.geometry.plc import PLC
from anistar.generating.geometry.region import Region
from anistar.generating.methods.constrained import Constrained, constrained
from anistar.generating.options import GenerateOptions

HARD = {
    "cube": plcs.cube(),
    "schoenhardt": plcs.schoenhardt(),
    "letter": plcs.letter_e(),
    "wedge": plcs.wedge(5.0),
    "thin wedge": plcs.wedge(0.5),
    "chazelle": plcs.chazelle(3),
    "plates": plcs.plates(12),
    "near plates": plcs.plates(8, gap=1e-4),
    "fan": plcs.fan(16),
    "book": plcs.fan(6, angle=10.0),
    "inner triangles": plcs.inner_triangles(30, seed=3),
    "nested": plcs.nested_cubes(3),
}


@pytest.mark.parametrize("name", HARD)
def test_hard_complexes_get_tetrahedra_that_conform(name: str) -> None:
    plc = HARD[name]
    made = constrained(plc)
    assert violations(plc, made) == []
    assert made.warnings == ()
    assert isinstance(FirstMesh.of(plc, made).mesh, Mesh)  # which refuses flat cells


@pytest.mark.parametrize("name", [name for name in HARD if name != "nested"])
def test_every_facet_that_is_no_wall_is_locally_delaunay(name: str) -> None:
    plc = HARD[name]
    made = constrained(plc, facets_may_flip=False)
    if made.counts["removed"] == made.counts["steiner_points_in_volumes"] == 0:
        assert not_locally_delaunay(plc, made) == []


def test_the_twisted_prism_needs_three_points() -> None:
    made = constrained(plcs.schoenhardt())
    assert made.counts["steiner_points"] == 3
    assert len(made.cells) == 11


def test_points_of_the_complex_are_kept_as_they_were() -> None:
    plc = plcs.chazelle(3)
    made = constrained(plc)
    np.testing.assert_array_equal(made.points[: plc.n_points], plc.points)
    assert len(made.steiner_ends) == len(made.points) - plc.n_points


def test_the_same_input_gives_the_same_bytes() -> None:
    one, other = (constrained(plcs.fan(12)) for _ in range(2))
    for name in ("points", "cells", "cell_tags", "walls", "wall_facets", "edges"):
        assert getattr(one, name).tobytes() == getattr(other, name).tobytes()


@settings(max_examples=12, deadline=None)
@given(
    name=st.sampled_from(["letter", "chazelle", "plates", "book", "inner triangles", "wedge"]),
    seed=st.integers(0, 1000),
    change=st.sampled_from(["turned", "rounded", "far"]),
)
def test_turned_rounded_and_distant_complexes_get_their_volume(
    name: str, seed: int, change: str
) -> None:
    plc = HARD[name]
    turn = plcs.rotation(seed)
    points = np.einsum("ij,nj->ni", turn, plc.points)
    if change == "rounded":
        points = points.astype(np.float32).astype(float)
    if change == "far":
        points = points + 1e6 * np.array([1.0, 2.0, 3.0])
    turned = plcs.moved(plc, points)
    made = constrained(turned)
    tolerance = {"turned": 1e-12, "rounded": 1e-5, "far": 1e-7}[change]
    assert volume(made) == pytest.approx(volume(constrained(plc)), rel=tolerance)
    assert isinstance(FirstMesh.of(turned, made).mesh, Mesh)


@settings(max_examples=6, deadline=None)
@given(n=st.integers(1, 25), seed=st.integers(0, 1000))
def test_random_inner_facets_are_in_the_mesh(n: int, seed: int) -> None:
    plc = plcs.inner_triangles(n, seed)
    made = constrained(plc)
    assert violations(plc, made) == []
    assert set(made.wall_facets) == set(range(plc.n_facets))


def test_a_power_of_two_as_unit_changes_no_cell() -> None:
    plc = plcs.letter_e()
    large = plcs.moved(plc, plc.points * 2.0**120)
    small = plcs.moved(plc, plc.points)
    np.testing.assert_array_equal(constrained(large).cells, constrained(small).cells)


def test_coordinates_out_of_range_of_each_other_are_refused() -> None:
    plc = plcs.cube()
    points = plc.points * 2.0**130
    points[0] = 1e-310
    with pytest.raises(ValueError, match=r"point 0 is at .*, out of range beside others"):
        constrained(plcs.moved(plc, points))


# Regions


def inside(rule: str, plc: PLC) -> Constrained:
    return constrained(plc, GenerateOptions(inside=rule))  # type: ignore[arg-type]


def test_every_other_of_nested_shells_is_inside_by_parity() -> None:
    made = inside("regions", plcs.nested_cubes(3))
    assert volume(made) == pytest.approx(1000 - 8**3 + 6**3, rel=1e-14)


def test_winding_numbers_tell_nested_solids_apart() -> None:
    made = inside("winding", plcs.nested_cubes(3))
    assert [volume(made, k) for k in (1, 2, 3)] == pytest.approx([1000 - 512, 512 - 216, 216])


def test_all_that_facets_wind_round_is_inside_by_nonzero() -> None:
    made = inside("nonzero", plcs.nested_cubes(3))
    assert volume(made) == pytest.approx(1000, rel=1e-14)


def with_regions(plc: PLC, *regions: Region, holes: list[list[float]] | None = None) -> PLC:
    return PLC.from_surface(
        plc.points, plc.triangles, np.asarray(plc.triangle_facets), regions=regions, holes=holes
    )


def test_seeds_give_regions_their_tags_and_holes_are_left_out() -> None:
    plc = plcs.nested_cubes(3)
    marked = with_regions(
        plc, Region((1.5, 1.5, 1.5), 7), Region((5.0, 5.0, 5.0), -3), holes=[[0.5, 0.5, 0.5]]
    )
    made = constrained(marked)
    assert volume(made, 7) == pytest.approx(512 - 216)
    assert volume(made, -3) == pytest.approx(216)
    assert set(made.cell_tags) == {7, -3}


@pytest.mark.parametrize(
    ("regions", "holes", "message"),
    [
        ([((5.0, 5.0, 20.0), 4)], None, "the seed of region 4 lies outside of all facets"),
        ([((5.0, 5.0, 0.0), 4)], None, "the seed of region 4 lies on a facet"),
        (
            [((0.5, 0.5, 0.5), 4), ((9.5, 9.5, 9.5), 5)],
            None,
            "region 5 and that of region 4 are not separated by facets",
        ),
        ([((0.5, 0.5, 0.5), 4)], [[0.6, 0.5, 0.5]], "hole 0 lies in a region that has a seed"),
    ],
)
def test_seeds_that_name_no_region_are_refused(
    regions: list[tuple[tuple[float, ...], int]],
    holes: list[list[float]] | None,
    message: str,
) -> None:
    plc = with_regions(plcs.nested_cubes(2), *(Region(*r) for r in regions), holes=holes)
    with pytest.raises(MeshingError, match=message):
        constrained(plc)


# What is embedded


def test_embedded_edges_and_points_are_in_the_mesh() -> None:
    points, facets = plcs.box()
    inner = np.array([[0.1, 0.1, 0.1], [0.9, 0.8, 0.9], [0.3, 0.6, 0.2], [0.5, 0.5, 0.9]])
    plc = PLC(
        np.vstack([points, inner]),
        facets=facets,
        edges=[[8, 9], [0, 8]],
        edge_tags=[3, 4],
        points_kept=[10],
    )
    made = constrained(plc)
    assert violations(plc, made) == []
    assert 10 in made.cells
    assert 11 not in made.cells  # nothing asks for it


def test_facets_inside_one_region_are_walls_with_cells_on_both_sides() -> None:
    plc = plcs.fan(5)
    made = constrained(plc)
    pages = made.walls[made.wall_facets >= 6]
    sides = [sum(np.isin(made.cells, wall).sum(axis=1) == 3) for wall in pages]
    assert sides == [2] * len(pages)


# What cannot be meshed


def test_facets_that_cross_are_named() -> None:
    points, facets = plcs.box()
    more = [[-0.5, 0.4, 0.5], [0.5, 0.4, 0.6], [0.5, 0.6, 0.55]]
    plc = PLC(np.vstack([points, more]), facets=[*facets, [8, 9, 10]])
    with pytest.raises(MeshingError, match=r"facet \d crosses facet \d near"):
        constrained(plc)


def test_a_point_on_an_edge_that_does_not_end_there_is_named() -> None:
    points, facets = plcs.box()
    more = [[0.5, 0.0, 0.0], [0.5, 0.5, 0.5]]
    plc = PLC(np.vstack([points, more]), facets=facets, edges=[[8, 9]])
    with pytest.raises(MeshingError, match="point 8 lies on the edge from point 0 to point 4"):
        constrained(plc)


def test_a_surface_with_an_open_border_encloses_nothing() -> None:
    points, facets = plcs.box()
    with pytest.raises(MeshingError, match="enclose nothing: their surface has an open border"):
        constrained(PLC(points, facets=facets[1:]))


def test_points_in_one_place_are_named() -> None:
    points, facets = plcs.box()
    plc = PLC(np.vstack([points, points[:1]]), facets=facets, points_kept=[8])
    with pytest.raises(MeshingError, match="points 0 and 8 are the same"):
        constrained(plc)


def test_the_callback_can_interrupt() -> None:
    def stop(phase: str, fraction: float) -> None:
        if phase == "facets":
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        constrained(plcs.cube(), GenerateOptions(callback=stop))
