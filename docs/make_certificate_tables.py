"""Print the tables of certificate.md about meshes of tetrahedra.

Run it in the folder of the repository; it takes some minutes::

    python docs/make_certificate_tables.py
"""

from __future__ import annotations

import itertools
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import anistar
from anistar.judging.certificate import rounded_down
from anistar.metric import graded
from anistar.remeshing.report import RemeshReport

Float = NDArray[np.float64]
Field = Callable[[Float], Float]
Row = list[Any]

PASSES = 4
TIMED = 2  # the fastest of so many calls
THICKNESS = 0.1  # of the layers: their sizes grow by e over it
LARGEST_GROWTH = 12.0
CLASSES = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, np.inf)

# what is asked of the last pass
ASKED = (
    anistar.RemeshOptions(agreement=False, max_refinement=None),
    anistar.RemeshOptions(agreement="auto", max_refinement=None),
    anistar.RemeshOptions(agreement=True, max_refinement=None),
    anistar.RemeshOptions(until_consistent=True, max_refinement=None),
)


@dataclass(frozen=True, kw_only=True)
class Case:
    """A metric in the unit cube, and the bound on its distortion."""

    name: str
    field: Field
    max_distortion: float | None = None

    def on(self, mesh: anistar.Mesh) -> Float:
        """Return the metric at the points of a mesh."""
        M = self.field(mesh.points)
        if self.max_distortion is None:
            return M
        return graded(mesh, M, factor=None, max_distortion=self.max_distortion)


def tensors(axes: Float, sizes: Float) -> Float:
    """Return metrics with axes (n, 3, 3) in rows and sizes (n, 3) along them."""
    return np.asarray(np.einsum("nki,nkj,nk->nij", axes, axes, sizes**-2.0))


def sizes_of_layer(distance: Float, scale: float) -> Float:
    """Return sizes across a layer and along it, times a factor."""
    growth = np.minimum(np.cosh(distance / THICKNESS), LARGEST_GROWTH)
    along = np.full(len(distance), LARGEST_GROWTH)
    return np.asarray(scale * np.stack([growth, along, along], axis=1))


def flat_layer(scale: float) -> Field:
    """Return a layer in the plane x = .5."""
    return lambda x: tensors(
        np.tile(np.eye(3), (len(x), 1, 1)), sizes_of_layer(x[:, 0] - 0.5, scale)
    )


def round_layer(scale: float) -> Field:
    """Return a layer on the cylinder with radius .7 about the axis z."""

    def metric(x: Float) -> Float:
        radius = np.hypot(x[:, 0], x[:, 1])
        turned = frames(np.arctan2(x[:, 1], x[:, 0]))
        return tensors(turned, sizes_of_layer(radius - 0.7, scale))

    return metric


def turning(width: float, scale: float) -> Field:
    """Return cells three times as long as wide, which make a quarter turn around x = .5."""

    def metric(x: Float) -> Float:
        angle = 0.25 * np.pi * (1 + np.tanh((x[:, 0] - 0.5) / width))
        sizes = scale * np.array([3.0, 1.0, 1.0])
        return tensors(frames(angle), np.tile(sizes, (len(x), 1)))

    return metric


def frames(angle: Float) -> Float:
    """Return the axes that turns about z make of those of space."""
    c, s = np.cos(angle), np.sin(angle)
    o, e = np.zeros_like(c), np.ones_like(c)
    return np.moveaxis(np.array([[c, s, o], [-s, c, o], [o, o, e]]), 2, 0)


def cube(n: int) -> anistar.Mesh:
    """Return the unit cube in n**3 cubes of six tetrahedra."""
    points = np.stack(np.meshgrid(*3 * [np.linspace(0, 1, n + 1)], indexing="ij"), axis=-1)
    low = np.arange((n + 1) ** 3).reshape(3 * [n + 1])[:-1, :-1, :-1].ravel()
    step = np.array([(n + 1) ** 2, n + 1, 1])
    cells = []
    for a, b, c in ((0, 1, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0), (1, 0, 2), (0, 2, 1)):
        corners = np.cumsum([0, step[a], step[b], step[c]])
        if (a, b, c) in ((2, 1, 0), (1, 0, 2), (0, 2, 1)):
            corners[[0, 1]] = corners[[1, 0]]
        cells.append(low[:, None] + corners)
    return anistar.Mesh(points=points.reshape(-1, 3), cells=np.concatenate(cells))


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """One call, the certificate of its mesh, and its processor time."""

    case: Case
    options: anistar.RemeshOptions
    done: anistar.Remeshed
    certificate: anistar.Certificate
    seconds: float
    times: float  # over those without agreement

    @property
    def is_refused(self) -> bool:
        """Whether the metric varies too fast."""
        return self.done.report.agreement.startswith("skipped")


