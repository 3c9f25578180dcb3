"""The README's code runs as it stands."""

import os
import re
import subprocess
import sys
from pathlib import Path

import anistar

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text()


def code_blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```", README, re.MULTILINE | re.DOTALL)


def test_the_readme_has_one_python_block_of_twelve_lines():
    (code,) = code_blocks("python")
    assert len([line for line in code.splitlines() if line.strip()]) == 12


def test_the_python_block_of_the_readme_runs_and_writes_a_valid_mesh(tmp_path):
    (code,) = code_blocks("python")
    script = tmp_path / "readme.py"
    script.write_text(code)
    done = subprocess.run(
        [sys.executable, "-W", "error", script.name],
        cwd=tmp_path,
        env={**os.environ, "OMP_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    mesh, fields = anistar.read(tmp_path / "layers.vtu")
    assert anistar.validate(mesh) == []
    assert mesh.n_points > 1000
    assert float(fields["u"].values.max()) > 0.9
    assert str(mesh.n_points) in done.stdout


def test_the_commands_of_the_readme_are_targets_of_the_makefile():
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    named = set(re.findall(r"(?:^|`)make ([a-z-]+)", README, re.MULTILINE))
    assert {"demo", "test"} <= named
    assert named <= targets


def test_the_files_that_the_readme_points_to_exist():
    links = re.findall(r"\]\((?!https?:|#)([^)]+)\)", README)
    assert links
    missing = [link for link in links if not (ROOT / link).exists()]
    assert missing == []
