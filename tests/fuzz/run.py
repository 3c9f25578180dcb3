"""The long fuzz: random domains and metrics, each judged, in processes that may crash.

``python tests/fuzz/run.py --cases 2000 --seed 0 --seconds 600 --reproducers fuzz-failures``
prints a table by kind of domain and of metric, names every failure and writes its input.
``python tests/fuzz/run.py --seed 0 --only 17`` runs one case in this process.
``python tests/fuzz/run.py --harsh --cases 3000 --workers 2`` asks for what nobody should: tensors
with eigenvalue ratios to 1e18, domains of needles far from the origin, budgets that are too small;
``--harsh --dim 3 --cases 500`` does so in 3D, ``--harsh --case 17`` one case in this process. It
fails unless every case gives a correct mesh or an error that names place and value.
``python tests/fuzz/run.py --files --cases 4000`` damages files of every format and reads them: each
has to be refused with its name, or give what it held.
``python tests/fuzz/run.py --generate --cases 500`` makes first meshes of random complexes by every
method: each is right in areas, volumes and bounds, and what is no valid complex is named.
"""

import argparse
import faulthandler
import json
import os
import resource
import sys
import time
from dataclasses import asdict
from functools import partial
from pathlib import Path

import numpy as np
from fuzz_tables import table_lines, verdict_table_lines
from fuzz_workers import outcomes

MEMORY = {"harsh": 6 * 2**30, "files": 3 * 2**30, "generate": 6 * 2**30}
"""Bytes that a worker may map: a case that asks for more must not take the machine with it."""

TIMEOUT = {"": 60.0, "harsh": 150.0, "files": 20.0, "generate": 60.0}
"""Seconds for a case."""


def case_functions(dim, *, mode, largest):
    """Return what makes a case of a seed and a number, and what runs it."""
    if mode == "files":
        from file_cases import make_file_case, run_file_case

        return make_file_case, run_file_case
    if mode == "generate":
        from generate_cases import make_generate_case, run_generate_case

        return make_generate_case, run_generate_case
    if mode == "harsh":
        from harsh_cases import make_harsh_case
        from harsh_judgement import run_harsh_case

        return partial(make_harsh_case, dim=dim, largest=largest), run_harsh_case
    largest = 3000.0 if largest is None else largest
    if dim == 3:
        from volume_cases import make_volume_case, run_volume_case

        return partial(make_volume_case, largest=largest), run_volume_case
    from fuzz_cases import make_case, run_case

    return partial(make_case, largest=largest), run_case


def work(options):
    """Run the cases whose numbers come on the standard input, a line each."""
    if options.mode:
        faulthandler.enable()
        if "ASAN_OPTIONS" not in os.environ:  # the sanitizer's shadow takes terabytes of addresses
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY[options.mode],) * 2)
    make, run = functions_of(options)
    for line in sys.stdin:
        say(json.dumps(worked(options, make, run, int(line))))


def worked(options, make, run, number):
    """Return the row of one case."""
    start = time.perf_counter()
    row = {"number": number}
    try:
        case = make(options.seed, number)
    except Exception as error:  # the generator's own failure, told apart
        text = f"{type(error).__name__}: {error}"
        return row | ({"verdict": "input", "message": text} if options.mode else {"skipped": text})
    row |= described(case)
    try:
        row |= asdict(run(case))
    except Exception as error:
        row["problem"] = f"{type(error).__name__}: {error}"
    row["seconds"] = time.perf_counter() - start
    return row


def described(case):
    """What a table needs to know of a case."""
    if hasattr(case, "mutation"):
        return {"file": case.kind, "mutation": case.mutation}
    row = {"kind": case.kind, "metric": case.metric_kind}
    if hasattr(case, "ratio"):
        from harsh_judgement import REFUSED_ABOVE

        row |= {"ratio": case.ratio, "beyond": not case.ratio <= REFUSED_ABOVE}
    return row


def functions_of(options):
    return case_functions(options.dim, mode=options.mode, largest=options.largest)


def completed(options, row):
    """Return the row of a case with verdict, problem, and what died with its process."""
    make, _ = functions_of(options)
    if not row.keys() & {"kind", "file"} and row.get("verdict") != "input":
        row = described(make(options.seed, row["number"])) | row
    row = {"verdict": "exception", "message": row.get("problem", "")} | row
    if row["verdict"] not in ("ok", "refused"):
        step = f" in {row['step']}" if row.get("step") else ""
        ratio = f" (ratio {row['ratio']:.1e})" if "ratio" in row else ""
        row["problem"] = f"{row['verdict']}{step}{ratio}: {row['message']}"
    return row


def write_reproducer(folder, case, name):
    """Write the input of a case as an .npz file."""
    folder.mkdir(parents=True, exist_ok=True)
    arrays = {}
    for part, mesh in (("geometry", case.geometry), ("mesh", case.mesh)):
        arrays |= {f"{part}_{key}": value for key, value in mesh.arrays().items() if key != "names"}
    np.savez(folder / name, metric=case.metric, options=repr(case.options), **arrays)


def say(text):
    """Write a line at once, also into a pipe."""
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


def parsed(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=2000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--dim", type=int, default=2, choices=(2, 3))
    parser.add_argument("--harsh", dest="mode", action="store_const", const="harsh", default="")
    parser.add_argument("--files", dest="mode", action="store_const", const="files")
    parser.add_argument("--generate", dest="mode", action="store_const", const="generate")
    parser.add_argument("--workers", type=int, default=1, help="processes side by side")
    parser.add_argument("--seconds", type=float, help="stop after this time")
    parser.add_argument("--timeout", type=float, help="seconds for one case")
    parser.add_argument("--largest", type=float, help="largest complexity")
    parser.add_argument("--reproducers", type=Path, help="folder for the input of failures")
    parser.add_argument("--rows", type=Path, help="file for the outcomes, a line of JSON each")
    parser.add_argument("--only", "--case", type=int, help="run one case in this process")
    parser.add_argument("--worker", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.timeout is None:
        options.timeout = TIMEOUT[options.mode]
    return options


def run_all(options):
    """Return the rows of all cases; say what fails when it does."""
    rows = []
    for row in outcomes(
        range(options.first, options.first + options.cases),
        seed=options.seed,
        largest=options.largest,
        timeout=options.timeout,
        dim=options.dim,
        mode=options.mode,
        n_workers=options.workers,
        deadline=None if options.seconds is None else time.monotonic() + options.seconds,
    ):
        rows.append(completed(options, row) if options.mode else row)
        if options.rows:
            with options.rows.open("a") as file:
                file.write(json.dumps(rows[-1]) + "\n")
        if rows[-1].get("problem"):
            say(f"case {row['number']}: {rows[-1]['problem']}")
            if options.reproducers:
                make, _ = functions_of(options)
                name = f"case-{options.dim}d-{options.seed}-{row['number']}.npz"
                write_reproducer(options.reproducers, make(options.seed, row["number"]), name)
    return rows


def main():
    options = parsed()
    if options.worker:
        work(options)
        return 0
    if options.only is not None:
        make, run = functions_of(options)
        say(run(make(options.seed, options.only)))
        return 0
    rows = run_all(options)
    for line in verdict_table_lines(rows) if options.mode else table_lines(rows):
        say(line)
    bad = [row["number"] for row in rows if row.get("problem")]
    say(f"{len(rows)} cases of seed {options.seed}, {len(bad)} failed: {bad}")
    return int(bool(bad))


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
    sys.exit(main())
