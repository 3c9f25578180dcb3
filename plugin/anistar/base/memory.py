"""The memory that this process may still take."""

from __future__ import annotations

import math
import os
from pathlib import Path

try:
    import resource
except ImportError:
    HAS_LIMITS = False  # on Windows
else:
    HAS_LIMITS = True

PROC, GROUPS = Path("/proc"), Path("/sys/fs/cgroup")

#: Bytes to a unit of /proc/meminfo.
KILOBYTE = 1024


def available_memory() -> float:
    """Return the bytes that this process may still take; infinity where nothing tells.

    The least of what the machine has free, what the control group of the process (a container,
    a batch job) may still take, and what its limit of address space leaves.
    """
    return min(_free_memory(), _left_in_group(), _left_in_address_space())


def _free_memory() -> float:
    for line in _text(PROC / "meminfo").splitlines():
        name, _, rest = line.partition(":")
        if name == "MemAvailable":
            return _number(rest.removesuffix("kB")) * KILOBYTE
    try:  # without /proc what is used cannot be told from what is there
        return float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    except (AttributeError, OSError, ValueError):
        return math.inf


def _left_in_group() -> float:
    """Return what the control groups around the process leave, of both versions."""
    left = math.inf
    for line in _text(PROC / "self" / "cgroup").splitlines():
        _, kinds, path = (*line.split(":", 2), "", "")[:3]
        if kinds not in ("", "memory"):
            continue
        root = GROUPS / kinds
        limit, usage, idle = (
            ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file")
            if kinds
            else ("memory.max", "memory.current", "inactive_file")
        )
        inner = root / path.strip("/")  # in a container the outer part may be hidden
        for group in (inner, *inner.parents):
            if root not in (group, *group.parents):
                break
            most = _number(_text(group / limit))
            if math.isfinite(most):
                used = _number(_text(group / usage), 0.0) - _statistic(group, idle)
                left = min(left, max(0.0, most - used))
    return left


def _statistic(group: Path, name: str) -> float:
    """Return a number of the statistics of a control group: files kept there can be dropped."""
    for line in _text(group / "memory.stat").splitlines():
        key, _, value = line.partition(" ")
        if key == name:
            return _number(value, 0.0)
    return 0.0


def _left_in_address_space() -> float:
    if not HAS_LIMITS:
        return math.inf
    most, _ = resource.getrlimit(resource.RLIMIT_AS)
    if most == resource.RLIM_INFINITY:
        return math.inf
    pages = _number(_text(PROC / "self" / "statm").partition(" ")[0], 0.0)
    return max(0.0, most - pages * resource.getpagesize())


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="ascii", errors="replace")
    except OSError:
        return ""


def _number(text: str, otherwise: float = math.inf) -> float:
    try:
        return float(text)
    except ValueError:  # "max": there is no limit
        return otherwise
