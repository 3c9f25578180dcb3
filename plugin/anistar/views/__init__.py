"""Views of meshes in 2D and 3D: what is seen, and by which package it is drawn."""
