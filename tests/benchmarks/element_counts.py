"""Compare the mesh that `estimate` and `predicted_error` expect with the one that `remesh` makes.

usage: python tests/benchmarks/element_counts.py [--elements 1000,5000] [--passes 3]

Each row is the last of some adaptations of one field to a number of elements: the count and the
vertices over what was expected, and the L2 interpolation error over what was predicted.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from anistar.judging.interpolation_error import l2_error
from anistar.meshes.mesh import Mesh
from anistar.meshes.validation import validate
from anistar.metric import MetricOptions, from_fields
from anistar.remeshing.remesh import remesh

Array = NDArray[np.float64]


def arc(steepness: float) -> Callable[[Array], Array]:
    """Return a layer along an arc of a circle."""
    return lambda x: np.tanh(steepness * (np.linalg.norm(x + 0.3, axis=1) - 1.1))


FIELDS: dict[str, Callable[[Array], Array]] = {
    "arc 20": arc(20.0),
    "arc 60": arc(60.0),
    "waves": lambda x: np.sin(6 * x[:, 0]) * np.cos(5 * x[:, 1]),
    "corner": lambda x: ((x**2).sum(axis=1) + 1e-6) ** 0.33,
    "paraboloid": lambda x: (x**2).sum(axis=1),
    "wall": lambda x: np.exp(-x[:, 0] / 0.01) + 0.1 * x[:, 1] ** 2,
}


def square(n: int) -> Mesh:
    """Return the unit square in 2 n^2 triangles."""
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
    i, j = (index.ravel() for index in np.meshgrid(np.arange(n), np.arange(n)))
    a = j * (n + 1) + i
    cells = [np.stack([a, a + 1, a + n + 2], 1), np.stack([a, a + n + 2, a + n + 1], 1)]
    return Mesh(points=np.stack([x.ravel(), y.ravel()], 1), cells=np.concatenate(cells))


def adapted(field: str, elements: float, passes: int) -> tuple[int, float, float, float]:
    """Return the count, and count, vertices and error over what was expected of them."""
    mesh, f = square(12), FIELDS[field]
    for _ in range(passes):
        options = MetricOptions(target_elements=elements)
        M, ledger = from_fields(mesh, {"u": f(mesh.points)}, options)
        mesh = remesh(mesh, M).mesh
    assert validate(mesh) == []
    return (
        mesh.n_cells,
        mesh.n_cells / ledger.estimate.elements,
        mesh.n_points / ledger.estimate.vertices,
        l2_error(mesh, f(mesh.points), f) / ledger.predicted_error["u"],
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--elements", default="1000,5000")
    parser.add_argument("--passes", type=int, default=3)
    arguments = parser.parse_args()
    table = Table("field", "cells", "cells / expected", "points / expected", "error / predicted")
    for field in FIELDS:
        for elements in map(float, arguments.elements.split(",")):
            count, *ratios = adapted(field, elements, arguments.passes)
            table.add_row(field, str(count), *(f"{ratio:.3f}" for ratio in ratios))
    Console().print(table)


if __name__ == "__main__":
    main()
