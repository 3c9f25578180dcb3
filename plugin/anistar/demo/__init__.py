"""The demos: examples in 2D and 3D that ship with the package."""
