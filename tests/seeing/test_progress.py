"""What long calls show: one display, after a second, for who looks."""

import contextlib
import io
import os
import pty
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
from meshes import square
from terminal import Terminal

import anistar
from anistar.base.progress import tasks as display

PACKAGE = str(Path(anistar.__file__).parents[1])

SECONDS_BEFORE_IT_HANGS = 60.0

# It goes on when it is told to: as soon as the bars are seen.
PROGRAM = """
import contextlib, io, sys
from anistar.base.progress import tasks as progress
from anistar.base.progress import task
progress.SECONDS_BEFORE_DISPLAY = 0.0
kept = io.StringIO()
with task("outer", total=2) as outer:
    outer.advance("12 points")
    with task("inner") as inner:
        inner.enter("size", 0.25)
        with contextlib.redirect_stdout(kept):
            sys.stdin.readline()
            print("kept")
        print("within")
print("after, and", kept.getvalue().strip())
with task("last"):
    sys.stdin.readline()
    print("at last")
    raise KeyboardInterrupt("no more")
"""


class Frames:
    """A screen that keeps what is drawn; whoever wants to see a state waits for it to be drawn."""

    def __init__(self):
        self.drawn, self.is_left = [], False
        self._news = threading.Condition()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.is_left = True

    def draw(self, rows):
        with self._news:
            self.drawn.append([(row.name, row.phase, row.steps or row.note) for row in rows])
            self._news.notify_all()

    def wait(self, *_):
        """Wait for a frame that was begun after now, which the next one need not be."""
        with self._news:
            until = len(self.drawn) + 2
            assert self._news.wait_for(
                lambda: len(self.drawn) >= until, timeout=SECONDS_BEFORE_IT_HANGS
            )


@pytest.fixture
def frames(monkeypatch):
    """What is drawn, at once instead of after a second."""
    made = Frames()
    monkeypatch.setattr(display, "SECONDS_BEFORE_DISPLAY", 0.0)
    monkeypatch.setattr(display, "SECONDS_BETWEEN_FRAMES", 0.001)
    monkeypatch.setattr(display, "screen_for", lambda stream, is_wanted: made)
    return made


@contextlib.contextmanager
def on_a_terminal(program):
    """Run a program with standard error on a terminal, and end it if it hangs."""
    terminal, stderr = pty.openpty()
    variables = {**os.environ, "PYTHONPATH": PACKAGE, "TERM": "xterm", "COLUMNS": "100"}
    with subprocess.Popen(
        [sys.executable, "-c", program],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=stderr, env=variables,
    ) as running:  # fmt: skip
        os.close(stderr)
        end = threading.Timer(SECONDS_BEFORE_IT_HANGS, running.kill)
        end.start()
        yield running, terminal
        end.cancel()
    os.close(terminal)


def read_until(terminal, marker=None):
    """Return what comes until there is a marker, or until the end."""
    said = ""
    while marker is None or marker not in said:
        try:
            said += os.read(terminal, 65536).decode()
        except OSError:  # the other end is closed
            assert marker is None, said
            break
    return said


def test_the_bars_come_and_go_and_leave_standard_output_alone():
    with on_a_terminal(PROGRAM) as (program, terminal):
        shown = read_until(terminal, "25 %")
        program.stdin.write(b"\n")
        program.stdin.flush()
        shown += read_until(terminal, "last")
        program.stdin.write(b"\n")
        program.stdin.flush()
        shown += read_until(terminal)
        stdout = program.stdout.read().decode()
    assert stdout == "within\nafter, and kept\nat last\n"
    for words in ("outer", "1 of 2", "inner", "size"):
        assert words in shown
    before, trace = shown.split("Traceback")
    screen = Terminal()
    screen.write(before)
    assert screen.text == ""
    assert "KeyboardInterrupt: no more" in trace
    assert "\x1b[J" not in trace


def test_calls_below_a_second_show_nothing(frames, monkeypatch):
    monkeypatch.setattr(display, "SECONDS_BEFORE_DISPLAY", SECONDS_BEFORE_IT_HANGS)
    assert _is_shown("short")
    assert frames.drawn == []


