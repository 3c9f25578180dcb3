"""The source archive holds what its build needs, once, and the build asks no network."""

import re
import subprocess
import tarfile
from pathlib import Path

import pytest

backend = pytest.importorskip("scikit_build_core.build")

ROOT = Path(__file__).resolve().parents[2]
NEEDED = ("CMakeLists.txt", "pyproject.toml", "README.md", "LICENSE", "metric", "plugin")


@pytest.fixture(scope="module")
def archive(tmp_path_factory):
    """Names of the files in the archive, without the folder that holds all."""
    folder = tmp_path_factory.mktemp("dist")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(ROOT)
        name = backend.build_sdist(str(folder))
    with tarfile.open(folder / name) as packed:
        return [member.name.partition("/")[2] for member in packed.getmembers()]


def test_every_source_that_git_knows_is_in_it_once(archive):
    listed = subprocess.run(
        ["git", "ls-files", "--", *NEEDED], cwd=ROOT, capture_output=True, text=True, check=False
    )
    if listed.returncode:
        pytest.skip("no checkout of git")
    sources = set(listed.stdout.split()) - {"plugin/anistar/metric"}  # a link to metric
    assert sources
    assert sources <= set(archive)
    assert len(archive) == len(set(archive))


def test_nothing_that_is_built_is_in_it(archive):
    built = re.compile(r"^(build|dist|\.venv|docs/_build)/|\.(so|o|a|pyc)$|^plugin/anistar/metric/")
    assert [name for name in archive if built.search(name)] == []


def test_the_build_fetches_no_sources():
    text = (ROOT / "CMakeLists.txt").read_text()
    assert re.findall(r"FetchContent|ExternalProject|file\(DOWNLOAD", text) == []
