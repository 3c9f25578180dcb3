"""
Fifty transfers of a rotating cone
==================================

A cone that rotates: fifty transfers between adapted meshes, by all three methods. The mesh turns
rigidly with the cone, which is the exact solution of the rotation, and the field is then
transferred to a mesh made for the place where the cone is now. Mass, maximum and error after a
full turn are those of the transfers alone.
"""

import argparse
from dataclasses import dataclass

import numpy as np
from scipy.spatial import Delaunay

import anistar
from anistar.judging.interpolation_error import l2_error
from anistar.metric import from_sizes, graded
from anistar.transfer import METHODS, integral

CENTRE, RADIUS = np.array([0.5, 0.0]), 0.3


@dataclass
class History:
    """One value after each transfer; the first is that of the start."""

    mass: list[float]
    maximum: list[float]
    minimum: list[float]
    error: list[float]


def rotated(x, angle):
    """Return (n, 2) points turned around the origin."""
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(x) @ np.array([[c, s], [-s, c]])


def cone(x, angle):
    """Return the cone, of height one, turned by an angle."""
    return np.maximum(0, 1 - np.linalg.norm(x - rotated(CENTRE, angle), axis=1) / RADIUS)


def disc(n_sides, spacing):
    """Return a regular polygon with points on rings."""
    rings = [np.zeros((1, 2))]
    for radius in np.linspace(0, 1, round(1 / spacing) + 1)[1:]:
        count = n_sides if radius == 1 else max(6, round(2 * np.pi * radius / spacing))
        angles = 2 * np.pi * np.arange(count) / count
        rings.append(radius * np.stack([np.cos(angles), np.sin(angles)], axis=1))
    points = np.concatenate(rings)
    return anistar.Mesh(points=points, cells=oriented(points, Delaunay(points).simplices))


def oriented(points, cells):
    """Return the cells with positive areas."""
    u, v = points[cells[:, 1]] - points[cells[:, 0]], points[cells[:, 2]] - points[cells[:, 0]]
    negative = u[:, 0] * v[:, 1] < u[:, 1] * v[:, 0]
    return np.where(negative[:, None], cells[:, ::-1], cells)


def adapted(background, angle, size):
    """Return a mesh that is fine where the cone bends; the boundary stays as it is."""
    away = np.linalg.norm(background.points - rotated(CENTRE, angle), axis=1)
    bend = np.minimum(away, np.abs(away - RADIUS))
    sizes = from_sizes(np.clip(0.4 * bend, size, 8 * size), dim=2)
    M = graded(background, sizes, factor=1.5)
    return anistar.remesh(background, M, anistar.RemeshOptions(frozen_tags=(0,))).mesh


def turn(mesh, angle):
    """Return the mesh turned around the origin."""
    return anistar.Mesh(**{**mesh.arrays(), "points": rotated(mesh.points, angle)})


def turned_once(mesh_at, n_transfers):
    """Turn the cone once, on the mesh for each angle; return a history for each method."""
    step = 2 * np.pi / n_transfers
    mesh = mesh_at(0.0)
    values = {method: cone(mesh.points, 0.0) for method in METHODS}
    histories = {method: History([], [], [], []) for method in METHODS}
    for k in range(n_transfers + 1):
        if k:
            moved, mesh = turn(mesh, step), mesh_at(k * step)
            values = {
                method: anistar.transfer(
                    moved, {"u": u}, mesh, method=method, outside="nearest"
                ).fields["u"]
                for method, u in values.items()
            }
        for method, u in values.items():
            history = histories[method]
            history.mass.append(float(integral(mesh, anistar.Field(u))))
            history.maximum.append(float(u.max()))
            history.minimum.append(float(u.min()))
            history.error.append(l2_error(mesh, u, lambda x, angle=k * step: cone(x, angle)))
    return histories


def main(n_transfers=50, size=0.02, picture=None):
    """Turn the cone once on adapted meshes; return a history for each method."""
    # As many sides as transfers, or twice as many: turned meshes cover the same polygon.
    background = disc(n_sides=n_transfers * max(1, 100 // n_transfers), spacing=2 * size)
    histories = turned_once(lambda angle: adapted(background, angle, size), n_transfers)
    if picture is not None:
        plot(histories, picture)
    return histories


def plot(histories, path):
    """Draw mass, maximum and error against the number of transfers."""
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 3, figsize=(12, 3.6), layout="constrained")
    for method, history in histories.items():
        axes[0].semilogy(
            np.maximum(np.abs(np.array(history.mass) / history.mass[0] - 1), 1e-16), label=method
        )
        axes[1].plot(history.maximum, label=method)
        axes[2].plot(history.error, label=method)
    for ax, title in zip(axes, ("change of mass", "maximum", "L2 error"), strict=True):
        ax.set(title=title, xlabel="transfers")
    axes[2].legend()
    figure.savefig(path, dpi=120)
    plt.close(figure)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--n-transfers", type=int, default=50)
    parser.add_argument("--size", type=float, default=0.02, help="of the smallest edges")
    parser.add_argument("--picture")
    for name, history in main(**vars(parser.parse_args())).items():
        change = history.mass[-1] / history.mass[0] - 1
        print(
            f"{name:13s} mass {change:+.1e}, values {history.minimum[-1]:.3f} to "
            f"{history.maximum[-1]:.3f}, L2 error {history.error[-1]:.2e}"
        )
