"""VTK's formats: legacy `.vtk` and VTU."""
