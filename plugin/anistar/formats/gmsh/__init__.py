"""Gmsh `.msh`."""
