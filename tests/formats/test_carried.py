"""What the table of formats says is carried comes back, and what it says is lost does not."""

import json

import meshio
import numpy as np
import pytest
from documents import ROOT, rows_below
from meshes import square, two_region_cube, two_regions

from anistar import Field, Mesh, formats
from anistar.base.errors import FormatError
from anistar.cli import main
from anistar.formats.carried import ALL, ASPECTS, CARRIED, holdable, losses
from anistar.meshes.fields import as_fields
from anistar.meshes.validation import validate

PAGE = "docs/file-formats.md"


def rich(dim):
    """A mesh and fields that have something of every aspect."""
    arrays = (two_regions() if dim == 2 else two_region_cube()).arrays() | {"corners": [0, 3]}
    if dim == 2:
        arrays |= {"z": 0.3}
    else:
        arrays |= {"names": arrays["names"] | {(1, int(arrays["edge_tags"].max())): "seam"}}
    mesh = Mesh(**arrays)
    draw = np.random.default_rng(4).normal
    skew = draw(size=(mesh.n_points, dim, dim))
    labels = np.arange(mesh.n_cells)
    fields = {
        "u at points": draw(size=mesh.n_points),
        "v": draw(size=(mesh.n_points, dim)),
        "T": skew,
        "metric": skew + skew.transpose(0, 2, 1),
        "k": Field(draw(size=mesh.n_cells), "cells"),
        "label": Field(labels, "cells"),
        "large": Field(labels + 2**60 + 1, "cells"),
    }
    return mesh, as_fields(mesh, fields)


def is_among(field, fields):
    return any(
        other.on == field.on and np.array_equal(other.values, field.values)
        for other in fields.values()
    )


def came_back(mesh, fields, again, back):
    """The aspects of a mesh with fields that a file has given back, bit by bit."""

    def has_names(codimension):
        dim = mesh.dim - codimension
        return {name for (d, _), name in mesh.names.items() if d == dim} <= {
            name for (d, _), name in again.names.items() if d == dim
        }

    def has_tags(what, tags, dim):
        def told(mesh):
            rows, numbers = getattr(mesh, what).tolist(), getattr(mesh, tags).tolist()
            return {
                frozenset(row): mesh.names.get((dim, number), number)
                for row, number in zip(rows, numbers, strict=True)
            }

        bare = {**mesh.arrays(), "names": {}}
        return told(again) in (told(mesh), told(Mesh(**bare)))

    def has_field(name):
        return (
            name in back
            and back[name].kind == fields[name].kind
            and np.array_equal(back[name].values, fields[name].values)
        )

    kept = {
        "cells": np.array_equal(again.cells, mesh.cells),
        "height": again.z == mesh.z,
        "tags of cells": has_tags("cells", "cell_tags", mesh.dim),
        "tags of facets": has_tags("facets", "facet_tags", mesh.dim - 1),
        "ridges": has_tags("edges", "edge_tags", 1),
        "corners": np.array_equal(again.corners, mesh.corners),
        "names of cells": has_names(0),
        "names of facets": has_names(1),
        "names of ridges": has_names(2),
        "numbers of names": mesh.names.items() <= again.names.items(),
        "point fields": all(is_among(fields[n], back) for n in ("u at points", "v", "metric")),
        "cell fields": is_among(fields["k"], back),
        "full tensors": is_among(fields["T"], back),
        "names of fields": all(map(has_field, ("v", "metric", "k"))),
        "blanks in names": has_field("u at points"),
        "labels": "label" in back and back["label"].kind == "label",
        "large labels": has_field("large"),
    }
    return {aspect for aspect, is_kept in kept.items() if is_kept}


