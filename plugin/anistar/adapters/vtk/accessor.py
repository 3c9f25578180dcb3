"""The accessor that PyVista's data sets get: ``grid.anistar.adapt("u", target_complexity=1e4)``."""

from __future__ import annotations

from typing import Any

import pyvista
from numpy.typing import ArrayLike

from ...base.arrays import Floats
from ...judging.certificate import Certificate, certify
from ...loops.adapt import adapt
from ...meshes.mesh import Mesh
from ...meshes.validation import validate
from ...meshes.violations import Violation
from ...metric import from_fields
from ...metric.base.given import AnyFields
from ...objects import AnyMesh, as_mesh
from ...remeshing.remesh import remesh
from ...transfer import transfer


class DataSetAccessor:
    """What anistar does with one data set; results are data sets with their fields.

    Parameters
    ----------
    dataset : pyvista.DataSet
        Of triangles or tetrahedra.
    """

    def __init__(self, dataset: Any) -> None:
        self._dataset = dataset

    @property
    def mesh(self) -> Mesh:
        """The data set as a `Mesh`."""
        return as_mesh(self._dataset)

    def adapt(self, fields: AnyFields = None, **settings: Any) -> Any:
        """Return the data set adapted to its fields, see `anistar.adapt`."""
        return adapt(self._dataset, fields, like=self._dataset, **settings)

    def remesh(self, M: ArrayLike | str = "metric", **settings: Any) -> Any:
        """Return a data set with unit edges in a metric, see `anistar.remesh`."""
        return remesh(self._dataset, M, like=self._dataset, **settings)

    def metric(self, fields: AnyFields = None, **settings: Any) -> Floats:
        """Return the metric (n, d, d) that the fields ask for, see `anistar.metric.from_fields`."""
        return from_fields(self._dataset, fields, **settings)[0]

    def certify(self, M: ArrayLike | str = "metric", **settings: Any) -> Certificate:
        """Return the certificate of the data set in a metric, see `anistar.certify`."""
        return certify(self._dataset, M, **settings)

    def validate(self) -> list[Violation]:
        """Return what is wrong with the data set, see `anistar.validate`."""
        return validate(self._dataset)

    def transfer(self, target: AnyMesh, fields: AnyFields = None, **settings: Any) -> Any:
        """Return the target, as a data set, with the fields of this one, see `anistar.transfer`."""
        return transfer(self._dataset, fields, target, like="pyvista", **settings)


# An older one than the extra asks for may be there, and goes without.
if hasattr(pyvista, "register_dataset_accessor"):
    pyvista.register_dataset_accessor("anistar", pyvista.DataSet)(DataSetAccessor)
