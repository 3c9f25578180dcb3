"""Whole files of every format that is read, each with what is beside it."""

import tempfile
from functools import cache
from pathlib import Path

import meshio
import numpy as np
from foreign_files import GMSH, MESHIO, gmsh_4, sample, write_with_meshio
from formats.test_element_kinds import of_second_order
from meshes import square, two_region_cube, two_regions

from anistar import Field, formats

OWN = (".mesh", ".meshb", ".msh", ".vtu", ".vtk", ".xdmf", ".su2", ".pvd")
WITHOUT_FIELDS = (".su2",)
ABAQUS = """*HEADING
two triangles and a line
*NODE
1, 0, 0
2, 1, 0
3, 1, 1
4, 0, 1
*ELEMENT, TYPE=CPS3, ELSET=lower
1, 1, 2, 3
*ELEMENT, TYPE=CPS3, ELSET=upper
2, 1, 3, 4
*ELEMENT, TYPE=T2D2, ELSET=wall
3, 1, 2
"""
LEGACY_VTK = """# vtk DataFile Version 4.2
with all that is no field
ASCII

DATASET UNSTRUCTURED_GRID
FIELD FieldData 1
meta 1 1 string
hello%20world

POINTS 4 double
0 0 0 1 0 0 1 1 0 0 1 0
CELLS 2 8
3 0 1 2
3 0 2 3
CELL_TYPES 2
5
5
CELL_DATA 2
GLOBAL_IDS ids vtkIdType
0 1
FIELD FieldData 2
some%20words 1 2 string
one
two
bits 1 2 bit
0 1
POINT_DATA 4
COLOR_SCALARS rgb 3
0 .5 1 0 .5 1 0 .5 1 0 .5 1
VECTORS v double
0 0 0 1 0 0 1 1 0 0 1 0
TEXTURE_COORDINATES places 2 double
0 0 1 0 1 1 0 1
"""


@cache
def seeds():
    """Pairs of a name and the files by their names; the first is the one that is read."""
    with tempfile.TemporaryDirectory() as folder:
        found = [*_own(Path(folder)), *_foreign(Path(folder))]
    by_hand = [("inp", {"m.inp": ABAQUS.encode()}), ("vtk by hand", {"m.vtk": LEGACY_VTK.encode()})]
    return [*found, *by_hand]


def _own(folder):
    for mesh in (square(1), two_regions(2), two_region_cube(1)):
        on_points, on_cells = sample(mesh)
        tensors = np.eye(mesh.dim) * (1 + mesh.points[:, :1, None])
        fields = {**on_points, "M": tensors, "k": Field(on_cells["k"], "cells")}
        for suffix in OWN:
            given = None if suffix in WITHOUT_FIELDS else fields
            formats.write(folder / f"m{suffix}", mesh, given)
            yield f"own {suffix} {mesh.n_cells} cells", _taken(folder, suffix)


def _foreign(folder):
    mesh = two_regions(2)
    for kind, (suffix, _) in MESHIO.items():
        write_with_meshio(folder / f"m{suffix}", mesh, kind)
        yield kind, _taken(folder, suffix)
    for kind in GMSH:
        yield f"gmsh {kind}", {"m.msh": gmsh_4(mesh, kind)}
    for suffix in (".vtu", ".vtk", ".mesh", ".xdmf"):
        _mixed().write(
            folder / f"m{suffix}", **({"data_format": "XML"} if suffix == ".xdmf" else {})
        )
        yield f"all kinds in {suffix}", _taken(folder, suffix)
    of_second_order(mesh, lambda x: x + 0.01).write(folder / "m.vtu")
    yield "second order", _taken(folder, ".vtu")


def _mixed():
    """A hexahedron with a pyramid below and a prism beside it, and quadrilaterals on it."""
    box = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    points = np.array([*box, (0.5, 0.5, -1), (2, 0, 0), (2, 0, 1)], float)
    cells = [
        ("hexahedron", [range(8)]),
        ("pyramid", [[3, 2, 1, 0, 8]]),
        ("wedge", [[1, 9, 2, 5, 10, 6]]),
        ("quad", [[4, 5, 6, 7], [0, 3, 7, 4]]),
    ]
    return meshio.Mesh(points, cells, point_data={"u": points[:, 0]})


def _taken(folder, suffix):
    """The files in a folder, that of the suffix first; the folder is empty then."""
    paths = sorted(folder.iterdir(), key=lambda path: path.suffix != suffix)
    files = {path.name: path.read_bytes() for path in paths}
    for path in paths:
        path.unlink()
    return files
