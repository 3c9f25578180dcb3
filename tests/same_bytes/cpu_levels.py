"""Environments in which the libraries below choose other code than they would on this CPU."""

import ctypes
import math
import os
import platform
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy._core._multiarray_umath import __cpu_dispatch__, __cpu_features__

BLAS_KERNELS = {
    "Haswell": {"avx2", "fma"},
    "Zen": {"avx2", "fma"},
    "SkylakeX": {"avx512f", "avx512bw", "avx512dq", "avx512vl", "fma"},
    "Sandybridge": {"avx"},
    "Prescott": {"pni"},  # what Linux calls SSE3
}
"""Kernels of OpenBLAS, and the flags of the CPU that can run them."""

NO_FUSED = "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX512F,-AVX512VL"
"""Makes the C library take its functions without fused multiply-add."""

CHOSEN_ELSEWHERE = ("OPENBLAS_CORETYPE", "NPY_DISABLE_CPU_FEATURES", "GLIBC_TUNABLES")


@dataclass(frozen=True)
class Level:
    """An environment; `simd` are the features that NumPy must then say it has."""

    name: str
    variables: dict[str, str]
    simd: list[str] | None = None

    def environment(self):
        """Return the variables of this process with those of the level."""
        kept = {k: v for k, v in os.environ.items() if k not in CHOSEN_ELSEWHERE}
        return kept | self.variables

    def took_effect(self, chosen, plain):
        """Return whether the libraries really chose otherwise, by what `described` said."""
        if self.simd is not None:
            return chosen["simd"] == self.simd
        if "GLIBC_TUNABLES" in self.variables:
            return chosen["libm"] != plain["libm"]
        return chosen["simd"] == plain["simd"]  # OpenBLAS names its kernels as it likes


def described():
    """Return what the libraries of this process chose."""
    return {
        "simd": [name for name in __cpu_dispatch__ if __cpu_features__[name]],
        "blas": _blas_kernel(),
        "libm": math.fsum(_libm_samples()).hex(),
    }


def _blas_kernel():
    """Name of the kernel that NumPy's own OpenBLAS uses, None where it has another BLAS."""
    folder = Path(np.__file__).parent.with_name("numpy.libs")
    for library in sorted(folder.glob("*openblas*")):
        name = ctypes.CDLL(str(library)).scipy_openblas_get_corename64_
        name.restype = ctypes.c_char_p
        return name().decode()
    return None


def _libm_samples():
    """Values of which some round differently with and without fused multiply-add."""
    x = [0.37 + 0.0137 * k for k in range(2000)]
    return [f(v) - round(f(v), 6) for v in x for f in (math.exp, math.log, math.sin)]


def simd_levels():
    """Levels of NumPy's own dispatch, each without one more of the features of this CPU."""
    present = [name for name in __cpu_dispatch__ if __cpu_features__[name]]
    levels = []
    for kept in range(len(present) - 1, -1, -1):
        without = present[kept:]
        levels.append(
            Level(
                name=f"NumPy without {' '.join(without)}",
                variables={"NPY_DISABLE_CPU_FEATURES": " ".join(without)},
                simd=present[:kept],
            )
        )
    return levels


def libm_levels():
    """Return the level without fused multiply-add, if the C library of this machine has one."""
    if platform.libc_ver()[0] != "glibc" or "fma" not in cpu_flags():
        return []
    return [Level(name="libm without FMA", variables={"GLIBC_TUNABLES": NO_FUSED})]


def blas_levels():
    """Return the levels of the kernels of OpenBLAS that this CPU can run."""
    if _blas_kernel() is None:
        return []
    return [
        Level(name=f"OpenBLAS {kernel}", variables={"OPENBLAS_CORETYPE": kernel})
        for kernel, needed in BLAS_KERNELS.items()
        if needed <= cpu_flags()
    ]


def cpu_flags():
    """Return the flags of the CPU that Linux names, none elsewhere."""
    info = Path("/proc/cpuinfo")
    if not info.exists():
        return frozenset()
    lines = info.read_text().splitlines()
    return frozenset(next((line for line in lines if line.startswith("flags")), "").split())


def output_at(level, command):
    """Run a command at a level and return its standard output."""
    done = subprocess.run(
        command, env=level.environment(), capture_output=True, text=True, timeout=600
    )
    if done.returncode:
        raise RuntimeError(f"{level.name}: exit status {done.returncode}\n{done.stderr}")
    return done.stdout
