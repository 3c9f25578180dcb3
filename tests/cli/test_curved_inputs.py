"""Elements of second order stand for their curved edges in every command that remeshes."""

import json
import sys

import numpy as np
import pytest
from formats.test_element_kinds import of_second_order
from meshes import annulus

import anistar
from anistar.cli import main

RING = annulus(1)
HALF_ANGLE = np.pi / 8


def onto_circles(middle):
    """Return the middle of an edge on the circle of its ends, if they lie on one."""
    distance = np.linalg.norm(middle)
    for radius in (0.5, 1.0):
        if np.isclose(distance, radius * np.cos(HALF_ANGLE)):
            return middle * radius / distance
    return middle


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A ring with eight points on each circle, of first and second order, and a field."""
    monkeypatch.chdir(tmp_path)
    for name, bend in (("straight", lambda x: x), ("curved", onto_circles)):
        content = of_second_order(RING, bend)
        content.point_data["u"] = np.tanh(4 * content.points[:, 0])
        content.write(f"{name}.vtu")
    return tmp_path


def farthest(path):
    """The largest distance of the boundary from the circles."""
    mesh = anistar.read(path)[0]
    assert anistar.validate(mesh) == []
    radius = np.linalg.norm(mesh.points[np.unique(mesh.facets)], axis=1)
    assert len(radius) > 40
    return np.abs(radius[:, None] - [0.5, 1.0]).min(axis=1).max()


def adapted(name, *more):
    words = ["adapt", f"{name}.vtu", "--target-complexity", "400", "-o", f"{name}_new.vtu"]
    return [*words, *more]


def test_a_circle_of_second_order_is_met_fifteen_times_as_exactly(folder, capsys):
    for name in ("straight", "curved"):
        assert main(adapted(name)) == 0
        told = "the curved edges of curved.vtu are the geometry" in capsys.readouterr().out
        assert told is (name == "curved")
    assert farthest("straight_new.vtu") > 15 * farthest("curved_new.vtu")


def test_a_loop_keeps_to_the_curved_edges_of_its_first_mesh(folder):
    (folder / "solver.py").write_text(
        "import sys, numpy as np, anistar\nmesh, _ = anistar.read(sys.argv[1])\n"
        "anistar.write(sys.argv[2], mesh, {'u': np.tanh(4 * mesh.points[:, 0])})\n"
    )
    solver = f"{sys.executable} solver.py {{mesh}} {{solution}}"
    words = ["loop", "curved.vtu", "--command", solver, "--complexities", "400", "-o", "run"]
    assert main(words) == 0
    assert main(adapted("straight")) == 0
    assert farthest("straight_new.vtu") > 15 * farthest("run/series_001.vtu")


def test_a_geometry_that_is_given_counts_and_json_stays_json(folder, capsys):
    words = adapted("curved", "--geometry", "straight.vtu", "--json")
    assert main(words) == 0
    json.loads(capsys.readouterr().out)
    with_straight = farthest("curved_new.vtu")
    assert main(adapted("straight", "--geometry", "curved.vtu")) == 0
    assert with_straight > 15 * farthest("straight_new.vtu")


def test_the_height_of_a_plane_goes_through_an_adaptation(folder):
    mesh, fields = anistar.read("straight.vtu")
    high = anistar.Mesh(**{**mesh.arrays(), "z": 2.5})
    anistar.write("straight.vtu", high, fields)
    assert main(adapted("straight")) == 0
    got = anistar.read("straight_new.vtu")[0]
    assert got.z == 2.5
    assert anistar.validate(got) == []
