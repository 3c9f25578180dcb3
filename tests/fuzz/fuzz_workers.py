"""Processes that run cases and may die or hang: then they are named and replaced."""

import json
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path
from queue import Empty, Queue

RUN = Path(__file__).resolve().parent / "run.py"


def outcomes(numbers, *, seed, largest, timeout, dim=2, mode="", n_workers=1, deadline=None):
    """Yield a dict for every case number; with one worker, in their order.

    The mode is that of ``run.py``: none, "harsh" or "files".
    """
    command = [sys.executable, str(RUN), "--worker", "--seed", str(seed), "--dim", str(dim)]
    command += [] if largest is None else ["--largest", str(largest)]
    command += [f"--{mode}"] if mode else []
    waiting, rows, stop = iter(list(numbers)), Queue(), threading.Event()
    lock = threading.Lock()

    def serve():
        worker = _Worker(command)
        while not stop.is_set():
            with lock:
                number = next(waiting, None)
            if number is None:
                break
            row = worker.result(number, timeout)
            if row is None:
                row = {"number": number, **worker.how_it_ended(timeout)}
                row["problem"] = row["message"]
                worker.end()
                worker = _Worker(command)
            rows.put(row)
        worker.end()
        rows.put(None)

    threads = [threading.Thread(target=serve, daemon=True) for _ in range(n_workers)]
    for thread in threads:
        thread.start()
    try:
        yield from _rows(rows, n_workers, deadline)
    finally:
        stop.set()
        for thread in threads:
            thread.join()


def _rows(rows, n_workers, deadline):
    """Yield rows until every worker has ended, or the time is over."""
    while n_workers:
        row = rows.get()
        if row is None:
            n_workers -= 1
            continue
        yield row
        if deadline is not None and time.monotonic() > deadline:
            return


class _Worker:
    """A process that reads the number of a case from a line and prints a line of JSON for it."""

    def __init__(self, command):
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        self.lines = Queue()
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        with self.process.stdout as lines:
            for line in lines:
                self.lines.put(line)
        self.lines.put(None)

    def result(self, number, timeout):
        """Return the row of a case, or None when the process died or gave no answer."""
        try:
            self.process.stdin.write(f"{number}\n")
            self.process.stdin.flush()
            line = self.lines.get(timeout=timeout)
        except (Empty, BrokenPipeError):
            return None
        return None if line is None else json.loads(line)

    def how_it_ended(self, timeout):
        """Return the verdict on a process that gave no answer, and the words for it."""
        try:
            status = self.process.wait(timeout=1)
        except subprocess.TimeoutExpired:
            return {"verdict": "hang", "message": f"hangs: no result after {timeout} s"}
        how = f"of {signal.Signals(-status).name}" if status < 0 else f"with status {status}"
        return {"verdict": "signal", "message": f"the process died {how}"}

    def end(self):
        self.process.kill()
        self.process.wait()
        self.reader.join()
        with suppress(BrokenPipeError):  # a line that nobody read
            self.process.stdin.close()
