"""The surfaces of VTK."""
