"""Kill a loop before each thing that it does to its folder, resume it, and compare.

``python kill_everywhere.py KIND DIM EVERY`` in an empty folder kills before every so manieth thing
and prints how many there were; it ends with an error if a loop that was killed and resumed leaves
other bytes than one that was not.
"""

import contextlib
import io
import itertools
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
from meshes import square, two_region_cube

import anistar
from anistar.cli import main

# One that exists; `solve` takes its place.
COMMAND = f"{sys.executable} {{mesh}} {{solution}}"
TOUCHES = os.O_WRONLY | os.O_RDWR | os.O_CREAT


def solve(words, stdout, **_):
    """The solver, in this process: starting another each time would take minutes."""
    mesh, _ = anistar.read(words[1])
    anistar.write(words[2], mesh, {"u": np.tanh(10 * (mesh.points.sum(axis=1) - 1.1))})
    stdout.write(b"solved")
    return subprocess.CompletedProcess(words, 0)


def arguments(folder, kind, *more):
    words = ["in.vtu", "--complexities", "60,90", "--format", kind, "-o", folder]
    return ["loop", *words, "--command", COMMAND, "--json", *more]


def attempt(words, folder, last=None):
    """Run the loop in a process of its own; kill it before it changes the folder once more."""
    process = os.fork()
    if process:
        return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
    count = itertools.count()

    def kill(event, details):
        changes = event in ("os.rename", "os.remove") or (event == "open" and details[2] & TOUCHES)
        if changes and folder in Path(str(details[0])).parts and next(count) == last:
            os.kill(os.getpid(), signal.SIGKILL)

    sys.addaudithook(kill)
    with contextlib.redirect_stdout(io.StringIO()):
        os._exit(main(words))


def contents(folder):
    return {
        path.name: path.read_bytes() for path in Path(folder).iterdir() if path.stem != "report"
    }


def run(kind, dim, every):
    anistar.write("in.vtu", square(6) if dim == 2 else two_region_cube())
    subprocess.run = solve
    assert attempt(arguments("whole", kind), "whole") == 0
    expected = contents("whole")
    assert len([name for name in expected if name.startswith("series_")]) == 3
    for last in itertools.count(0, every):
        folder = f"killed_{last}"
        if attempt(arguments(folder, kind), folder, last) == 0:
            return last
        # Killed once more on the way, then let go on.
        attempt(arguments(folder, kind, "--resume"), folder, last // 2)
        assert attempt(arguments(folder, kind, "--resume"), folder) == 0, last
        assert contents(folder) == expected, last
        report = (Path(folder) / "report.json").read_text()
        assert '"complexities done"' in report, last


if __name__ == "__main__":
    sys.stdout.write(f"{run(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))}\n")
