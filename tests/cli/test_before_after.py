"""`adapt` and `remesh` say what they did to the mesh, and what should worry."""

import numpy as np
import pytest
from meshes import square

import anistar
from anistar.cli import before_after, main
from anistar.cli.console import Marked, show_table
from anistar.remeshing.report.concerns import level_of


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mesh = square(8)
    anistar.write("in.vtu", mesh, {"u": np.tanh(9 * mesh.points[:, 0])})
    return tmp_path


def rows_of(text):
    """The lines of the tables by their first words, without the marks of rich."""
    return {line.strip().split("  ")[0]: line.split() for line in text.splitlines() if line.strip()}


def test_adapt_prints_both_meshes_their_errors_and_tags(folder, capsys):
    assert (
        main(
            [
                "adapt",
                "in.vtu",
                "-o",
                "out.vtu",
                "--target-complexity",
                "200",
                "--metric-output",
                "m.sol",
            ]
        )
        == 0
    )
    rows = rows_of(capsys.readouterr().out)
    mesh, _ = anistar.read("out.vtu")
    assert anistar.validate(mesh, square(8)) == []
    assert rows["points"] == ["points", "81", str(mesh.n_points)]
    assert rows["cells"] == ["cells", "128", str(mesh.n_cells)]
    before, after = map(float, rows["estimated L2 error of u"][-2:])
    assert after < 0.5 * before
    unit = [float(word) for word in rows["unit edges"] if word[0].isdigit()]
    assert unit[1] > 85 > unit[0]
    assert rows["left"] == ["left", "length", "1", "1"]
    assert "certified stars" in rows


def test_remesh_prints_the_same_table_without_errors(folder, capsys):
    anistar.formats.write_metric("m.sol", square(8), np.tile(300 * np.eye(2), (81, 1, 1)))
    assert main(["remesh", "in.vtu", "--metric", "m.sol", "-o", "out.vtu"]) == 0
    rows = rows_of(capsys.readouterr().out)
    assert {"points", "unit edges", "worst quality", "bottom"} <= rows.keys()
    assert not any(name.startswith("estimated") for name in rows)


@pytest.mark.parametrize(
    ("figure", "fine", "look", "bad"),
    [
        ("change", -0.0005, -0.0038, 0.02),
        ("edge_unit", 0.95, 0.8, 0.5),
        ("edge_max", 1.7, 2.5, 9.0),
        ("q_min", 0.3, 0.05, 0.001),
        ("star_ok", 1.0, 0.999, 0.3),
    ],
)
def test_what_should_worry_is_told_in_two_degrees(figure, fine, look, bad):
    assert [level_of(figure, value) for value in (None, fine, look, bad)] == ["", "", "look", "bad"]


def test_where_there_are_no_colours_there_are_marks(capsys):
    show_table("t", ["a", "b"], [[Marked("1 %", "bad"), Marked("2", "")], [Marked("3", "look"), 4]])
    said = capsys.readouterr().out
    assert "1 % !!" in said
    assert "3 !" in said
    assert "2 !" not in said


def test_a_flag_that_nobody_knows_is_told_by_its_command(folder, capsys):
    assert main(["adapt", "in.vtu", "-o", "out.vtu", "--complexity", "2000"]) == 2
    assert capsys.readouterr().err == (
        "anistar adapt: error: unrecognized arguments: --complexity 2000: did you mean "
        "'--target-complexity'? (see anistar adapt --help)\n"
    )
    assert main(["convert", "in.vtu", "out.vtu", "more"]) == 2
    assert "anistar convert: error: unrecognized arguments: more (" in capsys.readouterr().err


def test_a_table_without_room_for_the_error_goes_without(folder, monkeypatch, capsys, caplog):
    calls = []

    def full(*_):
        calls.append(1)
        if len(calls) > 1:  # after the mesh is written
            assert (folder / "out.vtu").exists()
            raise MemoryError
        return 0.5

    monkeypatch.setattr(before_after, "field_error", full)
    assert main(["adapt", "in.vtu", "--target-complexity", "60", "-o", "out.vtu"]) == 0
    assert anistar.validate("out.vtu") == []
    assert "estimated L2 error of u" in capsys.readouterr().out
    assert "no memory to estimate the error" in caplog.text
