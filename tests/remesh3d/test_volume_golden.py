"""Counts and a digest of the topology of small 3D results, kept as text.

``pytest tests/remesh3d/test_volume_golden.py --refresh-golden`` writes the files anew; look at the
difference before you commit it.
"""

import hashlib
from pathlib import Path

import numpy as np
import pytest
from meshes import cube, two_region_cube
from remesh3d.domains import cube_with_sheet, layer, rotated, turning, uniform
from remesh3d.test_curved import cylinder

from anistar import RemeshOptions, remesh, validate

FOLDER = Path(__file__).parent / "golden"


def cube_layer():
    mesh = cube(4)
    return mesh, layer(mesh)


def turning_regions():
    mesh = rotated(two_region_cube(4))
    return mesh, turning(mesh)


def sheet():
    mesh = cube_with_sheet()
    return mesh, uniform(mesh, 0.2)


def round_cylinder():
    mesh = cylinder()
    return mesh, uniform(mesh, 0.4)


CASES = [cube_layer, turning_regions, sheet, round_cylinder]


def summary(mesh):
    """How many simplices every tag has, and a digest of them all in a canonical order."""
    lines = [f"points {mesh.n_points}"]
    digest = hashlib.sha256()
    for kind, rows, tags in (
        ("cell", mesh.cells, mesh.cell_tags),
        ("facet", mesh.facets, mesh.facet_tags),
        ("edge", mesh.edges, mesh.edge_tags),
    ):
        for tag, count in zip(*np.unique(tags, return_counts=True), strict=True):
            lines.append(f"{kind} tag {tag} count {count}")
        table = np.column_stack([np.sort(rows, axis=1), tags]).astype("<i4")
        digest.update(table[np.lexsort(table.T[::-1])].tobytes())
    return "\n".join([*lines, f"topology {digest.hexdigest()}"]) + "\n"


@pytest.mark.parametrize("case", CASES)
def test_the_topology_of_the_volume_is_the_one_on_file(case, request):
    mesh, M = case()
    done = remesh(mesh, M, RemeshOptions(agreement=False))
    assert validate(done.mesh, mesh, tolerance=0.1) == []
    path = FOLDER / f"{case.__name__}.txt"
    if request.config.getoption("--refresh-golden"):
        path.write_text(summary(done.mesh), encoding="utf-8")
    assert summary(done.mesh) == path.read_text(encoding="utf-8")