def test_the_environment_turns_the_display_on_and_off(monkeypatch):
    monkeypatch.setattr(sys, "stderr", Terminal())
    assert _is_shown("by itself")
    monkeypatch.setenv("ANISTAR_PROGRESS", "0")
    assert not _is_shown("unwanted")
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    monkeypatch.setenv("ANISTAR_PROGRESS", "1")
    assert _is_shown("wanted in a log")


def test_nested_calls_share_one_display_that_names_the_phases(frames):
    mesh = square(6)

    def solve(mesh, fields):
        frames.wait()
        return {"u": np.tanh(9 * mesh.points[:, 0])}

    each = anistar.AdaptOptions.from_dict({"callback": frames.wait})
    options = anistar.LoopOptions(complexities=(100, 1000), adapt=each)
    loop = anistar.adapt_loop(solve, mesh, options)
    assert anistar.validate(loop.steps[-1].mesh, mesh) == []
    assert frames.is_left
    rows = {row for frame in frames.drawn for row in frame}
    assert {name for name, _, _ in rows} >= {"loop", "adapt", "remesh"}
    assert {phase for name, phase, _ in rows if name == "remesh"} >= {"size", "shape", "report"}
    assert {steps for name, _, steps in rows if name == "loop"} >= {"0 of 3", "2 of 3"}
    told = {note for name, _, note in rows if name == "remesh" and note}
    points = {int(note.removesuffix(" points").replace(",", "")) for note in told}
    assert max(points) == pytest.approx(loop.steps[-1].mesh.n_points, rel=0.1)


def test_the_display_changes_no_byte_and_leaves_the_callback_of_the_user(frames, monkeypatch):
    mesh, seen = square(8), []
    u = np.tanh(20 * (mesh.points[:, 0] - mesh.points[:, 1]))

    def adapted(watch):
        def callback(phase, fraction):
            seen.append(phase)
            watch()

        options = {"target_complexity": 300, "callback": callback}
        return anistar.adapt(mesh, {"u": u}, anistar.AdaptOptions.from_dict(options))

    shown = adapted(frames.wait)
    assert anistar.validate(shown.mesh, mesh) == []
    monkeypatch.setattr(display, "screen_for", lambda stream, is_wanted: None)
    dark = adapted(lambda: None)
    assert seen[: len(seen) // 2] == seen[len(seen) // 2 :]
    assert {"curves", "size", "shape", "report"} <= set(seen)
    assert dark.mesh.points.tobytes() == shown.mesh.points.tobytes()
    assert dark.mesh.cells.tobytes() == shown.mesh.cells.tobytes()
    assert frames.is_left


def test_a_callback_that_raises_ends_the_call_and_the_display(frames):
    mesh = square(4)

    def stop(phase, fraction):
        raise InterruptedError("enough")

    M = np.tile(200 * np.eye(2), (mesh.n_points, 1, 1))
    with pytest.raises(InterruptedError, match="enough"):
        anistar.remesh(mesh, M, anistar.RemeshOptions(callback=stop))
    assert display.current_task() is None
    with display.task("next") as line:
        assert line.is_shown


def test_another_thread_works_in_silence_beside_the_display(frames):
    with display.task("first") as line:
        shown = []
        thread = threading.Thread(target=lambda: shown.append(_is_shown("second")))
        thread.start()
        thread.join()
        assert line.is_shown
        assert shown == [False]


def _is_shown(name):
    with display.task(name) as line:
        return line.is_shown


def test_progress_is_turned_on_and_off_by_a_call(monkeypatch):
    monkeypatch.setattr("sys.stderr", io.StringIO())  # no terminal
    assert not _is_shown("by itself")
    try:
        anistar.progress(True)
        assert _is_shown("wanted")
        with display.quiet():
            assert not _is_shown("for a while not")
        anistar.progress(False)
        assert not _is_shown("unwanted")
    finally:
        anistar.progress(None)
    with pytest.raises(TypeError, match="progress takes True, False or None, not 'on'"):
        anistar.progress("on")


def test_silence_in_one_thread_is_not_that_of_another(frames):
    begun, end = threading.Event(), threading.Event()

    def work():
        with display.quiet():
            begun.set()
            end.wait()

    silent = threading.Thread(target=work, daemon=True)
    silent.start()
    begun.wait()
    assert _is_shown("beside it")
    with display.quiet():
        with display.quiet(False):
            assert not _is_shown("still silent")
        end.set()
        silent.join()
    assert _is_shown("after both")
