"""CPU time and memory of the recovery on a Kuhn mesh of a box in 3D.

usage: python recovery_speed.py [--points 1000000] METHOD ...
"""

import argparse
import resource
import time
from types import SimpleNamespace

import numpy as np
from recovery_cases import cells_of_box

from anistar import metric


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("methods", nargs="*", default=["l2", "quadratic"])
    parser.add_argument("--points", type=int, default=1_000_000)
    arguments = parser.parse_args()
    n = round(arguments.points ** (1 / 3)) - 1
    axes, cells = cells_of_box(n, 3)
    mesh = SimpleNamespace(
        points=axes / n,
        cells=cells,
        cell_tags=np.zeros(len(cells), np.int32),
        facets=np.zeros((0, 3), np.int32),
        facet_tags=np.zeros(0, np.int32),
    )
    u = np.tanh(10 * (np.linalg.norm(mesh.points, axis=1) - 0.7))
    print(f"{len(mesh.points)} points, {len(cells)} cells, {_peak():.0f} MB")
    for method in arguments.methods:
        start = time.process_time()
        metric.recover_hessian(mesh, u, method=method)
        print(f"{method:10s} {time.process_time() - start:6.1f} s CPU, peak {_peak():.0f} MB")


def _peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


if __name__ == "__main__":
    main()
