"""The tutorial's blocks of code form one script that runs, and print what the page shows."""

import pytest
from documents import ROOT, script_of_docs

import anistar

PAGE = ROOT / "docs" / "tutorial.md"


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The folder where the script of the page ran, and what each block printed."""
    pytest.importorskip("matplotlib")
    folder = tmp_path_factory.mktemp("tutorial")
    return folder, script_of_docs("run_pages").printed(PAGE, folder)


def test_the_blocks_of_the_tutorial_print_what_stands_below_them(run):
    _, printed = run
    assert printed == script_of_docs("run_pages").shown(PAGE)


def test_the_tutorial_draws_the_pictures_that_it_shows(run):
    folder, _ = run
    shown = script_of_docs("run_pages").pictures(PAGE)
    assert len(shown) == 4
    assert [name for name in shown if not (folder / name).exists()] == []
    assert [name for name in shown if not (PAGE.parent / "images" / name).exists()] == []


def test_the_tutorial_leaves_a_valid_mesh_with_its_names(run):
    folder, _ = run
    mesh, fields = anistar.read(folder / "layer.vtu")
    assert anistar.validate(mesh) == []
    assert set(fields) == {"u"}
    assert mesh.names == {(1, 1): "bottom", (1, 2): "top"}
