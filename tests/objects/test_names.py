"""Names stand wherever tags do."""

import numpy as np
import pytest
from meshes import cube, square, two_region_cube, two_regions

import anistar
from anistar import metric
from anistar.cli import main


def front(mesh):
    return np.tanh(8 * (mesh.points.sum(axis=1) - 1))


def test_facets_and_regions_are_found_by_name():
    mesh = square()
    left = mesh.facets_of("left")
    assert left.shape == (4, 2)
    assert (mesh.points[left][..., 0] == 0).all()
    assert np.array_equal(left, mesh.facets_of(4))
    assert len(mesh.facets_of(["left", 1])) == 8
    regions = two_regions()
    named = anistar.Mesh(**{**regions.arrays(), "names": {(2, 1): "steel", (2, 2): "rubber"}})
    assert np.array_equal(named.region("steel"), named.cell_tags == 1)
    assert named.region(["steel", "rubber"]).all()


@pytest.mark.parametrize("make", [square, cube], ids=["2d", "3d"])
def test_sizes_at_named_facets_hold(make):
    mesh = make()
    name = sorted(mesh.names.values())[0]
    done = anistar.adapt(
        mesh, front(mesh), target_complexity=150, size_at={name: 0.05}, max_refinement=None
    )
    assert anistar.validate(done.mesh) == []
    near = np.unique(done.mesh.facets_of(name))
    smallest = np.linalg.eigvalsh(done.metric[near])[:, 0]
    assert (smallest >= 0.05**-2 * (1 - 1e-2)).all()
    free = anistar.adapt(mesh, front(mesh), target_complexity=150)
    assert len(done.mesh.facets_of(name)) > len(free.mesh.facets_of(name))


@pytest.mark.parametrize("make", [two_regions, two_region_cube], ids=["2d", "3d"])
def test_a_size_in_a_region_holds_there(make):
    plain = make()
    d = plain.dim
    mesh = anistar.Mesh(**{**plain.arrays(), "names": {(d, 1): "steel", (d, 2): "rubber"}})
    M, _ = metric.from_fields(
        mesh, front(mesh), target_complexity=30, size_at={"steel": 0.1}, gradation_factor=None
    )
    coarsest = np.linalg.eigvalsh(M)[:, 0] ** -0.5
    inside = np.unique(mesh.cells[mesh.region("steel")])
    assert coarsest[inside].max() <= 0.1 * (1 + 1e-9)
    assert coarsest.max() > 0.1


def test_frozen_facets_are_called_by_name():
    mesh = square(6)
    M = metric.from_sizes(np.full(mesh.n_points, 0.05))
    done = anistar.remesh(mesh, M, frozen=["left", 2])
    assert anistar.validate(done.mesh) == []
    for name in ("left", "right"):
        kept = done.mesh.points[np.unique(done.mesh.facets_of(name))]
        given = mesh.points[np.unique(mesh.facets_of(name))]
        assert sorted(map(tuple, kept)) == sorted(map(tuple, given))
    assert len(done.mesh.facets_of("top")) > 15
    alone = anistar.adapt(mesh, front(mesh), target_complexity=90, frozen="left")
    assert len(alone.mesh.facets_of("left")) == 6


def test_sizes_along_facets_and_curvature_take_names():
    mesh = square()
    assert np.array_equal(
        metric.size_near_boundary(mesh, ["left", "top"], 0.1),
        metric.size_near_boundary(mesh, [4, 3], 0.1),
    )


def test_the_command_line_takes_names(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mesh = square()
    renamed = {(1, 1): "hole small", **{(1, tag): mesh.names[1, tag] for tag in (2, 3, 4)}}
    mesh = anistar.Mesh(**{**mesh.arrays(), "names": renamed})
    anistar.write("in.vtu", mesh, {"u": front(mesh)})
    words = ["adapt", "in.vtu", "--target-complexity", "80", "-o", "out.vtu"]
    assert main([*words, "--size-at", "hole small=0.05", "--frozen", "left,3"]) == 0
    new, _ = anistar.read("out.vtu")
    assert anistar.validate(new) == []
    assert len(new.facets_of("hole small")) >= 18
    assert len(new.facets_of("left")) == len(new.facets_of("top")) == 4
    assert main(["metric", "in.vtu", "--size-at-tag", "hole small,0.05", "-o", "m.sol"]) == 0
    twice = [*words, "--frozen", "left", "--frozen", "3", "--size-at", "right=0.3"]
    assert main([*twice, "--size-at", "hole small=0.05"]) == 0
    new, _ = anistar.read("out.vtu")
    assert len(new.facets_of("left")) == len(new.facets_of("top")) == 4
    assert len(new.facets_of("hole small")) >= 18


def test_names_with_commas_and_digits_are_told_from_tags(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    plain = square()
    names = {(1, 1): "wall, left", (1, 2): "3", (1, 4): "7"}
    mesh = anistar.Mesh(**{**plain.arrays(), "names": names})
    assert np.array_equal(mesh.facets_of("7"), mesh.facets_of(4))
    assert np.array_equal(mesh.facets_of("1"), mesh.facets_of(1))
    with pytest.raises(ValueError, match="'3' is the name of the facets with tag 2, and another"):
        mesh.facets_of("3")
    with pytest.raises(TypeError, match="cannot be interpreted as an integer"):
        mesh.facets_of(0.9)
    anistar.write("in.vtu", mesh, {"u": front(mesh)})
    words = ["adapt", "in.vtu", "--target-complexity", "80", "-o", "out.vtu"]
    assert main([*words, "--frozen", '"wall, left",7', "--size-at", '"wall, left=0.5"']) == 0
    new, _ = anistar.read("out.vtu")
    assert anistar.validate(new) == []
    assert len(new.facets_of("wall, left")) == len(new.facets_of("7")) == 4


def test_sizes_at_unknown_names_suggest_regions_too():
    plain = two_regions()
    mesh = anistar.Mesh(**{**plain.arrays(), "names": {(2, 1): "steel", (2, 2): "air"}})
    with pytest.raises(ValueError, match="no facet or region is called 'stel': did you mean 'stee"):
        anistar.adapt(mesh, front(mesh), target_complexity=9, size_at={"stel": 0.1})


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda m: m.facets_of("lift"), "no facet is called 'lift': did you mean 'left'"),
        (lambda m: m.facets_of(17), "no facet has tag 17; the tags are 1, 2, 3, 4"),
        (lambda m: m.region("steel"), "no cell is called 'steel'; the names are none"),
        (
            lambda m: anistar.remesh(m, metric.from_sizes(np.ones(25)), frozen=["wal"]),
            "frozen_tags: no facet is called 'wal'; the names are bottom, left, right, top",
        ),
        (
            lambda m: anistar.adapt(m, front(m), target_complexity=9, size_at={"rihgt": 0.1}),
            "no facet or region is called 'rihgt': did you mean 'right'",
        ),
        (
            lambda m: anistar.adapt(m, front(m), target_complexity=9, size_at={"right": -1}),
            "the size at 'right' must be positive and finite, got -1",
        ),
        (
            lambda m: anistar.adapt(
                m, front(m), target_complexity=9, h_min=0.2, size_at={"right": 0.1}
            ),
            "size_at asks for 0.1 at point 4, which is less than h_min = 0.2",
        ),
    ],
)
def test_a_name_that_is_unknown_is_named(call, message):
    with pytest.raises(ValueError, match=message):
        call(square())
