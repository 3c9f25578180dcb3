"""Measure how the intersection of three metrics depends on their order, and what John's saves.

usage: python tests/benchmarks/order_of_intersections.py [--points 2000]

Metrics have random axes and sizes spread evenly, in logarithm, over some decades. The excess of an
order is its complexity over that of the largest ellipsoid inside all three, the spread is the
ratio of the complexities of the worst and the best of the three orders, point by point.
"""

from __future__ import annotations

import argparse

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from anistar.metric import intersected

Array = NDArray[np.float64]

ORDERS = ((0, 1, 2), (1, 2, 0), (0, 2, 1))
DECADES = (1.0, 2.0, 4.0)


def random_metrics(n: int, dim: int, decades: float, rng: np.random.Generator) -> Array:
    """Return metrics (n, d, d) whose sizes are spread over some decades."""
    axes = np.linalg.qr(rng.normal(size=(n, dim, dim)))[0]
    values = 10.0 ** rng.uniform(-decades, decades, (n, dim))
    M = np.einsum("nij,nj,nkj->nik", axes, values, axes)
    return np.asarray(0.5 * (M + M.transpose(0, 2, 1)))


def measured(n: int, dim: int, decades: float) -> tuple[float, float, float, float]:
    """Return the mean and largest excess, and the mean and largest spread of the orders."""
    rng = np.random.default_rng(0)
    metrics = [random_metrics(n, dim, decades, rng) for _ in range(3)]
    least = density(intersected(*metrics, rule="john"))
    each = np.stack([density(intersected(*(metrics[i] for i in order))) for order in ORDERS])
    excess, spread = each / least, each.max(axis=0) / each.min(axis=0)
    return float(excess.mean()), float(excess.max()), float(spread.mean()), float(spread.max())


def density(M: Array) -> Array:
    """Square root of the determinant (n,), by its logarithm."""
    return np.asarray(np.exp(0.5 * np.linalg.slogdet(M)[1]))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=int, default=2000)
    n = parser.parse_args().points
    table = Table("dim", "decades of size", "mean excess", "largest", "mean spread", "largest")
    for dim in (2, 3):
        for decades in DECADES:
            figures = (f"{figure:.3f}" for figure in measured(n, dim, decades))
            table.add_row(str(dim), f"{decades:g}", *figures)
    Console().print(table)


if __name__ == "__main__":
    main()
