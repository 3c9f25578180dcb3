"""What long calls show: one display, after a second, for who looks."""

import io
import os
import pty
import subprocess
import sys
import threading
import time
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from meshes import square

import anistar
from anistar.base import progress as display
from anistar.base.screens import LineScreen, Row, clock, screen_for

SECONDS_BEFORE_DISPLAY = display.SECONDS_BEFORE_DISPLAY
PACKAGE = str(Path(anistar.__file__).parents[1])

# A call of two levels that takes as long as it is told, and how it ends.
PROGRAM = """
import sys, time
from anistar.base import progress
from anistar.base.progress import task
progress.SECONDS_BEFORE_DISPLAY = float(sys.argv[2])
with task("outer", total=2) as outer:
    with task("inner") as inner:
        for k in range(int(sys.argv[1])):
            inner.enter("size", k / int(sys.argv[1]))
            time.sleep(0.01)
    outer.advance("12 points")
    {end}
print("done")
"""


@pytest.fixture
def drawn(monkeypatch):
    """The rows of every frame, drawn at once instead of after a second."""
    frames = []

    class Recorder:
        def __enter__(self):
            return self

        def __exit__(self, *_):
            frames.append("left")

        def draw(self, rows):
            frames.append([(row.name, row.phase, row.steps or row.note) for row in rows])

    monkeypatch.setattr(display, "SECONDS_BEFORE_DISPLAY", 0.0)
    monkeypatch.setattr(display, "SECONDS_BETWEEN_FRAMES", 0.001)
    monkeypatch.setattr(display, "screen_for", lambda stream, is_wanted: Recorder())
    return frames


