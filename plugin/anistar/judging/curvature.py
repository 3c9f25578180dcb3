"""How curved the surfaces of a 3D mesh are."""

from __future__ import annotations

from .. import _core
from ..base.arrays import Floats
from ..meshes.mesh import Mesh
from ..meshes.mesh_arrays import mesh_arrays


def surface_curvature(mesh: Mesh, *, ridge_angle: float = 45.0) -> Floats:
    """Return the curvature tensors of the boundary and the interfaces at the points.

    Parameters
    ----------
    mesh : Mesh
        A 3D mesh; its facets are taken as samples of smooth patches between ridges.
    ridge_angle : float
        Degrees; a sharper turn between two facets is a ridge.

    Returns
    -------
    (n, 3, 3) float64
        The principal curvatures, in 1 / length, with their directions: ``k1 t1 t1^T + k2 t2 t2^T``
        of the most curved patch at the point; 0 at points that are on no facet. The sign depends
        on the orientation of the facets.

    Raises
    ------
    ValueError
        If the mesh is not 3D.

    References
    ----------
    .. [1] Cazals and Pouget, Estimating differential quantities using polynomial fitting of
       osculating jets, 2005.

    Examples
    --------
    >>> import anistar
    >>> from anistar.judging.curvature import surface_curvature
    >>> corner = anistar.Mesh(points=[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
    ...                       cells=[[0, 1, 2, 3]])
    >>> surface_curvature(corner).any()  # a tetrahedron has flat faces
    np.False_
    """
    if mesh.dim != 3:
        raise ValueError(f"surfaces have a curvature in 3D; this mesh has dimension {mesh.dim}")
    surface = smooth_surface(mesh, ridge_angle=ridge_angle)
    return surface.curvature(mesh.n_points)


def smooth_surface(mesh: Mesh, *, ridge_angle: float = 45.0) -> _core.Surface3:
    """Return the smooth surfaces and ridges that `remesh` puts through the facets of a mesh.

    Parameters
    ----------
    mesh : Mesh
        A 3D mesh.
    ridge_angle : float
        Degrees; a sharper turn between two facets is a ridge.

    Returns
    -------
    Surface3
        Its ``project(points, tag)`` gives the feet of points on the surfaces with a tag and the
        unit normals there, ``project_on_ridge(points, tag)`` those on ridges (tag None: those that
        an angle or a change of tags makes).
    """
    shape = _core.DomainShape()
    shape.ridge_angle = ridge_angle
    return _core.Surface3(mesh_arrays(mesh), shape)
