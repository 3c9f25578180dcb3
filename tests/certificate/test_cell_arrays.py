import numpy as np
import pytest
from cases import walled_case
from meshes import square

from anistar.judging.cell_arrays import cell_arrays
from anistar.judging.certificate import certify


def test_the_distortion_of_cells_leads_to_that_of_vertices():
    for seed in (0, 1, 3, 4):
        mesh, metric = walled_case(seed)
        certificate = certify(mesh, metric)
        arrays = cell_arrays(mesh, metric, certificate)
        largest = np.ones(mesh.n_points)
        np.maximum.at(largest, mesh.cells, arrays["distortion"].values[:, None])
        assert (largest >= certificate.distortion * (1 - 1e-6)).all()
        assert largest.max() == pytest.approx(certificate.distortion.max(), rel=1e-4)
        assert np.array_equal(arrays["inconsistent"].values == 0, certificate.simplex_ok)


def test_a_mesh_without_a_certificate_has_figures_too():
    mesh = square(2)
    arrays = cell_arrays(mesh, np.tile(4 * np.eye(2), (mesh.n_points, 1, 1)))
    assert "inconsistent" not in arrays
    assert arrays["longest_edge"].values == pytest.approx(np.full(8, np.sqrt(2)))


def test_a_picture_needs_the_certificate_of_its_mesh(tmp_path):
    pictures = pytest.importorskip("anistar.pictures")
    one, other = (square(n) for n in (2, 3))
    certificate = certify(other, np.tile(np.eye(2), (other.n_points, 1, 1)))
    with pytest.raises(ValueError, match="of 18 triangles, the mesh has 8"):
        pictures.certificate_picture(tmp_path / "one.png", one, certificate)
