"""One run in a folder at a time, and none that is blocked by a dead one."""

import os
import subprocess
import sys
import threading
from contextlib import suppress

import pytest

from anistar import folder_lock
from anistar.errors import FormatError
from anistar.folder_lock import LOCK, locked

HOLD = """
import sys, time
from pathlib import Path
from anistar.folder_lock import locked
with locked(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(60)
"""


def test_a_second_run_is_refused_by_folder_and_process(tmp_path):
    link = tmp_path / "link"
    (tmp_path / "run").mkdir()
    link.symlink_to(tmp_path / "run")
    said = rf"run is in use by process {os.getpid()}: wait until it ends or stop it, or choose"
    with locked(tmp_path / "run"):
        with pytest.raises(FormatError, match=said), locked(tmp_path / "run"):
            raise AssertionError("not reached")
        with (
            pytest.raises(FormatError, match=f"link is in use by process {os.getpid()}"),
            locked(link),
        ):
            raise AssertionError("not reached")
    assert list((tmp_path / "run").iterdir()) == []
    with locked(link):
        assert (tmp_path / "run" / LOCK).read_text() == str(os.getpid())


def test_a_run_that_fails_lets_go(tmp_path):
    with suppress(KeyError), locked(tmp_path):
        raise KeyError
    with locked(tmp_path):
        pass


def test_a_run_that_was_killed_blocks_nobody(tmp_path):
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    process = subprocess.Popen(
        [sys.executable, "-c", HOLD, tmp_path], env=environment, stdout=subprocess.PIPE, text=True
    )
    with process:
        assert process.stdout.readline() == "held\n"
        said = f"in use by process {process.pid}: "
        with pytest.raises(FormatError, match=said), locked(tmp_path):
            raise AssertionError("not reached")
        process.kill()
        process.wait()
        assert (tmp_path / LOCK).read_text() == str(process.pid)
        with locked(tmp_path):
            assert (tmp_path / LOCK).read_text() == str(os.getpid())


def no_locks(*arguments):
    raise OSError(37, "No locks available")


@pytest.mark.parametrize("lacks", ["module", "file system"])
def test_without_locks_of_the_system_a_living_process_counts(tmp_path, monkeypatch, lacks):
    if lacks == "module":
        monkeypatch.setattr(folder_lock, "fcntl", None)
    else:
        monkeypatch.setattr("fcntl.flock", no_locks)
    (tmp_path / LOCK).write_text(str(os.getppid()))
    with pytest.raises(FormatError, match=f"by process {os.getppid()}"), locked(tmp_path):
        raise AssertionError("not reached")
    for content in ("", "99999999", str(os.getpid())):
        (tmp_path / LOCK).write_text(content)
        with locked(tmp_path):
            assert (tmp_path / LOCK).read_text() == str(os.getpid())
        assert list(tmp_path.iterdir()) == []


def test_never_two_at_a_time_however_often_they_come_and_go(tmp_path):
    inside, most, times = [], [], []

    def come_and_go():
        for _ in range(100):
            with suppress(FormatError), locked(tmp_path):
                inside.append(1)
                most.append(len(inside))
                inside.pop()
                times.append(1)

    threads = [threading.Thread(target=come_and_go) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert max(most) == 1
    assert len(times) >= 10
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_cannot_be_written_is_named(tmp_path):
    said = r"cannot write .*gone/\.anistar\.lock: No such"
    with pytest.raises(FormatError, match=said), locked(tmp_path / "gone"):
        raise AssertionError("not reached")
