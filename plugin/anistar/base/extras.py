"""Optional packages: what to run where one is missing.

The advice names what the package's own metadata asks for, not `anistar[extra]`: an installation
from a wheel file or a checkout has no index to find that in.
"""

from __future__ import annotations

import importlib.metadata
import importlib.util
import re
import shlex
import shutil
import subprocess
import sys

_OF_AN_EXTRA = re.compile(r"""(?:\s*and\s*)?\(?\bextra\s*==\s*["']([^"']+)["']\)?""")


def requirements(extra: str) -> tuple[str, ...]:
    """Return what an extra of anistar requires, as pip takes it.

    Parameters
    ----------
    extra : str
        A name from ``[project.optional-dependencies]``, such as "vtk".

    Raises
    ------
    LookupError
        If the installed anistar has no such extra, or no metadata at all.
    """
    found, known = [], set()
    for requirement in importlib.metadata.requires("anistar") or ():
        package, _, marker = requirement.partition(";")
        extras = _OF_AN_EXTRA.findall(marker)
        known.update(extras)
        if extra in extras:
            rest = _OF_AN_EXTRA.sub("", marker).strip()
            found.append(f"{package.strip()}; {rest}" if rest else package.strip())
    if not found:
        raise LookupError(f"anistar has no extra {extra!r}; known: {', '.join(sorted(known))}")
    return tuple(found)


def install_command(extra: str) -> str:
    """Return the command that installs what an extra requires into this environment."""
    try:
        wanted = requirements(extra)
    except importlib.metadata.PackageNotFoundError:
        return f"the extra {extra!r} of anistar, whose own metadata is missing: install it anew"
    return " ".join([_installer(), *map(_quoted, wanted)])


def _installer() -> str:
    """Return how packages come into this environment; those that uv makes are without pip."""
    python = _quoted(sys.executable or "python")  # a program that embeds Python may name none
    if importlib.util.find_spec("pip") is not None:
        return f"{python} -m pip install"
    if shutil.which("uv"):
        return f"uv pip install --python {python}"
    return f"{python} -m ensurepip && {python} -m pip install"


def _quoted(word: str) -> str:
    return subprocess.list2cmdline([word]) if sys.platform == "win32" else shlex.quote(word)
