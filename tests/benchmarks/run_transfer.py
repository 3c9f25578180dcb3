"""Time the transfer of a scalar field between two large meshes, in CPU seconds.

usage: python tests/benchmarks/run_transfer.py [--dim 2|3] [--cells 200000] [--threads 1]

Both meshes are grids whose inner points are moved at random, with slightly different numbers of
points, so that no cells coincide.
"""

from __future__ import annotations

import argparse
import resource
import time

import numpy as np
from rich.console import Console
from rich.table import Table

from anistar.meshes.mesh import Mesh
from anistar.meshes.validation import validate
from anistar.transfer import METHODS, TransferOptions, transfer

# Tetrahedra of a box around its diagonal, as orders in which the axes are taken.
ORDERS = ((0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2))
# How far points are moved, relative to the spacing.
JITTER = 0.15


def grid(dim: int, n: int, seed: int) -> Mesh:
    """Return the unit square or cube in ``2 n^2`` or ``6 n^3`` cells, inner points moved."""
    axes = np.meshgrid(*[np.linspace(0, 1, n + 1)] * dim, indexing="ij")
    points = np.stack([axis.ravel() for axis in axes], axis=1)
    at = np.arange((n + 1) ** dim).reshape((n + 1,) * dim)
    orders = ORDERS if dim == 3 else ((0, 1), (1, 0))
    even = ORDERS[:3] if dim == 3 else ((0, 1),)
    cells = []
    for order in orders:
        steps = np.zeros((dim + 1, dim), int)
        for row, axis in enumerate(order, start=1):
            steps[row:, axis] = 1
        corners = [at[tuple(slice(s, s + n) for s in step)].ravel() for step in steps]
        if order not in even:
            corners[-1], corners[-2] = corners[-2], corners[-1]
        cells.append(np.stack(corners, axis=1))
    inner = np.all((points > 0.5 / n) & (points < 1 - 0.5 / n), axis=1)
    moves = np.random.default_rng(seed).uniform(-JITTER / n, JITTER / n, (int(inner.sum()), dim))
    points[inner] += moves
    return Mesh(points=points, cells=np.concatenate(cells))


def u(x: np.ndarray) -> np.ndarray:
    """Return a steep front."""
    return np.asarray(np.tanh(30 * (np.linalg.norm(x, axis=1) - 0.8)))


def timed(source: Mesh, target: Mesh, method: str, threads: int) -> tuple[float, float, float]:
    """Return wall seconds, CPU seconds and the relative change of the integral."""
    options = TransferOptions(method=method, threads=threads)
    wall, started = time.perf_counter(), time.process_time()
    report = transfer(source, {"u": u(source.points)}, target, options).report
    seconds = time.process_time() - started
    before, after = report.changes["u"].integral
    return time.perf_counter() - wall, seconds, abs(after[0] / before[0] - 1)


def main(arguments: list[str] | None = None) -> Table:
    """Print and return the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--dim", type=int, default=2, choices=(2, 3))
    parser.add_argument("--cells", type=int, default=200_000)
    parser.add_argument("--threads", type=int, default=1)
    chosen = parser.parse_args(arguments)
    per_box = {2: 2, 3: 6}[chosen.dim]
    n = max(2, round((chosen.cells / per_box) ** (1 / chosen.dim)))
    source, target = grid(chosen.dim, n, 1), grid(chosen.dim, n + 1, 2)
    assert not validate(source)
    assert not validate(target)
    table = Table(title=f"{source.n_cells} cells to {target.n_cells}, {chosen.threads} threads")
    for heading in ("method", "wall s", "CPU s", "change of the integral", "peak memory MB"):
        table.add_column(heading, justify="right")
    for method in METHODS:
        wall, seconds, change = timed(source, target, method, chosen.threads)
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        table.add_row(method, f"{wall:.2f}", f"{seconds:.2f}", f"{change:.1e}", f"{peak:.0f}")
    Console().print(table)
    return table


if __name__ == "__main__":
    main()
