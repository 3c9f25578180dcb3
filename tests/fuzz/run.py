"""The long fuzz: random domains and metrics, each judged, in processes that may crash.

``python tests/fuzz/run.py --cases 2000 --seed 0 --seconds 600 --reproducers fuzz-failures``
prints a table by kind of domain and of metric, names every failure and writes its input.
``python tests/fuzz/run.py --seed 0 --only 17`` runs one case in this process.
"""

import argparse
import json
import re
import subprocess
import sys
import threading
import time
from collections import Counter, defaultdict
from dataclasses import asdict
from pathlib import Path
from queue import Empty, Queue

import numpy as np

HERE = Path(__file__).resolve().parent


def outcomes(numbers, *, seed, largest, timeout, dim=2, deadline=None):
    """Yield a dict for every case number, run in workers that are replaced when they die."""
    left = list(numbers)
    while left:
        worker = _Worker(left, seed=seed, largest=largest, dim=dim)
        done = 0
        for number in left:
            line = worker.next_line(timeout)
            if line is None:
                yield {"number": number, "problem": worker.how_it_ended(timeout)}
                done += 1
                break
            yield json.loads(line)
            done += 1
            if deadline is not None and time.monotonic() > deadline:
                left = left[:done]
                break
        worker.end()
        left = left[done:]


class _Worker:
    """A process that runs cases in order and prints a line of JSON for each."""

    def __init__(self, numbers, *, seed, largest, dim):
        command = [sys.executable, str(HERE / "run.py"), "--worker", "--seed", str(seed)]
        self.process = subprocess.Popen(
            [*command, "--largest", str(largest), "--dim", str(dim)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self.lines = Queue()
        threading.Thread(target=self._read, daemon=True).start()
        self.process.stdin.write("\t".join(map(str, numbers)) + "\n")
        self.process.stdin.close()

    def _read(self):
        for line in self.process.stdout:
            self.lines.put(line)
        self.lines.put(None)

    def next_line(self, timeout):
        try:
            return self.lines.get(timeout=timeout)
        except Empty:
            return None

    def how_it_ended(self, timeout):
        if self.process.poll() is None:
            try:
                self.process.wait(timeout=1)
            except subprocess.TimeoutExpired:
                return f"hangs: no result after {timeout} s"
        return f"the process died with status {self.process.returncode}"

    def end(self):
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()


def case_functions(dim):
    """Return what makes a case and what runs it."""
    if dim == 3:
        from volume_cases import make_volume_case, run_volume_case

        return make_volume_case, run_volume_case
    from fuzz_cases import make_case, run_case

    return make_case, run_case


def work(seed, largest, dim):
    """Run the cases whose numbers come on the standard input."""
    make_case, run_case = case_functions(dim)

    for number in map(int, sys.stdin.readline().split("\t")):
        start = time.perf_counter()
        row = {"number": number}
        try:
            case = make_case(seed, number, largest=largest)
        except Exception as error:  # the generator's own failure, told apart
            row["skipped"] = f"{type(error).__name__}: {error}"
        else:
            row |= {"kind": case.kind, "metric": case.metric_kind}
            try:
                row |= asdict(run_case(case))
            except Exception as error:
                row["problem"] = f"{type(error).__name__}: {error}"
        row["seconds"] = time.perf_counter() - start
        say(json.dumps(row))


def write_reproducer(folder, seed, number, largest, dim):
    """Write the input of a case as an .npz file."""
    make_case, _ = case_functions(dim)
    folder.mkdir(parents=True, exist_ok=True)
    case = make_case(seed, number, largest=largest)
    arrays = {}
    for name, mesh in (("geometry", case.geometry), ("mesh", case.mesh)):
        arrays |= {f"{name}_{key}": value for key, value in mesh.arrays().items() if key != "names"}
    np.savez(
        folder / f"case-{dim}d-{seed}-{number}.npz",
        metric=case.metric,
        options=repr(case.options),
        **arrays,
    )


def print_table(rows):
    """Print outcomes by kind of domain and of metric."""
    groups = defaultdict(list)
    for row in rows:
        if "kind" in row:
            groups["domain " + row["kind"]].append(row)
            groups["metric " + row["metric"]].append(row)
    heads = ("", "cases", "bad", "refused", "certified", "stars ok", "s max")
    say("{:18}{:>7}{:>6}{:>9}{:>11}{:>10}{:>7}".format(*heads))
    for kind, members in [*sorted(groups.items()), ("all", [r for r in rows if "kind" in r])]:
        made = [row for row in members if row.get("reason")]
        certified = np.mean([row["reason"] == "certified" for row in made]) if made else 0.0
        stars = np.mean([row["star_ok"] for row in made]) if made else 0.0
        bad, refused = (sum(bool(r.get(key)) for r in members) for key in ("problem", "error"))
        slowest = max(row["seconds"] for row in members)
        say(
            f"{kind:18}{len(members):7}{bad:6}{refused:9}{certified:11.1%}{stars:10.2%}"
            f"{slowest:7.2f}"
        )
    kinds = {"reason": "reason", "refusal": "error"}
    for name, key in {**kinds, "not generated": "skipped"}.items():
        texts = (re.sub(r"[-+\d.][-+\d.e]*", "#", row.get(key, "")) for row in rows)
        for text, count in Counter(filter(None, texts)).most_common(8):
            say(f"{name}: {count} x {text}")


def say(text):
    """Write a line at once, also into a pipe."""
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=2000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--dim", type=int, default=2, choices=(2, 3))
    parser.add_argument("--seconds", type=float, help="stop after this time")
    parser.add_argument("--timeout", type=float, default=60.0, help="seconds for one case")
    parser.add_argument("--largest", type=float, default=3000.0, help="largest complexity")
    parser.add_argument("--reproducers", type=Path, help="folder for the input of failures")
    parser.add_argument("--only", type=int, help="run one case in this process")
    parser.add_argument("--worker", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.worker:
        work(options.seed, options.largest, options.dim)
        return 0
    if options.only is not None:
        make_case, run_case = case_functions(options.dim)
        say(run_case(make_case(options.seed, options.only, largest=options.largest)))
        return 0
    deadline = None if options.seconds is None else time.monotonic() + options.seconds
    numbers = range(options.first, options.first + options.cases)
    rows = []
    for row in outcomes(
        numbers,
        seed=options.seed,
        largest=options.largest,
        timeout=options.timeout,
        dim=options.dim,
        deadline=deadline,
    ):
        rows.append(row)
        if row.get("problem"):
            say(f"case {row['number']}: {row['problem']}")
            if options.reproducers:
                write_reproducer(
                    options.reproducers, options.seed, row["number"], options.largest, options.dim
                )
    print_table(rows)
    return int(any(row.get("problem") for row in rows))


if __name__ == "__main__":
    sys.path.insert(0, str(HERE.parent))
    sys.exit(main())
