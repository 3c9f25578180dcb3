"""Files with geometry: what is written is read again, and what has no place is told."""

import numpy as np
import pytest
from geometry_files import is_cube, poly_text, written
from solids import CORNERS, SIDES

from anistar import FormatError
from anistar.generating import PLC, Region, read_plc, write_plc


def cube(**more):
    names = {(2, 1): "lower side", (2, 2): "others"}
    return PLC(CORNERS, facets=SIDES, facet_tags=[1, 2, 2, 2, 2, 2], names=names, **more)


@pytest.mark.parametrize("suffix", [".stl", ".obj", ".poly", ".smesh", ".msh", ".mesh", ".meshb"])
def test_what_is_written_is_read_again(tmp_path, suffix):
    plc = cube()
    path = tmp_path / f"a{suffix}"
    write_plc(path, plc)
    again = read_plc(path)
    assert is_cube(again)
    order = np.lexsort(again.points.T[::-1])
    assert np.array_equal(again.points[order], plc.points[np.lexsort(plc.points.T[::-1])])
    assert sorted(again.facet_tags.tolist()) == [1, 2, 2, 2, 2, 2]
    if suffix not in (".poly", ".smesh", ".meshb"):
        assert again.names == plc.names


@pytest.mark.parametrize("suffix", [".msh", ".mesh", ".meshb"])
def test_formats_of_meshes_keep_edges_and_points(tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    write_plc(path, cube(edges=[[0, 6], [0, 1]], edge_tags=[4, 5], points_kept=[3]))
    again = read_plc(path)
    assert again.edges.tolist() == [[0, 6], [0, 1]]
    assert again.edge_tags.tolist() == [4, 5]
    assert again.points_kept.tolist() == [3]


@pytest.mark.parametrize("suffix", [".poly", ".smesh"])
def test_holes_and_regions_of_a_complex_are_written(tmp_path, suffix):
    first = read_plc(written(tmp_path, "a.poly", poly_text()))
    path = tmp_path / f"b{suffix}"
    write_plc(path, first)
    again = read_plc(path)
    assert np.array_equal(again.points, first.points)
    assert again.regions[0].size == pytest.approx(first.regions[0].size)
    assert again.holes.tolist() == first.holes.tolist()
    if suffix == ".poly":
        assert again.facets[:] == first.facets[:]


@pytest.mark.parametrize("suffix", [".poly", ".msh", ".mesh"])
def test_outlines_are_written_and_read(tmp_path, suffix):
    plc = PLC([[0, 0], [1, 0], [1, 1]], edges=[[0, 1], [1, 2], [0, 2]], edge_tags=[1, 2, 3])
    path = tmp_path / f"a{suffix}"
    write_plc(path, plc)
    again = read_plc(path)
    assert again.dim == 2
    assert again.segment_tags.tolist() == plc.segment_tags.tolist()
    with pytest.raises(FormatError, match="this is an outline"):
        write_plc(tmp_path / "a.stl", plc)


def test_what_a_format_does_not_carry_is_told(tmp_path, caplog):
    plc = cube(regions=[Region((0.5, 0.5, 0.5), 1)], edges=[[0, 6]])
    write_plc(tmp_path / "a.stl", plc)
    for what in ("regions", "edges"):
        assert f"this format does not carry {what}" in caplog.text
    with pytest.raises(FormatError, match="geometry is written as"):
        write_plc(tmp_path / "a.step", plc)


def test_a_complex_is_written_and_nothing_else(tmp_path):
    with pytest.raises(TypeError, match="plc must be PLC, not"):
        write_plc(tmp_path / "a.stl", tmp_path / "b.stl")
