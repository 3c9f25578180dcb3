"""Files of Salome: groups are tags with names."""

from contextlib import suppress

import meshio
import numpy as np
import pytest
from meshes import two_region_cube, two_regions

from anistar import Field, Mesh, formats, objects
from anistar.base.errors import FormatError
from anistar.meshes.validation import validate

h5py = pytest.importorskip("h5py")
TEXT = np.dtype(("i1", (80,)))


def write_med(path, mesh, blocks, families):
    """Write as Salome does: `blocks` by MED's name of their type, with a family an element."""
    with h5py.File(path, "w") as file:
        top = file.create_group("ENS_MAA/part")
        top.attrs["ESP"] = mesh.dim
        step = top.create_group("-0000000000000000001-0000000000000000001")
        step["NOE/COO"] = mesh.points.ravel(order="F")
        for name, (rows, numbers) in blocks.items():
            step[f"MAI/{name}/NOD"] = (np.asarray(rows) + 1).ravel(order="F")
            step[f"MAI/{name}/FAM"] = numbers
        for number, groups in families.items():
            group = file.create_group(f"FAS/part/ELEME/FAM_{number}")
            group.attrs["NUM"] = number
            if groups:
                listed = group.create_dataset("GRO/NOM", (len(groups),), dtype=TEXT)
                for i, name in enumerate(groups):
                    listed[i] = np.frombuffer(name.ljust(80, "\0").encode(), np.int8)
        field = file.create_group("CHA/T")
        field.attrs["NCO"] = 2
        for k in (1, 2):
            profile = f"{k:020d}{0:020d}/NOE/MED_NO_PROFILE_INTERNAL"
            field[f"{profile}/CO"] = (k * mesh.points[:, :2]).ravel(order="F")


def test_groups_of_families_are_tags_with_names(tmp_path):
    mesh = two_regions(2)
    cells = np.where(mesh.cell_tags == 1, -3, -5)
    blocks = {"TR3": (mesh.cells, cells), "SE2": (mesh.facets, -10 - mesh.facet_tags)}
    walls = {-10 - int(tag): ["rim"] for tag in np.unique(mesh.facet_tags)}
    write_med(tmp_path / "m.med", mesh, blocks, {-3: ["west"], -5: ["east", "hot"], **walls})
    got, fields, report = formats.read_with_report(tmp_path / "m.med")
    assert np.array_equal(got.cell_tags, np.abs(cells))
    assert got.names == {(2, 3): "west", (2, 5): "east", (1, 11): "rim"}
    assert set(got.facet_tags.tolist()) == {11}
    assert np.array_equal(fields["T"].values, 2 * mesh.points)
    assert report.warnings == (
        f"{np.count_nonzero(cells == -5)} element(s) are in several groups, the first is kept",
        "field 'T' has 2 steps, the last one is read",
    )
    assert validate(got) == []


def test_cells_in_space_are_numbered_in_the_mirror(tmp_path):
    mesh = two_region_cube()
    rows = mesh.cells[:, [0, 2, 1, 3]]
    write_med(tmp_path / "m.med", mesh, {"TE4": (rows, np.zeros(mesh.n_cells, int))}, {})
    got, _, report = formats.read_with_report(tmp_path / "m.med")
    assert np.array_equal(got.cells, mesh.cells)
    assert report.flipped_cells == 0
    assert validate(got) == []


def test_tags_come_back_by_their_number_where_they_have_no_name(tmp_path):
    base = two_regions(2)
    mesh = Mesh(**{**base.arrays(), "names": {(2, 1): "a b", (1, 2): "größe"}})
    formats.write(tmp_path / "m.med", mesh, {"k": Field(np.arange(8.0), "cells")})
    got, fields = formats.read(tmp_path / "m.med")
    assert set(got.names.values()) == {"a b", "größe"}
    unnamed = mesh.cell_tags != 1
    assert np.array_equal(got.cell_tags[unnamed], mesh.cell_tags[unnamed])
    others = mesh.facet_tags != 2
    assert np.array_equal(got.facet_tags[others], mesh.facet_tags[others])
    assert fields["k"].values.tolist() == list(range(8))
    assert validate(got) == []


@pytest.mark.parametrize("make", [two_regions, two_region_cube])
def test_groups_that_meshio_has_read_are_tags_with_names(tmp_path, make, caplog):
    mesh = Mesh(**make().arrays() | {"corners": []})
    formats.write(tmp_path / "m.med", mesh)
    other = meshio.read(tmp_path / "m.med")
    other.point_tags, other.point_data["point_tags"] = {3: ["probe"]}, np.zeros(mesh.n_points)
    got, fields = objects.opened(other)[:2]
    assert fields == {}
    assert "no place and not read: the group of points probe" in caplog.text
    wanted = formats.read(tmp_path / "m.med")[0]
    assert got.names == wanted.names
    assert set(got.names.values()) == set(mesh.names.values())
    assert np.array_equal(got.cell_tags, wanted.cell_tags)
    assert np.array_equal(got.facet_tags, wanted.facet_tags)
    objects.made(got, {}, other).write(tmp_path / "again.med")
    again = formats.read(tmp_path / "again.med")[0]
    assert again.names == got.names
    assert np.array_equal(again.cell_tags, got.cell_tags)
    assert validate(again, got) == []


def test_a_med_file_that_is_cut_or_damaged_is_refused(tmp_path):
    path = tmp_path / "m.med"
    formats.write(path, two_regions(2))
    data = path.read_bytes()
    for end in np.linspace(0, len(data) - 9, 12).astype(int):
        path.write_bytes(data[:end])
        with pytest.raises(FormatError, match=r"m\.med"):
            formats.read(path)
    random, damaged = np.random.default_rng(2), np.frombuffer(data, np.uint8)
    for _ in range(60):
        other = damaged.copy()
        other[random.integers(0, len(other), 4)] = random.integers(0, 256, 4)
        path.write_bytes(other.tobytes())
        with suppress(FormatError):
            formats.read(path)


def test_links_out_of_the_file_are_not_followed(tmp_path):
    path = tmp_path / "m.med"
    formats.write(path, two_regions(2))
    (tmp_path / "other.med").write_bytes(path.read_bytes())
    place = "ENS_MAA/mesh/-0000000000000000001-0000000000000000001/NOE"
    with h5py.File(path, "a") as file:
        del file[f"{place}/COO"]
        file[f"{place}/COO"] = h5py.ExternalLink("other.med", f"{place}/COO")
    with pytest.raises(FormatError, match="has no 'COO' of its own"):
        formats.read(path)
