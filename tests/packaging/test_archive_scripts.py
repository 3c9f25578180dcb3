"""The scripts that build and try the archives say what they leave out."""

import re
import subprocess

import pytest
from documents import ROOT

PACKAGING = ROOT / "packaging"


def function(script, name):
    """Return a function of a script, as bash defines it."""
    found = re.search(rf"^{name}\(\) \{{.*?^\}}$", (PACKAGING / script).read_text(), re.M | re.S)
    assert found, f"there is no {name} in {script}"
    return found[0]


def bash(*lines, **environment):
    done = subprocess.run(
        ["/bin/bash", "-euc", "\n".join(lines)],
        cwd=ROOT,
        env={"PATH": "/usr/bin:/bin", "HOME": "/nowhere", **environment},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout, done.stderr


SAY = "say() { printf '%s\\n' \"$*\" >&2; }"


def test_the_linked_wheel_takes_the_core_of_the_build_just_made():
    wheel = "build/wheel/anistar-0.3.0-cp312-abi3-linux_x86_64.whl"
    told, _ = bash(function("build_archives.sh", "core_of"), f"core_of {wheel}")
    assert told == f"{ROOT}/build/cp312-abi3-linux_x86_64/libanistar_core.a\n"


def test_it_is_built_in_a_folder_that_no_other_build_uses():
    linked = function("build_archives.sh", "build_wheel_for_3_11")
    assert re.search(r"build-dir=(\S+)", linked)[1] == "build/linked-3.11"


@pytest.mark.parametrize("script", ["build_archives.sh", "try_archives.sh", "try_paraview.sh"])
def test_no_python_that_was_not_found_is_run(script):
    text = (PACKAGING / script).read_text()
    bare = [line for line in text.splitlines() if '"$(find_python' in line]
    assert bare == []


@pytest.mark.parametrize("found", [True, False])
def test_a_wheel_without_a_python_to_try_it_is_told(found):
    told, warned = bash(
        SAY,
        f"find_python() {{ echo /some/python; {'true' if found else 'false'}; }}",
        'try_wheel() { echo "tried $*"; }',
        function("try_archives.sh", "try_wheel_with"),
        "try_wheel_with later /dist/one.whl 3.14 3.13",
    )
    assert told == ("tried /dist/one.whl /some/python later\n" if found else "")
    assert warned == (
        "" if found else "one.whl is not tried with Python 3.14 3.13, which is not there\n"
    )


@pytest.mark.parametrize("allowed", [True, False])
def test_a_trial_that_cannot_be_without_a_network_says_so(allowed):
    told, warned = bash(
        SAY,
        f'unshare() {{ {"true" if allowed else "false"} && "${{@:2}}"; }}',
        function("try_archives.sh", "offline"),
        "offline echo tried",
    )
    assert told == "tried\n"
    assert ("WARNING: unshare may make no network here" in warned) is not allowed
