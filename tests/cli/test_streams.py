"""The work is done whatever becomes of the streams, and the exit code tells of the work."""

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from meshes import square

import anistar
from anistar.cli import main

# As PETSc leaves it, which has handlers of its own.
PROGRAM = """
import signal, sys
signal.signal(signal.SIGPIPE, signal.SIG_DFL)
from anistar.cli import main
sys.exit(main())
"""
ANISTAR = shlex.join([sys.executable, "-c", PROGRAM])


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mesh = square(4)
    anistar.write("in.vtu", mesh, {"u": mesh.points[:, 0] ** 2})
    anistar.write("other.vtu", square(3))
    return tmp_path


def shell(command):
    return subprocess.run(
        ["bash", "-o", "pipefail", "-c", command.replace("anistar", ANISTAR, 1)],
        env={**os.environ, "PYTHONPATH": str(Path(anistar.__file__).parents[1])},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize("closed", ["2>&-", "--json >&- 2>&- <&-"])
def test_closed_streams_take_nothing_and_spoil_nothing(folder, closed):
    done = shell(f"anistar adapt in.vtu --target-complexity 30 -o out.vtu {closed}")
    assert (done.returncode, done.stderr) == (0, "")
    assert ("out.vtu" in done.stdout) == (closed == "2>&-")
    mesh, fields = anistar.read("out.vtu")
    assert anistar.validate(mesh, anistar.read("in.vtu")[0]) == []
    assert set(fields) == {"u", "simplex_ok", "star_ok", "surface_star_ok"}


def test_an_error_never_goes_to_stdout(folder):
    done = shell("anistar convert gone.vtu o.vtu >&-")
    said = "anistar convert: error: cannot read gone.vtu: no such file\n"
    assert (done.returncode, done.stderr) == (2, said)


def test_a_reader_that_leaves_in_the_midst_of_it_ends_nothing(folder):
    done = shell("anistar check in.vtu --json | head -c 1")
    assert (done.returncode, done.stdout, done.stderr) == (0, "{", "")
    done = shell("anistar convert gone.vtu o.vtu 2>&1 | true")
    assert (done.returncode, done.stdout, done.stderr) == (2, "", "")


@pytest.mark.parametrize(
    ("words", "code"),
    [
        ("check in.vtu --json", 0),
        ("check in.vtu", 0),
        ("check in.vtu --reference other.vtu", 0),
        ("check in.vtu --reference cut.vtu", 1),
        ("adapt --help", 0),
    ],
)
def test_that_nobody_reads_is_no_error(folder, monkeypatch, words, code):
    mesh = square(4)
    anistar.write("cut.vtu", anistar.Mesh(points=0.5 * mesh.points, cells=mesh.cells))
    reader, writer = os.pipe()
    os.close(reader)
    with os.fdopen(writer, "w") as stream, monkeypatch.context() as streams:
        streams.setattr("sys.stdout", stream)
        assert main(words.split()) == code


def test_what_a_full_disk_keeps_from_being_printed_is_told(folder, monkeypatch, capsys):
    if not Path("/dev/full").exists():
        pytest.skip("no /dev/full here")
    with Path("/dev/full").open("w") as stream, monkeypatch.context() as streams:
        streams.setattr("sys.stdout", stream)
        assert main(["check", "in.vtu", "--json"]) == 1
    said = capsys.readouterr().err
    assert said == "anistar check: error: cannot print: No space left on device\n"
