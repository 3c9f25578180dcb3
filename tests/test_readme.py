"""The README's code runs as it stands."""

import re

import pyvista
from documents import ROOT, code_blocks, run_script

import anistar

README = (ROOT / "README.md").read_text()


def test_the_line_on_a_grid_runs_and_writes_a_valid_mesh(tmp_path):
    code, _, _ = code_blocks("README.md", "python")
    printed = run_script(tmp_path, code)
    surface = pyvista.read(tmp_path / "front.vtp")
    assert anistar.validate(surface) == []
    assert "u" in surface.point_data
    assert printed.startswith(f"{surface.n_points} ")
    assert "certified" in printed


def test_the_loop_of_the_readme_has_eleven_lines():
    _, code, _ = code_blocks("README.md", "python")
    assert len([line for line in code.splitlines() if line.strip()]) == 11


def test_the_loop_of_the_readme_runs_and_writes_a_valid_mesh(tmp_path):
    _, code, _ = code_blocks("README.md", "python")
    printed = run_script(tmp_path, code)
    mesh, fields = anistar.read(tmp_path / "layers.vtu")
    assert anistar.validate(mesh) == []
    assert mesh.n_points > 1000
    assert float(fields["u"].values.max()) > 0.9
    assert str(mesh.n_points) in printed


def test_the_block_in_three_dimensions_runs_and_writes_a_valid_mesh(tmp_path):
    *_, code = code_blocks("README.md", "python")
    printed = run_script(tmp_path, code)
    mesh, fields = anistar.read(tmp_path / "front.vtu")
    assert anistar.validate(mesh) == []
    assert mesh.dim == 3
    assert mesh.n_points > 2000
    assert set(fields) == {"u"}
    assert float(printed.split()[-1]) > 0.8


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
