"""Series in time: one instant is read, the last one by default, and all are converted."""

import re
import shutil

import meshio
import numpy as np
import pytest
from meshes import square, two_region_cube, two_regions

import anistar
from anistar import formats
from anistar.base.errors import FormatError
from anistar.cli import main
from anistar.meshes.validation import validate
from anistar.runs.series import SeriesWriter

TIMES = (0.0, 0.5, 2.0)


def write_pvd(path):
    writer = SeriesWriter(path)
    for k, time in enumerate(TIMES):
        mesh = square(k + 1)
        writer.add(time, mesh, {"u": mesh.points[:, 0] + k})


def write_xdmf(path, data_format):
    mesh = two_regions(2)
    points = np.pad(mesh.points, ((0, 0), (0, 1)))
    with meshio.xdmf.TimeSeriesWriter(path, data_format=data_format) as writer:
        writer.write_points_cells(points, [("triangle", mesh.cells)])
        for k, time in enumerate(TIMES):
            writer.write_data(time, point_data={"u": mesh.points[:, 0] + k})


@pytest.fixture(params=["pvd", "XML", "HDF"])
def series(request, tmp_path, monkeypatch):
    """The path of a series of three instants, whose field is larger by one at each."""
    monkeypatch.chdir(tmp_path)
    if request.param == "pvd":
        write_pvd("run.pvd")
        return "run.pvd"
    if request.param == "HDF":
        pytest.importorskip("h5py")
    write_xdmf("run.xdmf", request.param)
    return "run.xdmf"


def lowest(content):
    mesh, fields = content[:2]
    assert validate(mesh) == []
    return fields["u"].values.min()


def test_the_last_instant_is_read_and_told(series):
    *content, report = formats.read_with_report(series)
    assert lowest(content) == 2
    assert report.warnings[0].startswith("of its 3 instants the last one is read, at time 2; ")


def test_any_instant_can_be_chosen_by_number(series):
    assert formats.instants(series) == TIMES
    for number in (0, 1, 2, -1, -3):
        assert lowest(anistar.read(series, instant=number)) == number % 3
        *content, report = formats.read_with_report(f"{series}:{number}")
        assert lowest(content) == number % 3
        assert not any("instant" in text for text in report.warnings)
    with pytest.raises(FormatError, match=rf"{series}: there is no instant 3: it has 3"):
        anistar.read(series, instant=3)


def test_a_whole_series_is_converted_with_its_times(series):
    assert main(["convert", series, "all.pvd"]) == 0
    assert formats.instants("all.pvd") == TIMES
    assert [lowest(anistar.read("all.pvd", instant=k)) for k in range(3)] == [0, 1, 2]
    assert main(["convert", f"{series}:1", "one.pvd"]) == 0
    assert formats.instants("one.pvd") == (0.0,)
    assert lowest(anistar.read("one.pvd")) == 1


def test_a_shorter_series_removes_what_the_list_there_has_and_nothing_else(
    tmp_path, monkeypatch, caplog
):
    monkeypatch.chdir(tmp_path)
    write_pvd("run.pvd")
    for name in ("run_012.vtu", "run_005.vtu"):
        formats.write(name, square(1))
    assert main(["convert", "run_005.vtu", "run.pvd"]) == 0
    told = "removed what the earlier series had beyond this one: run_001.vtu, run_002.vtu"
    assert told in caplog.text
    left = sorted(path.name for path in tmp_path.iterdir())
    assert left == ["run.pvd", "run_000.vtu", "run_005.vtu", "run_012.vtu"]


@pytest.mark.parametrize("given", ["run.pvd", "run.pvd:1", "run_001.vtu", "other.pvd"])
@pytest.mark.parametrize("dry", [True, False])
def test_a_series_is_never_written_over_what_is_read(tmp_path, monkeypatch, capsys, given, dry):
    monkeypatch.chdir(tmp_path)
    write_pvd("run.pvd")
    shutil.copy("run.pvd", "other.pvd")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    assert main(["convert", given, "run.pvd", *(["--dry-run"] if dry else [])]) == 2
    assert "which is read, is a part of it" in capsys.readouterr().err
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_a_series_replaces_no_file_of_another(series):
    formats.write("all_000.vtu", square(5))
    for path in (series, f"{series}:0"):
        for more in ([], ["--dry-run"]):
            assert main(["convert", path, "all.pvd", *more]) == 2
    with pytest.raises(FormatError, match=r"all_000\.vtu is there and no part of this series"):
        formats.write("all.pvd", square(1))
    assert formats.read("all_000.vtu")[0].n_cells == 50


