"""One run in a folder at a time, and none that is blocked by a dead one."""

import os
import socket
import subprocess
import sys
import threading
from contextlib import suppress

import pytest

from anistar.base.errors import FormatError
from anistar.runs import lock
from anistar.runs.lock import LOCK, TAKEOVER, locked

HOLD = """
import sys, time
from pathlib import Path
from anistar.runs.lock import locked
with locked(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(60)
"""


def signed(pid):
    return f"{pid} {socket.gethostname()}"


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
        assert (tmp_path / "run" / LOCK).read_text() == signed(os.getpid())


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
        assert (tmp_path / LOCK).read_text() == signed(process.pid)
        with locked(tmp_path):
            assert (tmp_path / LOCK).read_text() == signed(os.getpid())


def no_locks(*arguments):
    raise OSError(37, "No locks available")


def without_locks(monkeypatch, lacks):
    if lacks == "module":
        monkeypatch.setattr(lock, "fcntl", None)
    elif lacks == "file system":
        monkeypatch.setattr("fcntl.flock", no_locks)


@pytest.mark.parametrize("lacks", ["module", "file system"])
def test_without_locks_of_the_system_a_process_counts_that_may_live(tmp_path, monkeypatch, lacks):
    without_locks(monkeypatch, lacks)
    for content, named in (
        (signed(os.getppid()), f"{os.getppid()}:"),
        (str(os.getppid()), f"{os.getppid()}:"),
        ("99999999 elsewhere", "99999999 on elsewhere:"),
        ("", r"\(unknown\):"),  # it was made and will be signed
    ):
        (tmp_path / LOCK).write_text(content)
        with pytest.raises(FormatError, match=f"by process {named}"), locked(tmp_path):
            raise AssertionError("not reached")
        assert (tmp_path / LOCK).read_text() == content
    for content in ("99999999", signed(99999999), signed(os.getpid())):
        (tmp_path / LOCK).write_text(content)
        with locked(tmp_path):
            assert (tmp_path / LOCK).read_text() == signed(os.getpid())
            with pytest.raises(FormatError, match="in use by process"), locked(tmp_path):
                raise AssertionError("not reached")
        assert list(tmp_path.iterdir()) == []


def test_a_takeover_that_was_killed_is_told(tmp_path, monkeypatch):
    without_locks(monkeypatch, "module")
    (tmp_path / LOCK).write_text(signed(99999999))
    (tmp_path / TAKEOVER).touch()
    said = r"cannot lock .*: remove \.anistar\.lock and \.anistar\.lock\.takeover if no run"
    with pytest.raises(FormatError, match=said), locked(tmp_path):
        raise AssertionError("not reached")


@pytest.mark.parametrize("lacks", ["nothing", "module"])
def test_never_two_at_a_time_however_often_they_come_and_go(tmp_path, monkeypatch, lacks):
    without_locks(monkeypatch, lacks)
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


COME_AND_GO = """
import os, sys, time
from contextlib import suppress
from pathlib import Path
from anistar.runs import lock
from anistar.base.errors import FormatError
lock.fcntl = None
folder, other = Path(sys.argv[1]), Path(sys.argv[1]) / "inside"
(folder / f"ready_{sys.argv[2]}").touch()
end = time.monotonic() + 60
while len(list(folder.glob("ready_*"))) < 2 and time.monotonic() < end:
    time.sleep(0.001)
times = 0
for _ in range(300):
    with suppress(FormatError), lock.locked(folder):
        os.close(os.open(other, os.O_CREAT | os.O_EXCL))  # fails where another is inside
        times += 1
        other.unlink()
print(times)
"""


def test_never_two_processes_at_a_time_without_locks_of_the_system(tmp_path):
    (tmp_path / LOCK).write_text(signed(99999999))
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    processes = [
        subprocess.Popen(
            [sys.executable, "-c", COME_AND_GO, tmp_path, str(number)],
            env=environment,
            stdout=subprocess.PIPE,
            text=True,
        )
        for number in range(2)
    ]
    times = [int(process.communicate()[0]) for process in processes]
    assert [process.returncode for process in processes] == [0, 0]
    assert sum(times) >= 10
    assert {path.name for path in tmp_path.iterdir()} == {"ready_0", "ready_1"}


def test_a_folder_that_cannot_be_written_is_named(tmp_path):
    said = r"cannot write .*gone/\.anistar\.lock: No such"
    with pytest.raises(FormatError, match=said), locked(tmp_path / "gone"):
        raise AssertionError("not reached")
