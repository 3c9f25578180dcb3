"""The objects that users hold: meshes of other packages, read as `Mesh` and made of one."""

from ..metric.base.mesh import AnyMesh
from .forms import Content, Form, as_geometry, as_mesh, form_names, opened, register, values_of
from .making import made, made_apart
from .metrics import metric_in, metric_on

__all__ = [
    "AnyMesh",
    "Content",
    "Form",
    "as_geometry",
    "as_mesh",
    "form_names",
    "made",
    "made_apart",
    "metric_in",
    "metric_on",
    "opened",
    "register",
    "values_of",
]
