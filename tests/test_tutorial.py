"""The tutorial's blocks of code form one script that runs."""

import re
import subprocess
import sys
from pathlib import Path

import anistar

TUTORIAL = Path(__file__).resolve().parents[1] / "docs" / "tutorial.md"


def test_the_blocks_of_the_tutorial_run_in_order_and_write_a_valid_mesh(tmp_path):
    blocks = re.findall(r"^```python\n(.*?)^```", TUTORIAL.read_text(), re.MULTILINE | re.DOTALL)
    script = tmp_path / "tutorial.py"
    script.write_text("\n\n".join(blocks))
    done = subprocess.run(
        [sys.executable, "-W", "error", script.name],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    mesh, fields = anistar.read(tmp_path / "layer.vtu")
    assert anistar.validate(mesh) == []
    assert set(fields) == {"u"}
    assert mesh.names == {(1, 1): "bottom", (1, 2): "top"}
