"""How good a mesh is: certificate, quality, curvature, errors of fields on it."""