def on_a_terminal(milliseconds, end="pass", wait=0.05, **environment):
    """Run the program with stderr on a terminal; returns what came there, and on stdout."""
    terminal, stderr = pty.openpty()
    words = [sys.executable, "-c", PROGRAM.format(end=end), str(milliseconds // 10), str(wait)]
    variables = {**os.environ, "PYTHONPATH": PACKAGE, "TERM": "xterm", "COLUMNS": "100"}
    said = []

    def read():
        try:
            while text := os.read(terminal, 65536):
                said.append(text)
        except OSError:  # the other end is closed
            return

    with subprocess.Popen(
        words, stdout=subprocess.PIPE, stderr=stderr, env={**variables, **environment}
    ) as program:
        os.close(stderr)
        reader = threading.Thread(target=read)
        reader.start()
        stdout = program.stdout.read().decode()
    reader.join()
    os.close(terminal)
    return b"".join(said).decode(), stdout


def is_clean(shown):
    """Whether the cursor is back and the last line is empty."""
    return "\x1b[?25h" in shown and shown.endswith("\x1b[1A\x1b[2K")


def test_a_terminal_shows_both_levels_and_is_left_clean():
    shown, stdout = on_a_terminal(600)
    for words in ("outer", "inner", "size", "0 of 2", "%"):
        assert words in shown
    assert is_clean(shown)
    assert stdout == "done\n"


def test_calls_below_a_second_show_nothing():
    assert on_a_terminal(200, wait=SECONDS_BEFORE_DISPLAY) == ("", "done\n")


def test_the_environment_turns_the_display_off():
    assert on_a_terminal(300, ANISTAR_PROGRESS="0") == ("", "done\n")


@pytest.mark.parametrize("error", ["RuntimeError", "KeyboardInterrupt"])
def test_an_exception_clears_the_display_before_it_is_told(error):
    shown, stdout = on_a_terminal(600, end=f"raise {error}('no more')")
    before, trace = shown.split("Traceback")
    assert is_clean(before)
    assert f"{error}: no more" in trace
    assert "\x1b[" not in trace
    assert stdout == ""


def test_nested_calls_share_one_display_that_names_the_phases(drawn):
    mesh = square(6)

    def solve(mesh, fields):
        time.sleep(0.01)
        return {"u": np.tanh(9 * mesh.points[:, 0])}

    loop = anistar.adapt_loop(solve, mesh, anistar.LoopOptions(complexities=(100, 3000)))
    assert anistar.validate(loop.steps[-1].mesh, mesh) == []
    assert drawn.count("left") == 1
    assert drawn[-1] == "left"
    rows = {row for frame in drawn[:-1] for row in frame}
    assert {name for name, _, _ in rows} >= {"loop", "adapt", "remesh"}
    assert {phase for name, phase, _ in rows if name == "remesh"} & {"size", "shape", "agreement"}
    assert {steps for name, _, steps in rows if name == "loop"} >= {"0 of 3", "2 of 3"}
    told = {note for name, _, note in rows if name == "remesh" and note}
    points = {int(note.removesuffix(" points").replace(",", "")) for note in told}
    assert max(points) == pytest.approx(loop.steps[-1].mesh.n_points, rel=0.1)


def test_the_display_changes_no_byte_and_leaves_the_callback_of_the_user(drawn, monkeypatch):
    mesh, seen = square(8), []
    u = np.tanh(20 * (mesh.points[:, 0] - mesh.points[:, 1]))
    options = {"target_complexity": 300, "callback": lambda phase, fraction: seen.append(phase)}
    shown = anistar.adapt(mesh, {"u": u}, anistar.AdaptOptions.from_dict(options))
    assert anistar.validate(shown.mesh, mesh) == []
    monkeypatch.setattr(display, "screen_for", lambda stream, is_wanted: None)
    dark = anistar.adapt(mesh, {"u": u}, anistar.AdaptOptions.from_dict(options))
    assert seen[: len(seen) // 2] == seen[len(seen) // 2 :]
    assert {"curves", "size", "shape", "report"} <= set(seen)
    assert dark.mesh.points.tobytes() == shown.mesh.points.tobytes()
    assert dark.mesh.cells.tobytes() == shown.mesh.cells.tobytes()
    assert "left" in drawn


def test_a_callback_that_raises_ends_the_call_and_the_display(drawn):
    mesh = square(4)

    def stop(phase, fraction):
        raise InterruptedError("enough")

    M = np.tile(200 * np.eye(2), (mesh.n_points, 1, 1))
    with pytest.raises(InterruptedError, match="enough"):
        anistar.remesh(mesh, M, anistar.RemeshOptions(callback=stop))
    assert display.current_task() is None
    with display.task("next") as line:
        assert line.is_shown


def test_another_thread_works_in_silence_beside_the_display(drawn):
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


def test_a_log_gets_a_line_for_a_new_phase_at_most_once_a_second():
    log = io.StringIO()
    screen = screen_for(log, is_wanted=True)
    assert isinstance(screen, LineScreen)
    with screen:
        for seconds, phase in ((1.0, "size"), (1.2, "size"), (1.4, "shape"), (2.5, "report")):
            screen.draw([Row("remesh", phase, 0.5, "", "9 points", seconds, 65.0)])
    assert log.getvalue().splitlines() == [
        "anistar: 0:01 of about 1:05 remesh size 9 points",
        "anistar: 0:02 of about 1:05 remesh report 9 points",
    ]


def test_a_notebook_shows_bars_below_the_cell_and_takes_them_away(monkeypatch):
    pages = []

    class Shown:
        def update(self, page):
            pages.append(page)

    def show(page, display_id):
        pages.append(page)
        return Shown()

    shell = type("ZMQInteractiveShell", (), {})()
    display_module = SimpleNamespace(HTML=lambda text: text, display=show)
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: shell))
    monkeypatch.setitem(sys.modules, "IPython.display", display_module)
    screen = screen_for(None, is_wanted=False)
    with screen:
        for fraction in (0.25, 0.5):
            screen.draw([Row("re<mesh", "size", fraction, "", "9 points", 2.0, None)])
    first, second, last = pages
    assert '<progress value="0.250">' in first
    assert "re&lt;mesh" in first
    assert '<progress value="0.500">' in second
    assert last == ""


def test_a_stream_that_can_only_be_written_to_is_no_terminal():
    class Stream:  # as ParaView's
        def write(self, text):
            pass

    assert screen_for(Stream(), is_wanted=False) is None
    assert isinstance(screen_for(Stream(), is_wanted=True), LineScreen)


def test_times_are_told_as_a_clock_does():
    assert [clock(s) for s in (0.4, 59.6, 3599, 3661)] == ["0:00", "1:00", "59:59", "1:01:01"]
