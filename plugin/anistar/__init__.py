"""anistar: certified anisotropic Delaunay mesh adaptation for any PDE code."""