CASES = (
    Case(name="flat layer", field=flat_layer(0.008)),
    Case(name="slow turn", field=turning(0.4, 0.045)),
    Case(name="round layer", field=round_layer(0.01)),
    Case(name="round layer, graded", field=round_layer(0.01), max_distortion=0.3),
    Case(name="fast turn", field=turning(0.1, 0.045)),
)
SCALES = (0.02, 0.014, 0.01, 0.007, 0.005)  # of the flat layer


def settled(case: Case) -> tuple[anistar.Mesh, Float]:
    """Return a mesh that some passes have fitted to a metric, and the metric on it."""
    mesh = cube(16)
    options = anistar.RemeshOptions(agreement=False, max_refinement=None)
    for _ in range(PASSES - 1):
        mesh = anistar.remesh(mesh, case.on(mesh), options).mesh
    return mesh, case.on(mesh)


def timed(
    mesh: anistar.Mesh, M: Float, options: anistar.RemeshOptions
) -> tuple[anistar.Remeshed, float]:
    """Return a remeshing, and the least processor time of some."""
    seconds = []
    for _ in range(1 if options.until_consistent else TIMED):
        begin = time.process_time()
        done = anistar.remesh(mesh, M, options)
        seconds.append(time.process_time() - begin)
    return done, min(seconds)


def outcomes(case: Case) -> list[Outcome]:
    """Return what the last pass makes of a metric, for all that is asked; not if it is refused."""
    mesh, M = settled(case)
    found: list[Outcome] = []
    for options in ASKED:
        done, seconds = timed(mesh, M, options)
        first = found[0].seconds if found else seconds
        made = Outcome(
            case=case,
            options=options,
            done=done,
            certificate=anistar.certify(done.mesh, done.metric),
            seconds=seconds,
            times=seconds / first,
        )
        found.append(made)
        if options.agreement is True and made.is_refused:
            break
    return found


def of_agreement(made: Outcome) -> Row:
    """Return a row of the table on agreement."""
    report, certificate = made.done.report, made.certificate
    return [
        made.case.name,
        quantiles(report),
        f"`{made.options.agreement}`",
        made.done.mesh.n_points,
        share(certificate.star_ok),
        share(certificate.simplex_ok),
        f"{report.statistics['edge_unit']:.3f}",
        f"{report.statistics['q_min']:.2f}",
        f"{made.times:.1f}",
        report.agreement,
    ]


def of_classes(made: Outcome) -> Row:
    """Return the certified share of the stars, by the largest ln gamma at the vertex."""
    ln_gamma = np.log(made.certificate.distortion)
    shares = []
    for low, high in itertools.pairwise(CLASSES):
        ok = made.certificate.star_ok[(ln_gamma >= low) & (ln_gamma < high)]
        shares.append(f"{share(ok)} of {len(ok)}" if len(ok) > 0 else "")
    return [made.case.name, *shares]


def of_consistency(made: Outcome) -> Row:
    """Return a row of the table on Algorithm 2."""
    report, certificate = made.done.report, made.certificate
    return [
        made.case.name,
        made.done.mesh.n_points,
        f"{report.counts['star_failures']:.0f} → {(~certificate.simplex_ok).sum()}",
        share(certificate.star_ok),
        f"{report.statistics['q_min']:.2f}",
        report.consistency["rounds"],
        report.consistency["stop_reason"],
        f"{made.times:.1f}",
    ]


def share(ok: NDArray[np.bool_]) -> str:
    """Return how many are true of all: 1 means every one."""
    return f"{rounded_down(ok.mean()):g}"


def quantiles(report: RemeshReport) -> str:
    """Return what 10 % and 1 % of the edges exceed in ln gamma."""
    return f"{report.distortion['p90']:.2f}, {report.distortion['p99']:.2f}"


def resolve(scale: float) -> Row:
    """Return how well a layer is resolved, and what is certified of it."""
    mesh, M = settled(Case(name="", field=flat_layer(scale)))
    done = anistar.remesh(mesh, M, anistar.RemeshOptions(max_refinement=None))
    stars = share(anistar.certify(done.mesh, done.metric).star_ok)
    largest = f"{scale * LARGEST_GROWTH / THICKNESS:.1f}"
    return [largest, done.mesh.n_points, quantiles(done.report), stars, done.report.agreement]


def show(rows: list[Row]) -> None:
    """Print the rows of a table in Markdown."""
    lines = ["| " + " | ".join(map(str, row)) + " |" for row in rows]
    sys.stdout.write("\n".join([*lines, "", ""]))
    sys.stdout.flush()


def main() -> None:
    """Print the rows of every table, metric by metric."""
    show([resolve(scale) for scale in SCALES])
    for case in CASES:
        made = outcomes(case)
        asked = [one for one in made if one.options.agreement is True and not one.is_refused]
        show([of_agreement(one) for one in made if not one.options.until_consistent])
        show([of_classes(one) for one in asked])
        show([of_consistency(one) for one in made if one.options.until_consistent])


if __name__ == "__main__":
    main()
