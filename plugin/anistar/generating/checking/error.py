"""The error of a complex of which there is no mesh."""

from __future__ import annotations

from collections.abc import Sequence

from ...base.errors import MeshingError
from ..plc import PLC
from .check import check_plc
from .problem import KINDS, PLCProblem


class PLCError(MeshingError):
    """The geometry is not valid: facets cross, a surface is open, or the like.

    Attributes
    ----------
    problems : list of PLCProblem
        The worst first, not all of a kind.
    """

    def __init__(self, problems: Sequence[PLCProblem]) -> None:
        super().__init__(_summary(problems))
        self.problems = list(problems)


def require_valid(plc: PLC) -> list[PLCProblem]:
    """Raise if there is no mesh of a complex, otherwise return what else is worth knowing of it.

    Raises
    ------
    PLCError
        Names what is wrong.
    """
    problems = check_plc(plc)
    severe = [problem for problem in problems if problem.is_severe]
    if severe:
        raise PLCError(severe)
    return problems


def _summary(problems: Sequence[PLCProblem]) -> str:
    first_of: dict[str, PLCProblem] = {}
    for problem in problems:
        first_of.setdefault(problem.kind, problem)
    # what crosses is told before what may come of it, points that are out of their places
    told = sorted(first_of.values(), key=lambda p: _ORDER_TOLD.index(p.kind))
    first, others = told[0], told[1:]
    more = [f"{first.alike - 1} more {KINDS[first.kind].several}"] if first.alike > 1 else []
    more += [f"{p.alike} of the kind {p.kind!r}" for p in others]
    counted = f"and {', '.join(more)}; " if more else ""
    return f"{first.message} ({counted}{_HOW_TO_SEE})"


_HOW_TO_SEE = "anistar.check_plc lists them, anistar check --mark bad.vtu shows them"
_CAUSES = ("crossing", "overlap")
_ORDER_TOLD = [*_CAUSES, *(kind for kind in KINDS if kind not in _CAUSES)]
