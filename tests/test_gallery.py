"""Every solver example has a page in the gallery, on which it runs at a small size."""

import ast
import runpy
import shlex
from pathlib import Path

import pytest
from documents import ROOT

EXAMPLES = sorted((ROOT / "solver_examples").glob("*/*.py"))
GALLERY = runpy.run_path(str(ROOT / "docs" / "gallery.py"))


def test_the_gallery_knows_every_example_and_no_other():
    assert {path.stem for path in EXAMPLES} == set(GALLERY["ARGUMENTS"])
    assert {path.parent.name for path in EXAMPLES} == set(GALLERY["PACKAGES"])


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_opens_with_a_title_and_says_what_it_solves(path):
    title, line, *_ = ast.get_docstring(ast.parse(path.read_text())).splitlines()
    assert line == "=" * len(title)
    assert (path.parent / "GALLERY_HEADER.rst").exists()


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_the_arguments_of_the_gallery_are_options_of_the_example(path):
    names = [word for word in shlex.split(GALLERY["ARGUMENTS"][path.stem]) if word[:2] == "--"]
    assert [name for name in names if f'"{name}"' not in path.read_text()] == []


def test_an_example_is_told_where_to_draw():
    words = GALLERY["small_arguments"]({}, {"src_file": "/anywhere/poisson.py"})
    assert words[:-1] == ["--complexities", "250", "500", "1000", "2000", "--picture"]
    assert Path(words[-1]).name == "poisson.png"
