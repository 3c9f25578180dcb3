"""The page on CAD files is a script that runs, and prints what the page shows."""

import math
import re

import pytest
from documents import ROOT, script_of_docs

import anistar

pytest.importorskip("gmsh", reason="no gmsh, or not the libraries of X that it loads")
pytest.importorskip("skfem")
pytest.importorskip("pyvista")

PAGE = ROOT / "docs" / "cad.md"
NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[+-]\d+)?")

# What of a line a mesher of CAD files and the geometry alone decide: the left side keeps its edges.
GEOMETRY = re.compile(
    r"\d+ points, \d+ t\w+: .*|\d+ points on the hole at first|given: .*"
    r"|left: .*|small hole: \d+ edges before|\w+ +\d\.\d{4} +\d\.\d{4}(?= +\d\.\d{4}$)"
)


def of_the_geometry(line):
    """Return what has to be the same to the digit, None where nothing has."""
    found = GEOMETRY.match(line)
    return found and found[0]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The folder where the script of the page ran, and what its blocks printed."""
    folder = tmp_path_factory.mktemp("cad")
    return folder, "".join(script_of_docs("run_pages").printed(PAGE, folder))


def test_the_blocks_print_what_stands_below_them(run):
    """The given geometry to the digit, the rest to a third: solvers round by the CPU."""
    printed, shown = run[1], "".join(script_of_docs("run_pages").shown(PAGE))
    assert re.sub(" +", " ", NUMBER.sub("#", printed)) == re.sub(" +", " ", NUMBER.sub("#", shown))
    assert [of_the_geometry(line) for line in printed.splitlines()] == [
        of_the_geometry(line) for line in shown.splitlines()
    ]
    pairs = zip(NUMBER.findall(printed), NUMBER.findall(shown), strict=True)
    far = [pair for pair in pairs if not math.isclose(*map(float, pair), rel_tol=0.34)]
    assert far == []


@pytest.mark.parametrize(
    ("line", "kept"),
    [
        ("456 points, 822 triangles: left, bond", "456 points, 822 triangles: left, bond"),
        ("  768 points, estimated error 1.8e-02", None),
        ("16 points on the hole at first", "16 points on the hole at first"),
        ("left: 10 edges before, 10 after", "left: 10 edges before, 10 after"),
        ("small hole: 16 edges before, 46 after", "small hole: 16 edges before"),
        ("given: middles of facets 6e-03 away at most",) * 2,
        ("inlet      0.7737   0.7854   0.7841", "inlet      0.7737   0.7854"),
    ],
)
def test_what_the_geometry_says_is_told_from_what_a_solver_does(line, kept):
    found = of_the_geometry(line)
    assert found == kept


def test_the_measures_of_the_adapted_pipe_are_those_of_the_smooth_one(run):
    rows = re.findall(r"^(\w+) +(\S+) +(\S+) +(\S+)$", run[1], re.MULTILINE)[1:]
    assert [row[0] for row in rows] == ["edges", "inlet", "outlet", "branch", "wall", "fluid"]
    for name, _, smooth, adapted in rows:
        assert float(adapted) == pytest.approx(float(smooth), rel=3e-3), name


def test_the_page_shows_the_pictures_that_its_script_draws(run):
    shown = script_of_docs("run_pages").pictures(PAGE)
    assert len(shown) == 3
    assert [name for name in shown if not (run[0] / name).exists()] == []
    assert [name for name in shown if not (PAGE.parent / "images" / name).exists()] == []


def test_the_adapted_pipe_keeps_its_names_and_the_edge_where_its_cylinders_meet(run):
    mesh, fields = anistar.read(run[0] / "tee-adapted.msh")
    assert anistar.validate(mesh) == []
    assert set(mesh.names.values()) == {"inlet", "outlet", "branch", "wall", "fluid"}
    assert set(fields) == {"c"}
    away = float(re.search(r"adapted: points (\S+) away", run[1])[1])
    given = float(re.search(r"middles of facets (\S+) away", run[1])[1])
    assert away < given / 10