def test_files_without_instants_have_none_to_choose(tmp_path):
    formats.write(tmp_path / "m.vtu", square(1))
    assert formats.instants(tmp_path / "m.vtu") == (0.0,)
    with pytest.raises(FormatError, match="have no instants to choose"):
        formats.read(tmp_path / "m.vtu", instant=0)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("run_001.vtu", "../run_001.vtu", "which is not in its folder"),
        ("run_001.vtu", "/run_001.vtu", "which is not in its folder"),
        ("run_001.vtu", "run_001.pvtu", "only VTU is read"),
        ("run_002.vtu", "run_005.vtu", r"run\.pvd: it lists 'run_005.vtu', which is not there"),
        ('timestep="0.5"', 'timestep="0.0"', "several files at one time"),
        ('"Collection"', '"ImageData"', "it is no collection"),
    ],
)
def test_a_list_that_leads_elsewhere_is_refused(tmp_path, old, new, message):
    path = tmp_path / "run.pvd"
    write_pvd(path)
    path.write_text(path.read_text().replace(old, new))
    with pytest.raises(FormatError, match=message):
        formats.read(path)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('CollectionType="Temporal"', 'CollectionType="Spatial"', "it has a spatial collection"),
        ('Name="mesh"', 'Name="other"', "which there are 0"),
        ('xpointer="', 'href="other.xdmf" xpointer="', "includes another file"),
    ],
)
def test_a_series_in_xdmf_that_is_damaged_is_refused(tmp_path, old, new, message):
    path = tmp_path / "run.xdmf"
    write_xdmf(path, "XML")
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    with pytest.raises(FormatError, match=message):
        formats.read(path)


def with_common_times(path, element):
    """Write a series whose collection has the times instead of its grids."""
    write_xdmf(path, "XML")
    text, head = re.sub(r"<Time Value=[^>]*/>", "", path.read_text()), 'CollectionType="Temporal">'
    assert text.count(head) == 1
    path.write_text(text.replace(head, f"{head}<Time {element}</Time>"))


@pytest.mark.parametrize(
    ("element", "times"),
    [
        ('TimeType="List"><DataItem Dimensions="3">0.5 1.5 4</DataItem>', (0.5, 1.5, 4)),
        ('TimeType="HyperSlab"><DataItem Dimensions="3">1 .25 3</DataItem>', (1, 1.25, 1.5)),
    ],
)
def test_a_collection_may_have_the_times_of_its_grids(tmp_path, element, times):
    with_common_times(tmp_path / "run.xdmf", element)
    assert formats.instants(tmp_path / "run.xdmf") == times
    assert lowest(formats.read(tmp_path / "run.xdmf", instant=1)) == 1


@pytest.mark.parametrize(
    ("element", "message"),
    [
        ('TimeType="Range"><DataItem Dimensions="2">0 1</DataItem>', "times of type 'Range'"),
        ('Value="3">', "times of type 'Single'"),
        ('TimeType="List"><DataItem Dimensions="2">0 1</DataItem>', "2 times for 3 grids"),
        ('TimeType="HyperSlab"><DataItem Dimensions="2">0 1</DataItem>', "of 2 numbers, not 3"),
        ('TimeType="HyperSlab"><DataItem Dimensions="3">0 1 9e9</DataItem>', "4 times for 3"),
    ],
)
def test_times_that_do_not_fit_the_grids_are_refused(tmp_path, element, message):
    with_common_times(tmp_path / "run.xdmf", element)
    with pytest.raises(FormatError, match=message):
        formats.instants(tmp_path / "run.xdmf")


def test_numbers_in_hdf5_are_read_beside_the_document_only(tmp_path):
    pytest.importorskip("h5py")
    mesh = two_region_cube()
    content = meshio.Mesh(mesh.points, [("tetra", mesh.cells)], point_data={"u": mesh.points[:, 1]})
    (tmp_path / "in").mkdir()
    content.write(tmp_path / "in" / "m.xdmf")
    got, fields = formats.read(tmp_path / "in" / "m.xdmf")
    assert np.array_equal(got.points, mesh.points)
    assert np.array_equal(fields["u"].values, mesh.points[:, 1])
    assert validate(got) == []
    text = (tmp_path / "in" / "m.xdmf").read_text()
    (tmp_path / "m.xdmf").write_text(text.replace("m.h5", "in/m.h5"))
    with pytest.raises(FormatError, match="no HDF5 file beside it"):
        formats.read(tmp_path / "m.xdmf")
    (tmp_path / "in" / "m.h5").write_bytes((tmp_path / "in" / "m.h5").read_bytes()[:300])
    with pytest.raises(FormatError, match=r"m\.h5 is truncated or no HDF5"):
        formats.read(tmp_path / "in" / "m.xdmf")
