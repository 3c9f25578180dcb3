"""The core calls no function of the C library whose rounding depends on the CPU."""

import shutil
import subprocess

import pytest

from anistar import _core

DISPATCHED = [
    "acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "cbrt", "cos", "cosh", "erf",
    "exp", "exp10", "exp2", "expm1", "fma", "hypot", "lgamma", "log", "log10", "log1p", "log2",
    "pow", "sin", "sincos", "sinh", "tan", "tanh", "tgamma",
]  # fmt: skip

# Of CGAL's alpha wraps: levels of a hierarchy and directions of rays, which only choose the way on
# which the same answer is found.
OF_WRAPS = {"log", "sincos"}


@pytest.mark.skipif(shutil.which("nm") is None, reason="nm of the binutils is missing")
def test_the_compiled_module_imports_no_elementary_function():
    command = ["nm", "--dynamic", "--undefined-only", "--format=posix", _core.__file__]
    lines = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
    imported = {line.split()[0].partition("@")[0] for line in lines}
    assert "malloc" in imported
    assert (
        imported & {name + suffix for name in DISPATCHED for suffix in ("", "f", "l")} == OF_WRAPS
    )