@pytest.fixture(scope="module")
def measured(tmp_path_factory):
    """What comes back of each format, in 2D and in 3D."""
    folder, found = tmp_path_factory.mktemp("carried"), {}
    for suffix in CARRIED:
        for dim in (2, 3):
            mesh, fields = rich(dim)
            path = folder / f"m{dim}{suffix}"
            formats.put(path, mesh, holdable(mesh, fields, path))
            again, back = formats.read(path)
            assert validate(again) == []
            assert np.array_equal(again.points, mesh.points)
            found[suffix, dim] = came_back(mesh, fields, again, back)
    return found


# A mesh in 2D has no ridges, one in 3D no height: nothing can be lost there.
NOTHING = {2: {"ridges", "names of ridges"}, 3: {"height"}}


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("suffix", CARRIED)
def test_what_is_carried_comes_back_and_nothing_else(measured, suffix, dim):
    assert measured[suffix, dim] - NOTHING[dim] == CARRIED[suffix] - NOTHING[dim]


def test_the_page_says_of_every_format_what_is_carried(measured):
    text = (ROOT / PAGE).read_text()
    head = next(line for line in text.splitlines() if line.startswith("| carried |"))
    columns = [cell.strip(" `").split("`, `") for cell in head.strip("|").split("|")][1:]
    assert {suffix for column in columns for suffix in column} == CARRIED.keys()
    rows = rows_below(text, "| carried |")
    assert [row[0] for row in rows] == list(ASPECTS)
    for aspect, *cells in rows:
        for suffixes, cell in zip(columns, cells, strict=True):
            for suffix in suffixes:
                kept = all(
                    aspect in measured[suffix, dim] for dim in (2, 3) if aspect not in NOTHING[dim]
                )
                assert cell == ("yes" if kept else "–"), (aspect, suffix)


@pytest.mark.parametrize("dim", [2, 3])
def test_the_loss_of_every_aspect_is_told(dim):
    mesh, fields = rich(dim)
    assert losses(mesh, fields, "m.vtu") == []
    for aspect in ALL - NOTHING[dim]:
        (text,) = [text] if (text := ASPECTS[aspect](mesh, fields)) else []
        assert text
    told = losses(mesh, fields, "m.su2")
    assert told[0] == ("the height z = 0.3" if dim == 2 else "the tags of cells (1, 2)")
    assert "the fields at points ('u at points', 'v', 'T', 'metric')" in told
    assert not any("names of fields" in text for text in told)


def test_a_format_that_nothing_here_reads_is_not_vouched_for():
    mesh, fields = rich(2)
    told = losses(mesh, fields, "m.ugrid")
    assert "the tags of facets" in told[2]
    assert told[-1].endswith("meshio writes this format, which may keep some of it")
    assert losses(square(1), {}, "m.sol") == ["the mesh (4 points, 2 cells)"]


def refusal(path, mesh):
    """Why a mesh cannot be written to a path; None if it was."""
    try:
        formats.put(path, mesh, {})
    except FormatError as error:
        return str(error)
    return None


@pytest.mark.filterwarnings("ignore::RuntimeWarning:meshio")
@pytest.mark.parametrize("dim", [2, 3])
def test_no_format_of_meshio_loses_a_cell_without_an_error(tmp_path, dim):
    mesh, kind = rich(dim)[0], {2: "triangle", 3: "tetra"}[dim]
    known = [s for s in meshio.extension_to_filetypes if formats.is_known(f"m{s}")]
    written = set()
    for suffix in sorted(set(known) - CARRIED.keys()):
        path = tmp_path / suffix / f"m{suffix}"
        path.parent.mkdir()
        if why := refusal(path, mesh):
            assert "place for t" in why or "meshio fails" in why or "SVG can only" in why
            assert list(path.parent.iterdir()) == []
            continue
        assert not any(".part" in beside.name for beside in path.parent.iterdir())
        if suffix != ".svg":  # meshio does not read it
            assert len(meshio.read(path).cells_dict[kind]) == mesh.n_cells
        written.add(suffix)
    surfaces, volumes = {".obj", ".off", ".ply", ".stl", ".wkt"}, {".cgns", ".ele", ".node"}
    assert written >= {".dat", ".inp", ".vol", ".xml"} | (surfaces if dim == 2 else volumes)
    assert not written & (volumes if dim == 2 else surfaces)


