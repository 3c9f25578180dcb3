"""What the page on the architecture names is there, and what is there is named."""

import re
from pathlib import Path

import pytest
from documents import ROOT
from test_architecture import CORE, CORE_FOLDERS, METRIC_ROOMS, PACKAGE_ROOMS

PAGE = (ROOT / "docs" / "architecture.md").read_text()
GLOSSARY = (ROOT / "docs" / "glossary.md").read_text()
FILES = re.findall(r"\{file\}`([^`]+)`", PAGE)
PHASES = {
    name
    for path in CORE.rglob("*.[ch]*")
    for name in re.findall(r'phase\("(\w+)"\)', path.read_text())
}
WORDS_OF_THE_CORE = (
    "agreement",
    "block",
    "consistency",
    "curve",
    "margin",
    "outline",
    "pass",
    "patch",
    "phase",
    "shell",
    "slab",
    "sliver",
    "wall",
)


def table_under(title):
    """Return the rows of the first table of a section, without its head."""
    section = PAGE.partition(f"## {title}\n")[2].partition("\n## ")[0]
    rows = [line for line in section.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in row.strip("|").split("|")] for row in rows[2:]]


def rooms_of(folder):
    return {path.name for path in folder.iterdir() if path.is_dir() and path.name[0] not in "._"}


@pytest.mark.parametrize("name", sorted(set(FILES)))
def test_every_file_that_the_page_names_exists(name):
    assert (ROOT / name).is_file() or (CORE / name).is_file()


def test_the_page_names_every_room():
    rooms = {f"metric/{room}/" for room in rooms_of(ROOT / "metric")}
    rooms |= {f"plugin/anistar/{room}/" for room in rooms_of(ROOT / "plugin" / "anistar")}
    rooms |= {f"plugin/core/{room}/" for room in rooms_of(CORE)}
    rooms.remove("plugin/anistar/metric/")  # a link
    assert rooms >= {f"plugin/core/{room}/" for room in CORE_FOLDERS}
    assert {room for room in rooms if f"`{room}`" not in PAGE} == set()
    assert any("loops" in storey for storey in PACKAGE_ROOMS)
    assert any("laws" in storey for storey in METRIC_ROOMS)


def test_the_rooms_are_listed_from_the_ground_up():
    listed = re.findall(r"^\| `plugin/core/(\w+)/` \|", PAGE, re.MULTILINE)
    assert listed == [*CORE_FOLDERS, "bindings"]


def test_the_phases_of_the_page_are_those_of_the_core():
    rows = table_under("The phases of a remeshing")
    assert {"size", "shape", "agreement", "certificate", "consistency"} <= PHASES
    assert {row[0] for row in rows} == PHASES


def test_phases_have_no_numbers():
    numbered = [
        str(path.relative_to(ROOT))
        for path in [*CORE.rglob("*.h"), *CORE.rglob("*.cpp"), *(ROOT / "docs").glob("*.md")]
        if re.search(r"phases? \d", path.read_text(), re.IGNORECASE)
    ]
    assert numbered == []


@pytest.mark.parametrize(
    "key", ["statistics", "kept_quality", "agreement", "star_ok", "consistency", "distortion"]
)
def test_keys_of_the_report_on_the_page_are_its_fields(key):
    from dataclasses import fields

    from anistar.remeshing.report import RemeshReport

    cells = " ".join(row[4] for row in table_under("The phases of a remeshing"))
    assert f"`{key}`" in cells
    assert key in {field.name for field in fields(RemeshReport)}


def test_the_functions_that_the_page_names_are_where_it_says():
    named = re.findall(r"`(\w+)` in \{file\}`([^`]+)`", PAGE)
    assert "disagrees" in {name for name, _ in named}
    for name, file in named:
        assert re.search(rf"\b{name}\b", Path(ROOT / file).read_text())


@pytest.mark.parametrize("word", WORDS_OF_THE_CORE)
def test_the_glossary_has_the_words_of_the_core(word):
    assert re.search(rf"^\*\*(.*, )?{word}(, .*)?\*\*$", GLOSSARY, re.MULTILINE)
