"""Every page of the built documentation is whole in a browser without a network.

`make check-pages` builds the pages and runs this; plain `make test` leaves it out.
"""

import re

import pytest
from chromium import CHROMIUM, shown, visit
from documents import ROOT
from page_links import foreign_resources, missing_links

BUILT = ROOT / "docs" / "_build" / "html"

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(CHROMIUM is None, reason="no chromium on PATH: apt-get install chromium"),
    pytest.mark.skipif(not BUILT.exists(), reason="no pages in docs/_build: make docs"),
]


def addresses():
    return sorted(f"/{path.relative_to(BUILT)}" for path in BUILT.rglob("*.html"))


@pytest.fixture(scope="module")
def answers(tmp_path_factory):
    return visit(BUILT, addresses(), tmp_path_factory.mktemp("profile"))


def test_every_page_is_opened_and_some_have_formulas(answers):
    assert sorted(answers) == addresses()
    assert answers["/theory.html"].formulas > 50


def test_no_page_overflows_or_has_raw_formulas_broken_pictures_or_code_cut_off(answers):
    wrong = [f"{name}: {what}" for name, answer in answers.items() for what in answer.complaints]
    assert "\n".join(wrong) == ""


@pytest.mark.parametrize("width", [400, 800, 1024, 1330])
def test_pages_fit_in_other_windows_too(width, tmp_path):
    pages = ["/index.html", "/cad.html", "/certificate.html", "/coming-from.html"]
    seen = visit(BUILT, pages, tmp_path, width=width, columns=0)
    wrong = [f"{name}: {what}" for name, answer in seen.items() for what in answer.complaints]
    assert "\n".join(wrong) == ""


def test_every_link_within_the_pages_leads_somewhere():
    assert "\n".join(missing_links(BUILT)) == ""


def test_no_page_fetches_anything_from_elsewhere():
    assert "\n".join(foreign_resources(BUILT)) == ""


def test_formulas_are_set_on_a_page_opened_as_a_file(tmp_path):
    page = shown(BUILT / "theory.html", tmp_path)
    assert page.count("<mjx-container") > 50
    text = re.sub(r"<(script|pre|code)\b.*?</\1>", "", page, flags=re.DOTALL)
    assert re.search(r"\\[(\[]", re.sub(r"<[^>]*>", "", text)) is None
