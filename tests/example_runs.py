"""Running the solver examples, and what they gain over uniform refinement."""

import json
import os
import subprocess
import sys

from documents import ROOT

EXAMPLES = ROOT / "solver_examples"

# In a process of its own: some of these packages leave HDF5 closed for all others.
PROGRAM = """
import json, runpy, sys
rows = runpy.run_path(sys.argv[1])["main"](**json.loads(sys.argv[2]))
print(json.dumps([[str(kind), int(n), float(error)] for kind, n, error in rows]))
"""


# What `python -m anistar.adapters.petsc_program` does before it runs a program.
REGISTERED = """
from anistar.adapters import petsc
petsc.register()
petsc.PETSc.Options()["dm_adaptor"] = "anistar"
"""


def rows_of(example, before="", **arguments):
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run(
        [sys.executable, "-c", before + PROGRAM, EXAMPLES / example, json.dumps(arguments)],
        env=environment,
        capture_output=True,
        text=True,
        timeout=240,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


def run(example, tmp_path, **sizes):
    picture = tmp_path / "picture.png"
    rows = rows_of(example, picture=str(picture), **sizes)
    assert picture.stat().st_size > 10_000
    return rows


def gain(rows):
    """Error on the first uniform mesh with as many unknowns as the last adapted one, over its."""
    *_, (_, unknowns, adapted) = [row for row in rows if row[0] == "adapted"]
    uniform = min(error for kind, n, error in rows if kind == "uniform" and n < 2 * unknowns)
    assert any(kind == "uniform" and n >= unknowns for kind, n, _ in rows)
    return uniform / adapted
