"""Where progress is drawn: below what a terminal shows, under a cell, or as lines in a log."""

import io
import sys
from contextlib import redirect_stdout
from types import SimpleNamespace

import pytest
from terminal import Terminal

from anistar.base.progress.screens import LineScreen, Row, TerminalScreen, clock, screen_for

ROWS = [
    Row("outer", "remesh", 0.5, "1 of 2", "", 61.0, 3700.0),
    Row("inner", "size", 0.25, "", "9 points", 2.0, None),
]


@pytest.fixture
def terminal(monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "90")
    monkeypatch.setenv("LINES", "6")
    return Terminal(height=6)


def test_a_terminal_shows_both_levels_and_is_left_as_it_was(terminal):
    terminal.write("before\n")
    screen = screen_for(terminal, is_wanted=False)
    assert isinstance(screen, TerminalScreen)
    with screen:
        for _ in range(3):
            screen.draw(ROWS)
        before, empty, outer, inner = terminal.text.splitlines()
        assert (before, empty) == ("before", "")
        for words, line in (
            (("outer", "remesh", "1 of 2", "1:01 of about 1:01:40"), outer),
            (("inner", "size", "25 %", "9 points", "0:02"), inner),
        ):
            assert [word for word in words if word not in line] == []
    assert terminal.text == "before"


def test_what_is_printed_beside_the_bars_stays_whole(terminal):
    with redirect_stdout(terminal), screen_for(terminal, is_wanted=False) as screen:
        for k in range(12):
            screen.draw(ROWS)
            assert sys.stdout is terminal
            sys.stdout.write("half a line ")
            screen.draw(ROWS)
            assert "inner" in terminal.lines[min(k + 2, 5)]
            sys.stdout.write(f"and {k}\n")
    assert terminal.text.splitlines() == [f"half a line and {k}" for k in range(12)]


def test_a_terminal_that_is_too_low_shows_what_it_can(terminal, monkeypatch):
    monkeypatch.setenv("LINES", "2")
    with screen_for(terminal, is_wanted=False) as screen:
        screen.draw(ROWS)
        assert "outer" in terminal.text
        assert "inner" not in terminal.text
    assert terminal.text == ""


def test_a_terminal_without_a_cursor_shows_nothing(terminal, monkeypatch):
    monkeypatch.setenv("TERM", "dumb")
    with screen_for(terminal, is_wanted=False) as screen:
        screen.draw(ROWS)
        assert terminal.text == ""


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
