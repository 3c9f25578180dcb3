"""Measure the recovery methods: errors and observed orders on families of meshes.

usage: python recovery_table.py [--space P1|P2|P0] [--markdown FILE]

The relative error of the Hessian is measured in coordinates in which cells are round, in the
root mean square and in the maximum, inside and on the boundary apart. The order is that of the
last halving of the size.
"""

import argparse
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from recovery_cases import MESHES, SIZES, field, mesh_points, on_boundary, stretch

from anistar import metric

METHODS = {
    "quadratic": {},
    "l2": {},
    "l2 consistent": {"mass": "consistent"},
    "mixed_l2": {},
    "zz": {},
    "clement": {},
    "green": {},
    "auto": {},
}


def samples(mesh, x, factors, space):
    """Values of the field in a space: cell means by a quadrature that is exact to degree 2."""
    if space == "P1":
        return field(x)[0]
    if space == "P2":
        return field(metric.p2_nodes(mesh) / factors)[0]
    corners = x[mesh.cells]
    middle = corners.mean(axis=1, keepdims=True)
    d = x.shape[1]
    reach = 1.0 / np.sqrt(d + 2.0)
    return np.mean([field((middle + reach * (corners - middle))[:, c])[0] for c in range(d + 1)], 0)


def errors(method, name, n, dim, space="P1", quantity="hessian"):
    """Relative errors (inside rms, inside max, boundary rms, boundary max)."""
    x, cells = mesh_points(name, n, dim)
    factors = stretch(name, dim)
    mesh = SimpleNamespace(
        points=x * factors,
        cells=cells,
        cell_tags=np.zeros(len(cells), np.int32),
        facets=np.zeros((0, dim), np.int32),
        facet_tags=np.zeros(0, np.int32),
    )
    _, gradient, H = field(x)
    options = {"method": method.split()[0], "space": space, **METHODS[method]}
    u = samples(mesh, x, factors, space)
    if quantity == "hessian":
        found, exact = metric.recover_hessian(mesh, u, **options), H
        found = found * factors[:, None] * factors
    else:
        found, exact = metric.recover_gradient(mesh, u, **options) * factors, gradient
    axes = tuple(range(1, exact.ndim))
    error = np.sqrt(((found - exact) ** 2).sum(axis=axes))
    size = np.sqrt(np.mean((exact**2).sum(axis=axes)))
    edge = on_boundary(n, dim)
    parts = (error[~edge], error[edge])
    return [f(part) / size for part in parts for f in (_rms, np.max)]


def _rms(values):
    return np.sqrt(np.mean(values**2))


def study(method, name, dim, space="P1", quantity="hessian", sizes=None):
    """Errors on the finest mesh and observed orders, each in the order of `errors`."""
    sizes = sizes or SIZES[dim]
    table = np.array([errors(method, name, n, dim, space, quantity) for n in sizes[-2:]])
    orders = np.log(table[0] / table[1]) / np.log(sizes[-1] / sizes[-2])
    return table[1], orders


def rows(dims, space, quantity):
    for dim in dims:
        for name in MESHES:
            for method in METHODS:
                error, order = study(method, name, dim, space, quantity)
                cells = [f"{e:.1e} ({o:.1f})" for e, o in zip(error, order, strict=True)]
                yield [f"{dim}D {name}", method, *cells]


def markdown(table):
    head = ["mesh", "method", "inside, rms", "inside, max", "boundary, rms", "boundary, max"]
    lines = [head, ["---"] * len(head), *table]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--space", default="P1", choices=("P1", "P2", "P0"))
    parser.add_argument("--quantity", default="hessian", choices=("hessian", "gradient"))
    parser.add_argument("--dim", type=int, action="append")
    parser.add_argument("--markdown", type=Path)
    arguments = parser.parse_args()
    table = markdown(list(rows(arguments.dim or (2, 3), arguments.space, arguments.quantity)))
    print(table)
    if arguments.markdown:
        arguments.markdown.write_text(table, encoding="utf-8")


if __name__ == "__main__":
    main()
