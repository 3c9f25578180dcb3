"""Formats that the package gmsh reads for us, and files of second order as Gmsh writes them."""

import subprocess
import sys

import numpy as np
import pytest

from anistar import formats
from anistar.base.errors import FormatError
from anistar.formats.gmsh import converter
from anistar.meshes.validation import validate

MODEL = """
import sys
import gmsh

gmsh.initialize(interruptible=False)
gmsh.option.setNumber("General.Terminal", 0)
order, *paths = sys.argv[1:]
model = gmsh.model.occ
disk = model.addDisk(0, 0, 2, 1, 1)
hole = model.addDisk(0, 0, 2, 0.4, 0.4)
model.cut([(2, disk)], [(2, hole)])
model.synchronize()
gmsh.model.addPhysicalGroup(2, [1], name="ring")
for _, curve in gmsh.model.getEntities(1):
    is_outer = gmsh.model.getBoundingBox(1, curve)[3] > 0.9
    gmsh.model.addPhysicalGroup(1, [curve], name="outer" if is_outer else "inner")
gmsh.option.setNumber("Mesh.MeshSizeMin", 0.35)
gmsh.option.setNumber("Mesh.MeshSizeMax", 0.35)
gmsh.model.mesh.generate(2)
gmsh.model.mesh.setOrder(int(order))
for path in paths:
    gmsh.write(path)
"""
NAMED = (".msh", ".med", ".unv", ".cgns")
ALL = (*NAMED, ".bdf", ".inp", ".mesh", ".vtk", ".su2")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with a ring of first and of second order in every format."""
    pytest.importorskip("gmsh", exc_type=ImportError)
    folder = tmp_path_factory.mktemp("ring")
    for order in (1, 2):
        paths = [str(folder / f"ring{order}{suffix}") for suffix in ALL]
        subprocess.run([sys.executable, "-c", MODEL, str(order), *paths], check=True)
    return folder


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("suffix", ALL)
def test_a_ring_of_gmsh_is_read_from_every_format(folder, suffix, order):
    mesh, _, report = formats.read_with_report(folder / f"ring{order}{suffix}")
    assert (mesh.dim, mesh.z) == (2, 0.0 if suffix == ".su2" else 2.0)
    assert len(np.unique(mesh.facet_tags)) == (1 if suffix == ".vtk" else 2)
    if suffix in NAMED:
        inner = np.unique(mesh.facets_of("inner"))
        assert np.allclose(np.linalg.norm(mesh.points[inner], axis=1), 0.4)
        assert mesh.region("ring").all()
    assert (report.geometry is None) == (order == 1)
    if order == 2:
        radii = np.linalg.norm(report.geometry.points[report.geometry.facets], axis=2)
        assert np.allclose(np.minimum(np.abs(radii - 1), np.abs(radii - 0.4)), 0, atol=1e-5)
    assert validate(mesh) == []


def test_what_gmsh_does_not_get_through_is_refused(tmp_path):
    pytest.importorskip("gmsh", exc_type=ImportError)
    for name in ("m.unv", "m.cgns"):
        (tmp_path / name).write_text("no mesh\n")
        with pytest.raises(FormatError, match=name):
            formats.read(tmp_path / name)


def test_without_gmsh_the_message_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setattr(converter, "_PROGRAM", f"raise SystemExit({converter._MISSING})")
    (tmp_path / "m.unv").write_text("")
    with pytest.raises(FormatError, match=r"read by the package gmsh, which is missing: .*gmsh"):
        formats.read(tmp_path / "m.unv")
