"""The pages of the API list what is public, each name once, by a line that stands alone."""

import importlib
import inspect
import re

import pytest
from documents import ROOT

import anistar

FOLDER = ROOT / "docs" / "api"
LISTED = {
    path.stem: re.findall(r"^   ([\w.]+)$", path.read_text(), re.MULTILINE)
    for path in sorted(FOLDER.glob("*.md"))
}
NAMES = [name for names in LISTED.values() for name in names]
OPTIONAL = ("adapters.", "pictures.")


def documented(name):
    *rooms, last = name.split(".")
    return getattr(importlib.import_module(".".join(["anistar", *rooms])), last)


def test_every_page_is_in_the_index_and_lists_names():
    index = (FOLDER / "index.md").read_text()
    pages = set(LISTED) - {"index"}
    assert set(re.findall(r"^(\w+)$", index, re.MULTILINE)) == pages
    assert [page for page in pages if not LISTED[page]] == []


def test_no_name_is_listed_twice():
    assert sorted(NAMES) == sorted(set(NAMES))


def test_what_the_packages_export_is_listed():
    listed = [documented(name) for name in NAMES if not name.startswith(OPTIONAL)]
    missing = [
        f"{package.__name__}.{name}"
        for package in (anistar, anistar.metric)
        for name in package.__all__
        if inspect.isroutine(found := getattr(package, name)) or inspect.isclass(found)
        if found not in listed
    ]
    assert missing == []


@pytest.mark.parametrize("name", [name for name in NAMES if not name.startswith(OPTIONAL)])
def test_the_first_line_of_a_docstring_cites_nothing(name):
    """The list shows it alone, where the label of a citation would be that of no list."""
    first, *_ = inspect.getdoc(documented(name)).splitlines()
    assert "]_" not in first
