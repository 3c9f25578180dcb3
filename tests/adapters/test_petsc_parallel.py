"""anistar as PETSc's adaptor on two processes."""

import sys
from pathlib import Path

import pytest

pytest.importorskip("anistar.adapters.petsc", reason="no petsc4py for Python 3.11")

from plexes import run

PARALLEL = """
import sys, warnings
import numpy as np
import meshes
from plexes import completed, measures
from anistar.adapters import petsc
from anistar.adapters.petsc import PETSc, adaptor, gather, plex as conversion

make, n, kind = sys.argv[1:]
comm = PETSc.COMM_WORLD
petsc.register()
PETSc.Options()["dm_adaptor"] = "anistar"
mesh, labels = petsc.from_dmplex(completed(getattr(meshes, make)(int(n))))
plex = conversion.plex_of(mesh if comm.rank == 0 else None, labels, comm, mesh.dim)
plex.distribute()
plex.metricSetGradationFactor(1.0)
plex.metricSetIsotropic(kind == "isotropic")
if kind == "uniform":
    metric = plex.metricCreateUniform(100.0)
else:
    x = plex.getCoordinatesLocal().getArray().reshape(-1, mesh.dim)[:, 0]
    sizes = (0.08 + 0.1 * abs(x - 0.5)) ** -2
    tensor = 1.0 if kind == "isotropic" else np.eye(mesh.dim).ravel()
    metric = plex.metricCreate()
    metric.setArray(np.multiply.outer(sizes, tensor).ravel())
adaptor._LARGE = 10
with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always")
    new = plex.adaptMetric(metric, "Face Sets", "Cell Sets")
warned = [str(w.message) for w in caught if "adapted on one of 2 processes" in str(w.message)]
plex.metricSetGradationFactor(1.05)
graded = plex.adaptMetric(metric)
metric.set(-1.0)
try:
    plex.adaptMetric(metric)
except PETSc.Error as error:
    failed = "not positive definite" in str(error)
counts = [end - start for start, end in (new.getHeightStratum(0), graded.getHeightStratum(0))]
def on_first(distributed):
    vertices = np.subtract(*distributed.getDepthStratum(0)[::-1])
    whole, _ = gather.gathered(distributed, np.zeros((vertices, mesh.dim, mesh.dim)))
    return petsc.plex.read_plex(whole) if comm.rank == 0 else None
after = on_first(new)
plex.distributeOverlap(1)
try:
    plex.adaptMetric(metric)
except PETSc.Error as error:
    refused = "has an overlap" in str(error)
told = comm.tompi4py().gather((counts, len(warned), failed, refused))
if comm.rank == 0:
    before, found = measures(mesh, labels), measures(*after)
    shares, warnings_, failures, refusals = zip(*told)
    totals = np.sum(shares, axis=0)
    print(
        min(share[0] for share in shares) > 0.3 * totals[0],
        totals[1] > totals[0] if kind != "uniform" else totals[1] == totals[0],
        before.keys() == found.keys() and all(abs(before[k] - found[k]) < 1e-9 for k in before),
        after[1].completed == labels.completed and after[1].names == labels.names,
        warnings_, all(failures), all(refusals),
    )
"""


@pytest.mark.parametrize(
    ("make", "n", "kind"),
    [
        ("two_regions", 6, "full"),
        ("two_region_cube", 2, "full"),
        ("slit", 6, "isotropic"),
        ("cube", 2, "uniform"),
    ],
)
def test_a_distributed_dmplex_is_gathered_adapted_and_distributed_again(tmp_path, make, n, kind):
    program = tmp_path / "parallel.py"
    program.write_text(PARALLEL)
    mpiexec = Path(sys.executable).with_name("mpiexec")
    shown = run(mpiexec, "-n", "2", sys.executable, program, make, str(n), kind)
    assert shown == "True True True True (1, 0) True True\n"
