"""Draw the picture of the first page: tetrahedra along a gyroid, with a corner taken out.

    python docs/make_poster.py

It needs PyVista, takes about a minute, and writes docs/images/poster.png.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyvista
from PIL import Image, ImageChops

import anistar
from anistar.demo.volume import unit_cube
from anistar.meshes.topology import boundary_facets
from anistar.views.pyvista_view import quietly_off_screen

POSTER = Path(__file__).parent / "images" / "poster.png"

COMPLEXITIES = (4000.0, 16000.0, 32000.0, 32000.0)

# Periods of the gyroid in the cube, and how steep its two sides meet.
PERIODS, STEEPNESS = 0.8, 6.0

# What lies beyond this point in all directions is taken out.
CORNER = np.array([0.42, 0.42, 0.42])

VIEW, WINDOW, WIDTH = (1.0, 0.82, 0.72), (2200, 2300), 1000
COLOURS = ["#2b6c94", "#3d8db5", "#8cc7dd", "#fdf8ee", "#f6c48a", "#e58a5c", "#c9604a"]
PALETTE = 96

# Where they stand, and how bright they are.
LIGHTS = (((4.0, 1.5, 3.0), 0.8), ((1.0, 4.0, 1.5), 0.45))


def gyroid(points):
    """Return a function of (n, 3) points that jumps across the surface of a gyroid."""
    x, y, z = (2 * np.pi * PERIODS * (points + 0.07)).T
    surface = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    return np.tanh(STEEPNESS * surface)


def adapted():
    """Return a mesh of the unit cube that is adapted to the gyroid."""
    options = anistar.LoopOptions(complexities=COMPLEXITIES, max_iterations=len(COMPLEXITIES))
    loop = anistar.adapt_loop(
        lambda mesh, fields: {"u": gyroid(mesh.points)}, unit_cube(12), options
    )
    return loop.steps[-1].mesh


def draw(mesh, path):
    """Draw the cells of a mesh that are left when the corner next to the eye is taken out."""
    centres = mesh.points[mesh.cells].mean(axis=1)
    kept = mesh.cells[(centres < CORNER).any(axis=1)]
    facets = boundary_facets(kept, mesh.n_points)
    faces = np.column_stack([np.full(len(facets), 3), facets]).ravel()
    surface = pyvista.PolyData(mesh.points, faces)
    surface["u"] = gyroid(mesh.points)
    with quietly_off_screen():
        plotter = pyvista.Plotter(off_screen=True, window_size=list(WINDOW), lighting="none")
        plotter.set_background("white")
        plotter.add_mesh(
            surface, scalars="u", cmap=COLOURS, show_edges=True, edge_color="#0d1b2a",
            line_width=1.3, ambient=0.5, diffuse=0.62, specular=0.08, show_scalar_bar=False,
        )  # fmt: skip
        for place, intensity in LIGHTS:
            middle = (0.4, 0.4, 0.4)
            plotter.add_light(
                pyvista.Light(position=place, focal_point=middle, intensity=intensity)
            )
        plotter.view_vector(VIEW, viewup=(0.0, 0.0, 1.0))
        plotter.camera.zoom(0.98)
        picture = Image.fromarray(plotter.screenshot(None, return_img=True))
    picture = picture.crop(ImageChops.invert(picture).getbbox())  # no white around it
    height = round(picture.height * WIDTH / picture.width)
    small = picture.resize((WIDTH, height), Image.Resampling.LANCZOS)
    small.quantize(PALETTE).save(path, optimize=True)  # few colours keep it below 400 kB


if __name__ == "__main__":
    draw(adapted(), POSTER)
