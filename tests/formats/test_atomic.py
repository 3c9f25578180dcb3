"""Files are replaced whole or not at all, and nobody else's file is touched."""

import os
import subprocess
import sys
import threading

import pytest
from meshes import square

from anistar.base.atomic import all_replaced, remove_leftovers, replaced
from anistar.base.errors import FormatError
from anistar.formats import read, write


@pytest.fixture(scope="module")
def dead():
    """The number of a process that has ended."""
    process = subprocess.Popen([sys.executable, "-S", "-c", ""])
    process.wait()
    return process.pid


def test_leftovers_of_dead_processes_are_removed_and_nothing_else(tmp_path, dead):
    gone = [
        f".report.{dead}-3.part.json",
        f".report.{dead}.part.json",
        ".report.9999999999999.part.json",
        f".report.{os.getpid()}-0.part.json",  # of a process that had our number before
    ]
    stay = [
        ".my.partition.json",
        ".report.part.json",
        f".report.{dead}.party.json",
        f".report.x{dead}.part.json",
        f"report.{dead}.part.json",
        f".other.{dead}.part.json",
        f".report.{os.getppid()}-0.part.json",  # of a process that may be writing it
        "report.json",
    ]
    for name in [*gone, *stay]:
        (tmp_path / name).write_text("content")
    for name in (".old.parts", f".report.{dead}-4.part.json"):
        (tmp_path / name).mkdir()
    remove_leftovers(tmp_path, {"report.json"}.__contains__)
    left = {path.name for path in tmp_path.iterdir()}
    assert left == {*stay, ".old.parts", f".report.{dead}-4.part.json"}


def test_two_threads_that_write_one_path_leave_one_whole_file(tmp_path):
    path, both = tmp_path / "report.json", threading.Barrier(2)
    names = []

    def written(text):
        with replaced(path) as temporary:
            names.append(temporary.name)
            both.wait(timeout=30)
            for letter in text:
                with temporary.open("a") as stream:
                    stream.write(letter)

    threads = [threading.Thread(target=written, args=(letter * 100,)) for letter in "ab"]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(set(names)) == 2
    assert path.read_text() in ("a" * 100, "b" * 100)
    assert list(tmp_path.iterdir()) == [path]


def test_a_file_is_on_the_disk_before_it_takes_its_name(tmp_path, monkeypatch):
    done = []
    monkeypatch.setattr(os, "fsync", lambda number: done.append(os.fstat(number).st_ino))
    with replaced(tmp_path / "a.txt") as temporary:
        temporary.write_text("new")
        file = temporary.stat().st_ino
        assert done == []
    assert done == [file, tmp_path.stat().st_ino]


def test_a_link_keeps_pointing_to_what_is_replaced(tmp_path):
    (tmp_path / "elsewhere").mkdir()
    target, link = tmp_path / "elsewhere" / "data", tmp_path / "link.vtu"
    target.write_text("old")
    link.symlink_to(target)
    write(link, square(2))
    assert link.is_symlink()
    assert read(link)[0].n_points == 9
    assert b"VTKFile" in target.read_bytes()
    assert sorted(tmp_path.rglob("*")) == [target.parent, target, link]


@pytest.mark.parametrize("failing", [0, 1])
def test_files_that_belong_together_are_replaced_together(tmp_path, monkeypatch, failing):
    paths = [tmp_path / "in.mesh", tmp_path / "in.sol"]
    for path in paths:
        path.write_text("old")
    calls = iter(range(9))

    def full(number):
        if next(calls) == failing:
            raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    said = rf"cannot write .*{paths[failing].name}: No space left"
    with pytest.raises(FormatError, match=said), all_replaced(paths) as temporaries:
        assert [temporary.write_text("new") for temporary in temporaries] == [3, 3]
    assert [path.read_text() for path in paths] == ["old", "old"]
    assert sorted(tmp_path.iterdir()) == paths


def test_what_others_may_not_read_stays_so(tmp_path):
    path = tmp_path / "in.vtu"
    path.touch(mode=0o600)
    write(path, square(2))
    assert path.stat().st_mode & 0o777 == 0o600


def test_what_cannot_be_written_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    for path, reason in (
        (tmp_path / "gone" / "a.txt", "No such file"),
        (tmp_path / "file" / "a.txt", "Not a directory"),
        (tmp_path, "it is a folder"),
    ):
        with pytest.raises(FormatError, match=rf"cannot write {path}: {reason}"), replaced(path):
            raise AssertionError("not reached")


def test_a_disk_that_is_full_keeps_the_old_file(tmp_path):
    """As no file may grow beyond a few bytes: the error of a full disk, at the same place."""
    program = (
        "import resource, sys; from pathlib import Path\n"
        "from anistar.base.atomic import replaced\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (10, 10))\n"
        "with replaced(Path('a.txt')) as temporary:\n"
        "    temporary.write_text('x' * 100_000)\n"
    )
    (tmp_path / "a.txt").write_text("old")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert "FormatError: cannot write a.txt: File too large" in done.stderr
    assert [path.read_text() for path in tmp_path.iterdir()] == ["old"]
