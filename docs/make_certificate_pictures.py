"""Make the pictures of certificate.md, and print the figures of its tables.

Run it in the folder of the repository::

    python docs/make_certificate_pictures.py docs/images
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

import anistar
from anistar.metric import from_sizes, graded
from anistar.pictures import certificate_picture

Float = NDArray[np.float64]

PIXELS, COLOURS = 640, 48
SIZES = (0.12, 0.03)
WIDTHS = {"slow": 0.5, "fast": 0.05}

OFF = anistar.RemeshOptions(agreement=False)
MOVED = anistar.RemeshOptions(agreement=True)
INSERTED = anistar.RemeshOptions(agreement=False, until_consistent=True)

# name of the picture: field, gradation factor, options
RUNS: dict[str, tuple[str, float | None, anistar.RemeshOptions]] = {
    "slow-before": ("slow", None, OFF),
    "slow-inserted": ("slow", None, INSERTED),
    "slow-after": ("slow", None, MOVED),
    "fast-before": ("fast", None, OFF),
    "fast-inserted": ("fast", None, INSERTED),
    "fast-after": ("fast", None, MOVED),
    "fast-graded": ("fast", 1.3, MOVED),
}
SHOWN = tuple(RUNS)

# Theorem 5.9 of RR-7712 v2: the bound on the distortion, and the size of the picking region.
GAMMAS = (1.0, 1.1, 1.3, 1.5, 2.0)
DELTAS = (0.1, 0.4)


def disk(size: float) -> anistar.Mesh:
    """Return a mesh of the unit disk with edges of the given length."""
    turns = np.linspace(0, 2 * np.pi, 65)[:-1]
    points = np.concatenate([[[0.0, 0.0]], np.stack([np.cos(turns), np.sin(turns)], axis=1)])
    rim = np.arange(1, 65)
    cells = np.stack([np.zeros(64, int), rim, np.roll(rim, -1)], axis=1)
    fan = anistar.Mesh(points=points, cells=cells)
    return anistar.remesh(fan, from_sizes(np.full(65, size), dim=2)).mesh


def turning_metric(points: Float, width: float) -> Float:
    """Return a metric that is long along x on the left and along y on the right.

    Its eigenvectors make a quarter turn around x = 0, over about the given width.
    """
    angle = 0.25 * np.pi * (1 + np.tanh(points[:, 0] / width))
    axes = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return np.asarray(np.einsum("kin,kjn,k->nij", axes, axes, 1 / np.array(SIZES) ** 2))


def smallest_constants(gamma: float, delta: float) -> tuple[float, float, float]:
    """Return the rho_0 and beta that (26) and (27) allow, and the smallest angle in degrees.

    A triangle of radius-edge ratio rho has no angle below arcsin(1 / (2 rho)).
    """
    rho = 2 * gamma**3 / (1 - delta)
    return rho, rho * (1 + delta), float(np.degrees(np.arcsin(1 / (2 * rho))))


def shrink(path: Path) -> None:
    """Make a picture small enough for the repository."""
    with Image.open(path) as picture:
        small = picture.convert("RGB").resize((PIXELS, PIXELS), Image.Resampling.LANCZOS)
    small.quantize(COLOURS, Image.Quantize.FASTOCTREE).save(path, optimize=True)


def make(name: str, background: anistar.Mesh, folder: Path) -> list[object]:
    """Make one mesh and its picture; return its row of figures."""
    field, factor, options = RUNS[name]
    M = turning_metric(background.points, WIDTHS[field])
    if factor is not None:
        M = graded(background, M, factor=factor)
    done = anistar.remesh(background, M, options)
    certificate = anistar.certify(done.mesh, done.metric)
    if name in SHOWN:
        path = folder / f"certificate-{name}.png"
        certificate_picture(path, done.mesh, certificate)
        shrink(path)
    figures = certificate.as_dict()
    extremes = [f"{figures[key]:.2f}" for key in ("distortion_max", "radius_edge_max")]
    counts = ["{} / {}".format(*figures[key]) for key in ("stars", "simplices", "restricted_v2")]
    return [name, done.mesh.n_points, *counts, *extremes]


def show(row: list[object]) -> None:
    """Print a row of a table in Markdown."""
    sys.stdout.write("| " + " | ".join(str(entry) for entry in row) + " |\n")


def main(folder: str) -> None:
    """Make every picture and print every table."""
    background = disk(0.02)
    for name in RUNS:
        show(make(name, background, Path(folder)))
    for gamma in GAMMAS:
        constants = [c for delta in DELTAS for c in smallest_constants(gamma, delta)]
        show([gamma, *(f"{constant:.3g}" for constant in constants)])


if __name__ == "__main__":
    main(*sys.argv[1:])
