"""The exact topology of small results, kept as text.

``pytest tests/remesh/test_golden.py --refresh-golden`` writes the files anew; look at the
difference before you commit it.
"""

from pathlib import Path

import numpy as np
import pytest
from meshes import l_shape, slit, square, two_regions
from shapes import arc_metric, rotating_metric, target, uniform

from anistar import remesh, validate

FOLDER = Path(__file__).parent / "golden"


def l_shaped_corner():
    mesh = l_shape(4)
    return mesh, uniform(mesh, 0.6)


def square_layer():
    mesh = square(20)
    return mesh, arc_metric(mesh, 25)


def turning_interface():
    mesh = two_regions(8)
    return mesh, rotating_metric(mesh, 25)


def slit_square():
    mesh = slit(8)
    return mesh, uniform(mesh, 0.24)


def ring_and_core():
    mesh = target(16)
    return mesh, uniform(mesh, 0.4)


CASES = [l_shaped_corner, square_layer, turning_interface, slit_square, ring_and_core]


def topology(mesh):
    """Cells from their smallest point on, facets from their smaller one, each with its tag."""
    first = np.argmin(mesh.cells, axis=1)
    turned = np.stack([np.roll(cell, -k) for cell, k in zip(mesh.cells, first, strict=True)])
    lines = [f"points {mesh.n_points}"]
    for kind, rows, tags in (
        ("cell", turned, mesh.cell_tags),
        ("facet", np.sort(mesh.facets, axis=1), mesh.facet_tags),
    ):
        table = sorted(zip(rows.tolist(), tags.tolist(), strict=True))
        lines += [f"{kind} {' '.join(map(str, row))} tag {tag}" for row, tag in table]
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize("case", CASES)
def test_the_topology_is_the_one_on_file(case, request):
    mesh, M = case()
    done = remesh(mesh, M)
    assert validate(done.mesh, mesh, tolerance=0.1) == []
    path = FOLDER / f"{case.__name__}.txt"
    if request.config.getoption("--refresh-golden"):
        path.write_text(topology(done.mesh), encoding="utf-8")
    assert topology(done.mesh) == path.read_text(encoding="utf-8")
