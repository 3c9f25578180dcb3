"""The page on meshing from geometry is a script that runs, and prints what the page shows."""

import re

import pytest
from documents import ROOT, script_of_docs

pytest.importorskip("pyvista")

PAGE = ROOT / "docs" / "generating.md"


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The folder where the script of the page ran, and what its blocks printed."""
    folder = tmp_path_factory.mktemp("generating")
    return folder, "".join(script_of_docs("run_pages").printed(PAGE, folder))


def test_the_blocks_print_what_stands_below_them(run):
    """Words to the letter, numbers to the digit: meshes are the same on every machine."""
    assert run[1].split() == "".join(script_of_docs("run_pages").shown(PAGE)).split()


@pytest.mark.parametrize("name", re.findall(r"\{image\} images/(\S+)", PAGE.read_text()))
def test_the_pictures_are_drawn(run, name):
    assert (run[0] / name).stat().st_size > 0


def test_every_method_and_repair_is_told():
    text = PAGE.read_text()
    for word in ("remesh", "refine", "constrained", "orient", "stitch", "resolve", "winding"):
        assert f'"{word}"' in text
