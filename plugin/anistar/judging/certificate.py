"""The certificate: which simplices and stars of a mesh are anisotropic Delaunay."""

from __future__ import annotations

import math
import operator
from dataclasses import InitVar, dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Bools, Floats
from ..base.core_errors import meshing_errors
from ..base.progress import task
from ..base.report import as_builtin
from ..meshes.mesh import Mesh
from ..meshes.plotted import Plotted, Subject
from ..metric import check_metric
from ..metric.base.told import Told
from ..objects import AnyMesh, metric_on
from .metric_mesh import Bytes, MetricMesh, Proof, SurfaceMesh, keep_proof, kept_proof
from .skin import Shape, Skin

Count = tuple[int, int]
"""How many, of how many."""


@dataclass(frozen=True, slots=True, eq=False)
class _Judged:
    """What a certificate was made of, and what was found first."""

    surface: SurfaceMesh
    proof: Proof
    threads: int

    @property
    def mesh(self) -> MetricMesh:
        return self.surface.mesh

    @property
    def bits(self) -> Bytes:
        return self.proof.delaunay

    def delaunay(self) -> Bools:
        corners = np.arange(self.mesh.cells.shape[1], dtype=np.uint8)
        return (self.bits[:, None] >> corners & 1).astype(bool)

    def simplex_ok(self) -> Bools:
        return np.asarray(self.bits == (1 << self.mesh.cells.shape[1]) - 1)

    def star_ok(self) -> Bools:
        ok = np.ones(len(self.mesh.points), dtype=bool)
        failing = ~self.simplex_ok()
        ok[self.mesh.cells[failing][~self.delaunay()[failing]]] = False
        return ok

    def in_surface_star(self) -> Bools:
        corners = np.arange(self.mesh.facets.shape[1], dtype=np.uint8)
        return (self.proof.surface[:, None] >> corners & 1).astype(bool)

    def surface_star_ok(self) -> Bools:
        ok = np.ones(len(self.mesh.points), dtype=bool)
        ok[self.mesh.facets[~self.in_surface_star()]] = False
        return ok


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Certificate(Plotted, Told):
    """What is Delaunay in a mesh, each simplex tested in the metrics of its vertices.

    A simplex is *Delaunay in a metric* when no vertex that it can reach lies strictly inside its
    circumscribed ellipsoid in that metric. It reaches the vertices of the cells that the open
    ellipsoid meets, walking from cell to cell and never across a boundary or constrained facet.

    A facet of the boundary or of an interface is in the *surface star* of its vertex v when it
    reaches no vertex strictly inside its surface ball: the ellipsoid in the metric of v through
    its vertices, centred on the surface ([1], section 7.1). It reaches from the cells on both
    sides of it. On a planar patch the surface is the plane of the facet. A curved one is taken
    for the quadratic over that plane which vanishes at the vertices and is as high over the
    middle of each edge as the circle that turns with the surface normals at its ends; the shift
    of the centre to it is rounded once, and the ellipsoid with this shift is decided exactly.

    Attributes
    ----------
    simplex_ok : (m,) bool
        Simplices that are Delaunay in the metrics of all their vertices: certified.
    star_ok : (n,) bool
        Vertices all of whose simplices are Delaunay in the metric of the vertex: certified.
    exempt : (n,) bool
        Vertices that fail and may: in the first shell of a corner below 30 degrees, at most 8
        for each corner. In 2D a corner is a vertex between two walls; in 3D an edge between two
        walls with that dihedral angle, or a vertex at which the walls leave less than the solid
        angle of a cone with that aperture.
    verdict : str
        One line with `simplex_ok`, `star_ok` and `surface_star_ok` by name, and the number of
        exempt vertices.
    delaunay : (m, d + 1) bool
        Whether a simplex is Delaunay in the metric of each of its vertices.
    surface_ok : (k,) bool
        Facets that are in the surface stars of all their vertices, in the order of
        ``mesh.facets``: certified.
    surface_star_ok : (n,) bool
        Vertices all of whose facets are in the surface star of the vertex. True at vertices of no
        facet. Whether the star has facets that the mesh has not is not asked.
    in_surface_star : (k, d) bool
        Whether a facet is in the surface star of each of its vertices.

    Notes
    -----
    The other figures are worked out when they are first looked at, of the mesh as it was when it
    was certified.

    References
    ----------
    .. [1] Boissonnat, Wormser, Yvinec, Anisotropic Delaunay Mesh Generation, INRIA research
       report 7712, second version, sections 2 and 3.
    .. [2] The same report, first version, section 3.
    """

    simplex_ok: Bools
    star_ok: Bools
    exempt: Bools
    verdict: str
    delaunay: Bools
    surface_ok: Bools
    surface_star_ok: Bools
    in_surface_star: Bools
    judged: InitVar[_Judged]

    def __post_init__(self, judged: _Judged) -> None:
        # not a field: those are what the certificate says
        object.__setattr__(self, "_judged", judged)

    def _subject(self) -> Subject:
        return Subject(
            mesh=self._of.surface.as_mesh(),
            metric=self._of.mesh.metric,
            certificate=self,
            colour="certificate",
        )

    def _figures(self) -> dict[str, Any]:
        return {
            "is_certified": self.is_certified,
            "star_ok": _fraction(self.star_ok),
            "simplex_ok": _fraction(self.simplex_ok),
            "surface_star_ok": "{} of {}".format(*self.surface_stars),
            "exempt": int(self.exempt.sum()),
        }

    @cached_property
    def distortion(self) -> Floats:
        """Largest distortion (n,) between the metric of a vertex and a neighbour's, at least 1."""
        with meshing_errors():
            return self._of.mesh.core().distortion(threads=self._of.threads)

    @cached_property
    def radius_edge(self) -> Floats:
        """Circumradius over shortest edge (m,), the largest that a metric of its vertices gives."""
        return self._circumspheres[0]

    @cached_property
    def sliverity(self) -> Floats:
        """``(volume / e**d)**(1 / d)`` (m,) with the shortest edge e.

        The smallest value that a metric of its vertices gives: 0 for a sliver, 0.49 for a regular
        tetrahedron, 0.66 for a triangle.
        """
        return self._circumspheres[1]

    @cached_property
    def stars_without_interfaces(self) -> Count:
        """Stars certified when the walk crosses interfaces too (not the boundary), of all."""
        core, threads = self._of.mesh.core(), self._of.threads
        with meshing_errors():
            bits = core.delaunay_across_interfaces(threads=threads)
        open_to_all = self._of
        if bits is not None:
            open_to_all = replace(open_to_all, proof=replace(self._of.proof, delaunay=bits))
        star_ok = open_to_all.star_ok()
        return int(star_ok.sum()), len(star_ok)

    @cached_property
    def restricted_v1(self) -> Count:
        """Simplices in the paper's restricted stars of all their vertices, and of how many.

        Of those whose circumcentre lies in the domain in the metrics of all vertices ([2],
        section 3).
        """
        return self._circumspheres[2]

    @cached_property
    def restricted_v2(self) -> Count:
        """Simplices in the paper's restricted stars of all their vertices, and of how many.

        Of those whose circumcentre lies in the domain in the metric of one vertex at least ([1],
        section 3).
        """
        return self._circumspheres[3]

    @property
    def _of(self) -> _Judged:
        judged: _Judged = self.__dict__["_judged"]
        return judged

    @cached_property
    def _circumspheres(self) -> tuple[Floats, Floats, Count, Count]:
        core, bits, threads = self._of.mesh.core(), self._of.bits, self._of.threads
        with meshing_errors():
            return core.circumspheres(delaunay=bits, threads=threads)

    @property
    def is_certified(self) -> bool:
        """Whether every star is certified or exempt; surface stars are judged apart."""
        return bool((self.star_ok | self.exempt).all())

    @property
    def surface_stars(self) -> Count:
        """Vertices of facets whose surface star is certified, and of how many."""
        on_facets = np.unique(self._of.mesh.facets)
        return int(self.surface_star_ok[on_facets].sum()), len(on_facets)

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins: the fractions, counts and extremes, without the arrays.

        ``simplex_ok``, ``star_ok``, ``surface_ok`` and ``surface_star_ok`` are fractions, the last
        one of the vertices of facets; ``n_exempt`` counts vertices, ``distortion_max``,
        ``radius_edge_max`` and ``sliverity_min`` are extremes; the pairs are
        ``[how many, of how many]``.
        """
        return {
            "verdict": self.verdict,
            "is_certified": self.is_certified,
            "simplex_ok": float(self.simplex_ok.mean()),
            "star_ok": float(self.star_ok.mean()),
            "simplices": [int(self.simplex_ok.sum()), len(self.simplex_ok)],
            "stars": [int(self.star_ok.sum()), len(self.star_ok)],
            "surface_ok": share_of(int(self.surface_ok.sum()), len(self.surface_ok)),
            "surface_star_ok": share_of(*self.surface_stars),
            "surface_facets": [int(self.surface_ok.sum()), len(self.surface_ok)],
            "surface_stars": list(self.surface_stars),
            "n_exempt": int(self.exempt.sum()),
            "distortion_max": as_builtin(self.distortion.max()),
            "radius_edge_max": as_builtin(self.radius_edge.max()),
            "sliverity_min": as_builtin(self.sliverity.min()),
            "stars_without_interfaces": list(self.stars_without_interfaces),
            "restricted_v1": list(self.restricted_v1),
            "restricted_v2": list(self.restricted_v2),
        }


def certify(
    mesh: AnyMesh,
    M: ArrayLike | str,
    *,
    threads: int = 1,
    shape: Shape = "smooth",
    ridge_angle: float = 45.0,
) -> Certificate:
    """Test every simplex, every star and every facet of a mesh, in exact arithmetic.

    Parameters
    ----------
    mesh : Mesh or other mesh object
        Its facets are the walls of the constrained definition.
    M : (n, d, d) array, (n,) sizes, one size, or name of a field of the object
        Metric at the points, in 1 / length**2.
    threads : int
        Threads to use; the certificate does not depend on it.
    shape : "smooth", "polyhedron" or "faceted"
        What the facets of the mesh mean to `surface_ok`, as in `RemeshOptions`: with
        the others every facet is judged by its own plane.
    ridge_angle : float
        Degrees, as in `RemeshOptions`.

    Returns
    -------
    Certificate

    Raises
    ------
    MetricError
        If a tensor is not symmetric positive definite; the point is named.
    ValueError
        If `threads` is below 1, or `shape` or `ridge_angle` is none.

    Notes
    -----
    What `remesh` has certified of its mesh is kept with it: for these very points, cells, facets
    and metric the answer is there already.

    Examples
    --------
    >>> import numpy as np, anistar
    >>> mesh = anistar.Mesh(points=[[0, 0], [1, 0], [1, 1], [0, 1]], cells=[[0, 1, 2], [0, 2, 3]])
    >>> anistar.certify(mesh, np.tile([[1.0, 0.5], [0.5, 1.0]], (4, 1, 1))).simplex_ok
    array([False, False])
    """
    threads = operator.index(threads)
    if threads < 1:
        raise ValueError(f"threads must be at least 1, got {threads}")
    mesh, M = metric_on(mesh, M)
    judged = _surface_mesh(mesh, M, Skin(shape=shape, ridge_angle=ridge_angle))
    proof = kept_proof(mesh, judged)
    if proof is None:
        with task("certify"):
            proof = Proof(judged.mesh.delaunay(threads), judged.delaunay(threads))
    return certificate_of(judged, proof, threads=threads)


def certify_and_keep(
    mesh: Mesh, M: ArrayLike, skin: Skin | None = None, *, threads: int = 1
) -> Certificate:
    """Return what `certify` does, which costs next to nothing from then on (see `keep_proof`)."""
    skin = skin or Skin()
    certificate = certify(mesh, M, threads=threads, shape=skin.shape, ridge_angle=skin.ridge_angle)
    keep_certificate(mesh, certificate)
    return certificate


def keep_certificate(mesh: Mesh, certificate: Certificate) -> None:
    """Keep what a certificate says of a mesh for as long as the mesh lives."""
    keep_proof(mesh, certificate._of.surface, certificate._of.proof)


def known_certificate(mesh: Mesh, M: ArrayLike) -> Certificate | None:
    """Return what `certify` does if it is known already, else None."""
    judged = _surface_mesh(mesh, M, Skin())
    proof = kept_proof(mesh, judged)
    return None if proof is None else certificate_of(judged, proof)


def _surface_mesh(mesh: Mesh, M: ArrayLike, skin: Skin) -> SurfaceMesh:
    metric = check_metric(M, n_points=mesh.n_points, dim=mesh.dim)
    return SurfaceMesh.of(mesh, MetricMesh.of(mesh, metric), skin)


def certificate_of(mesh: SurfaceMesh, proof: Proof, *, threads: int = 1) -> Certificate:
    """Return the certificate of a mesh of which everything is decided."""
    judged = _Judged(mesh, proof, threads)
    star_ok = judged.star_ok()
    exempt = _exempt(mesh.mesh, star_ok)
    simplex_ok = judged.simplex_ok()
    in_surface_star = judged.in_surface_star()
    surface_star_ok = judged.surface_star_ok()
    on_facets = np.unique(mesh.mesh.facets)
    return Certificate(
        simplex_ok=simplex_ok,
        star_ok=star_ok,
        exempt=exempt,
        verdict=_verdict(simplex_ok, star_ok, exempt, surface_star_ok[on_facets]),
        delaunay=judged.delaunay(),
        surface_ok=in_surface_star.all(axis=1),
        surface_star_ok=surface_star_ok,
        in_surface_star=in_surface_star,
        judged=judged,
    )


def _exempt(mesh: MetricMesh, star_ok: Bools) -> Bools:
    if star_ok.all():
        return np.zeros(len(star_ok), dtype=bool)
    with meshing_errors():
        return mesh.core().exempt(star_ok=star_ok.view(np.uint8)).astype(bool)


def _verdict(simplex_ok: Bools, star_ok: Bools, exempt: Bools, surface_star_ok: Bools) -> str:
    if star_ok.all():
        judgement = "certified"
    elif (star_ok | exempt).all():
        judgement = "certified but for exempt vertices"
    else:
        judgement = "not certified"
    return (
        f"{judgement}: star_ok = {_fraction(star_ok)}, simplex_ok = {_fraction(simplex_ok)}, "
        f"{int(exempt.sum())} vertices exempt at sharp corners; "
        f"surface_star_ok = {_fraction(surface_star_ok)}"
    )


def _fraction(ok: Bools) -> str:
    return f"{rounded_down(share_of(int(ok.sum()), len(ok))):g} ({int(ok.sum())} of {len(ok)})"


def share_of(part: int, whole: int) -> float:
    """Return how large a part is, 1 of nothing."""
    return part / whole if whole else 1.0


def rounded_down(share: float) -> float:
    """Return a share to four digits: 1 means all."""
    return math.floor(1e4 * share) / 1e4
