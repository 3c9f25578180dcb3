"""The pinned sets belong together: one version of everything, and the sizes that are announced."""

import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "requirements"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())


def lines(name):
    text = (FOLDER / name).read_text()
    return [line for line in text.splitlines() if line and not line.startswith(("#", "-r"))]


def names(name):
    return {re.match(r"[\w.-]+", line)[0].lower().replace("_", "-") for line in lines(name)}


PINNED = names("development.txt")


@pytest.mark.parametrize("name", ["build.txt", "demo.txt", "development.in"])
def test_what_is_asked_for_by_name_has_a_version_in_the_pinned_set(name):
    assert names(name) <= PINNED


def test_the_demo_downloads_no_solver_but_one_and_no_vtk():
    assert names("demo.txt") == {"matplotlib", "meshio", "numpy", "rich", "scikit-fem", "scipy"}
    assert "-r build.txt" in (FOLDER / "demo.txt").read_text()


def test_every_core_dependency_is_in_the_set_of_the_demo():
    required = {re.match(r"\w+", line)[0] for line in PROJECT["project"]["dependencies"]}
    assert required <= names("demo.txt")


def test_the_build_requires_the_pinned_versions():
    wanted = {line.lower().replace("-", "_") for line in PROJECT["build-system"]["requires"]}
    assert wanted <= {line.lower().replace("-", "_") for line in lines("development.txt")}
    assert {line.partition("==")[0] for line in wanted} == {
        name.replace("-", "_") for name in names("build.txt")
    }


@pytest.mark.parametrize("name", ["demo", "development", "docs", "bench", "wheel"])
def test_a_set_that_is_installed_by_itself_says_what_it_downloads(name):
    text = (FOLDER / f"{name}.txt").read_text()
    assert len(re.findall(r"^# Downloads about \d+ MB\.$", text, re.MULTILINE)) == 1
