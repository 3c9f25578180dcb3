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


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The folder where the script of the page ran, and what its blocks printed."""
    folder = tmp_path_factory.mktemp("cad")
    return folder, "".join(script_of_docs("run_pages").printed(PAGE, folder))


def test_the_blocks_print_what_stands_below_them(run):
    """To a third: solvers round by the CPU, and the last meshes are made for their results."""
    printed, shown = run[1], "".join(script_of_docs("run_pages").shown(PAGE))
    assert re.sub(" +", " ", NUMBER.sub("#", printed)) == re.sub(" +", " ", NUMBER.sub("#", shown))
    pairs = zip(NUMBER.findall(printed), NUMBER.findall(shown), strict=True)
    far = [pair for pair in pairs if not math.isclose(*map(float, pair), rel_tol=0.34)]
    assert far == []


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
