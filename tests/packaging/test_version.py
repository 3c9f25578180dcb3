"""The version stands in one place, and what repeats it agrees."""

import importlib.metadata
import re
from pathlib import Path

import anistar
from anistar.cli import main

ROOT = Path(__file__).resolve().parents[2]


def test_the_installed_package_has_the_version_of_its_source():
    source = (ROOT / "plugin" / "anistar" / "__init__.py").read_text()
    (version,) = re.findall(r'^__version__ = "(.+)"$', source, re.MULTILINE)
    assert anistar.__version__ == version == importlib.metadata.version("anistar")


def test_the_command_prints_the_version(capsys):
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"anistar {anistar.__version__}\n"


def test_the_citation_and_the_conda_recipe_have_the_same_version():
    for name in ("CITATION.cff", "packaging/conda/recipe.yaml"):
        found = re.findall(r"^ *version: (\d\S*)$", (ROOT / name).read_text(), re.MULTILINE)
        assert found == [anistar.__version__], name


def test_the_citation_has_what_the_format_asks_for():
    text = (ROOT / "CITATION.cff").read_text()
    keys = set(re.findall(r"^([a-z-]+):", text, re.MULTILINE))
    assert {"cff-version", "message", "title", "authors"} <= keys
    assert "license: GPL-3.0-or-later" in text


def test_the_conda_recipe_runs_with_what_the_package_requires():
    text = (ROOT / "packaging" / "conda" / "recipe.yaml").read_text()
    run = text.partition("  run:\n")[2].partition("\ntests:")[0]
    wanted = {line.strip("- ").replace(" ", "") for line in run.splitlines() if line.strip()}
    required = importlib.metadata.requires("anistar")
    python = importlib.metadata.metadata("anistar")["Requires-Python"]
    assert wanted == {f"python{python}", *(line for line in required if ";" not in line)}
    build = {line.strip(" -").replace(" ", "") for line in text.splitlines() if "==" in line}
    project = (ROOT / "pyproject.toml").read_text()
    assert build == set(re.findall(r'"(\S+==\S+?)"', project.partition("build-backend")[0]))
