"""What is optional, and the command that installs it here."""

import importlib.metadata
import re
import shlex
import sys
import tomllib
from pathlib import Path

import pytest

from anistar.base import extras
from anistar.base.extras import install_command, requirements
from anistar.cli.diagnosis import OPTIONAL, REQUIRED

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
METADATA = [
    "numpy>=2.0",
    'scikit-fem>=11; extra == "skfem"',
    'old>=1; python_version < "3.12" and extra == "old"',
    'also ; (extra == "old")',
]


def name_of(requirement):
    return re.match(r"[\w.-]+", requirement)[0].lower()


def test_the_package_needs_four_others_only():
    assert {name_of(wanted) for wanted in PROJECT["dependencies"]} == set(REQUIRED)
    assert set(REQUIRED) == {"numpy", "scipy", "meshio", "rich"}


@pytest.mark.parametrize("extra", PROJECT["optional-dependencies"])
def test_the_requirements_of_an_extra_are_those_of_the_project(extra):
    declared = PROJECT["optional-dependencies"][extra]
    assert sorted(map(name_of, requirements(extra))) == sorted(map(name_of, declared))


def test_the_page_on_installing_lists_every_extra_that_users_have():
    page = (ROOT / "docs" / "install.md").read_text()
    listed = re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE)
    users = PROJECT["optional-dependencies"].keys() - {"bench", "dev", "docs"}
    assert sorted(listed) == sorted(users)


def test_the_pyvista_that_is_asked_for_has_accessors():
    assert PROJECT["optional-dependencies"]["pyvista"] == ["pyvista>=0.48"]


def test_the_doctor_knows_extras_that_exist():
    assert set(OPTIONAL.values()) <= set(PROJECT["optional-dependencies"])


def test_an_extra_is_read_from_the_metadata_with_the_rest_of_its_condition(monkeypatch):
    monkeypatch.setattr(importlib.metadata, "requires", lambda name: METADATA)
    assert requirements("skfem") == ("scikit-fem>=11",)
    assert requirements("old") == ('old>=1; python_version < "3.12"', "also")


def test_the_command_is_for_this_python_and_names_no_index_of_ours():
    words = shlex.split(install_command("skfem"))
    assert words[:4] == [sys.executable, "-m", "pip", "install"]
    assert words[4:] == list(requirements("skfem"))
    assert "anistar" not in words


def test_without_pip_the_command_goes_through_what_is_there(monkeypatch):
    monkeypatch.setattr(importlib.metadata, "requires", lambda name: METADATA)
    monkeypatch.setattr(extras.importlib.util, "find_spec", lambda name: None)
    monkeypatch.setattr(sys, "executable", "/my env/python")
    monkeypatch.setattr(extras.shutil, "which", lambda name: "/bin/uv")
    assert install_command("skfem") == ("uv pip install --python '/my env/python' 'scikit-fem>=11'")
    monkeypatch.setattr(extras.shutil, "which", lambda name: None)
    assert install_command("skfem") == (
        "'/my env/python' -m ensurepip && '/my env/python' -m pip install 'scikit-fem>=11'"
    )


@pytest.mark.parametrize("executable", [None, ""])
def test_where_no_python_is_known_the_command_names_the_one_on_the_path(monkeypatch, executable):
    monkeypatch.setattr(sys, "executable", executable)
    assert install_command("skfem").startswith("python -m pip install ")


def test_an_unknown_extra_is_named_beside_the_known_ones():
    with pytest.raises(LookupError, match=r"no extra 'vkt'; known: .*\bvtk\b"):
        install_command("vkt")


def test_without_metadata_the_advice_is_to_install_anew(monkeypatch):
    def missing(name):
        raise importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr(importlib.metadata, "requires", missing)
    assert "install it anew" in install_command("vtk")


def test_no_module_but_one_words_an_install_command():
    found = {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "plugin" / "anistar").rglob("*.py")
        if re.search(r"(pip|conda) install", path.read_text())
    }
    assert found == {"plugin/anistar/base/extras.py"}
