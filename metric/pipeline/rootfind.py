"""The one factor that makes a graded and bounded metric meet its target complexity."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf
from typing import TypeVar

from ..kernels.elementary import exp, log

Outcome = TypeVar("Outcome")

COMPLEXITY_TOLERANCE = 1e-3
MAX_EVALUATIONS = 12

LARGEST_STEP = 8.0
"""Largest step of the logarithm of the factor."""

FLAT_SLOPE = 1e-3
"""Below this d log(complexity) / d log(factor), bounds or gradation hold the complexity."""


@dataclass(frozen=True, slots=True)
class Evaluation:
    """One evaluation: the complexity that a factor gives."""

    factor: float
    complexity: float


def rescaling(
    attempt: Callable[[float], tuple[float, Outcome]], target: float, dim: int
) -> tuple[Outcome, Evaluation, list[Evaluation]]:
    """Find the factor on the metric that gives `target`, by a bracketed secant method.

    Works on logarithms, where a metric without bounds and gradation is a line of slope d / 2.

    Parameters
    ----------
    attempt : callable
        Takes a factor, returns the complexity and what was made with it.
    target : float
        Complexity to reach.
    dim : int
        Dimension of the metric.

    Returns
    -------
    outcome
        What the best factor made.
    best : Evaluation
        The one nearest to the target, in ratio.
    evaluations : list of Evaluation
        All of them, at most `MAX_EVALUATIONS`. The search ends early when the complexity no
        longer answers to the factor.
    """
    evaluations: list[Evaluation] = []
    history: list[tuple[float, float]] = []
    below, above = (-inf, -inf), (inf, inf)
    x, slope, nearest = 0.0, dim / 2.0, inf
    for _ in range(MAX_EVALUATIONS):
        value, made = attempt(exp(x))
        y = log(value / target)
        evaluations.append(Evaluation(exp(x), value))
        if abs(y) < nearest:
            nearest, best, outcome = abs(y), evaluations[-1], made
        history.append((x, y))
        if abs(y) <= 0.5 * COMPLEXITY_TOLERANCE:
            break
        if y < 0.0:
            below = max(below, (x, y))
        else:
            above = min(above, (x, y))
        if len(history) > 1 and history[-1][0] != history[-2][0]:
            slope = (y - history[-2][1]) / (x - history[-2][0])
            moved = abs(x - history[-2][0])
            if slope < FLAT_SLOPE and moved > 1.0 and not _bracketed(below, above):
                break
        x = _next(x, y, max(slope, FLAT_SLOPE), below, above)
    return outcome, best, evaluations


def _bracketed(below: tuple[float, float], above: tuple[float, float]) -> bool:
    return below[0] > -inf and above[0] < inf


def _next(
    x: float, y: float, slope: float, below: tuple[float, float], above: tuple[float, float]
) -> float:
    step = max(-LARGEST_STEP, min(LARGEST_STEP, -y / slope))
    proposed = x + step
    if _bracketed(below, above) and not below[0] < proposed < above[0]:
        return 0.5 * (below[0] + above[0])
    return proposed
