"""Whenever a loop around a command is killed, it resumes to the same bytes."""

import os
import subprocess
import sys
from pathlib import Path

import pytest


@pytest.mark.parametrize(
    ("kind", "dim", "every"),
    [
        ("mesh", 2, 8),
        ("vtu", 2, 19),
        ("msh", 2, 19),
        ("su2", 2, 19),
        ("mesh", 3, 24),
    ],
)
def test_a_loop_can_be_killed_before_anything_it_does_to_its_folder(tmp_path, kind, dim, every):
    program = Path(__file__).with_name("kill_everywhere.py")
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join(sys.path),
        "OPENBLAS_NUM_THREADS": "1",
    }
    done = subprocess.run(
        [sys.executable, program, kind, str(dim), str(every)],
        env=environment,
        capture_output=True,
        text=True,
        timeout=240,
        cwd=tmp_path,
    )
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) > 30