def test_a_volume_goes_to_no_file_of_triangles(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    formats.write("in.vtu", two_region_cube())
    for more in ([], ["--dry-run"]):
        assert main(["convert", "in.vtu", "out.stl", *more]) == 2
        said = capsys.readouterr().err
        assert "cannot write" in said
        assert "files .stl have no place for tetrahedra, the mesh has 48" in said
    assert [path.name for path in tmp_path.iterdir()] == ["in.vtu"]


def test_what_meshio_warns_of_is_told_as_lost(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    formats.write("in.vtu", two_regions())
    assert main(["convert", "in.vtu", "out.stl"]) == 0
    assert "lost: all, as meshio says: Warning: STL can only write" in capsys.readouterr().out


def test_fields_at_nodes_of_cells_are_lost_everywhere():
    mesh = square(1)
    fields = {"p": Field(np.zeros((2, 3)), "cell_nodes")}
    assert losses(mesh, fields, "m.vtu") == ["the fields at nodes of cells ('p')"]
    assert holdable(mesh, fields, "m.vtu") == {}


def test_a_dry_run_says_what_would_be_lost_and_writes_nothing(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    mesh, fields = rich(2)
    formats.write("in.vtu", mesh, fields)
    assert main(["convert", "in.vtu", "out.su2", "--dry-run"]) == 0
    told = capsys.readouterr().out
    assert "would be lost: the height z = 0.3\n" in told
    assert "would be lost: the fields in cells ('k', 'label', 'large')\n" in told
    assert [path.name for path in tmp_path.iterdir()] == ["in.vtu"]
    assert main(["convert", "in.vtu", "out.su2"]) == 0
    assert capsys.readouterr().out == told.replace("would have", "has").replace("would be ", "")
    assert formats.read("out.su2")[0].n_cells == mesh.n_cells
    assert main(["convert", "in.vtu", "again.vtu"]) == 0
    assert "nothing lost" in capsys.readouterr().out


def test_a_dry_run_finds_what_cannot_be_written_and_json_has_what_is_lost(
    tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    mesh = square(1)
    formats.write("in.vtu", mesh, {'u"': np.zeros(4)})
    assert main(["convert", "in.vtu", "out.msh", "--dry-run"]) == 2
    assert "a quote or line break" in capsys.readouterr().err
    assert main(["convert", "in.vtu", "out.su2", "--dry-run", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert any("fields at points" in text for text in report["lost"])


def test_writing_warns_of_what_is_lost(tmp_path, caplog):
    mesh, _ = rich(2)
    formats.write(tmp_path / "m.meshb", mesh)
    assert "this format does not carry the height z = 0.3" in caplog.text
    assert "does not carry the names of facets" in caplog.text


def test_markers_of_su2_get_names_without_blanks(tmp_path, caplog):
    mesh, _ = rich(2)
    names = {**mesh.names, (1, int(mesh.facet_tags[0])): "hole big"}
    mesh = Mesh(**{**mesh.arrays(), "names": names})
    path = tmp_path / "m.su2"
    told = "blanks in the names of facets: 'hole big' becomes 'hole_big'"
    assert told in losses(mesh, {}, path)
    formats.write(path, mesh)
    assert told in caplog.text
    again, _ = formats.read(path)
    assert validate(again) == []
    assert len(again.facets_of("hole_big")) == len(mesh.facets_of("hole big"))
    first, second = np.unique(mesh.facet_tags)[:2].tolist()
    clash = {(1, first): "a b", (1, second): "a_b"}
    with pytest.raises(FormatError, match="two markers of SU2 would be called 'a_b'"):
        formats.write(path, Mesh(**{**mesh.arrays(), "names": clash}))
