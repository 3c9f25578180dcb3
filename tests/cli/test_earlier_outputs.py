"""`study` and `demo` replace what an earlier one left only when they are told to."""

from pathlib import Path

import pytest
from meshes import square

from anistar.cli import main
from anistar.demo import volume as demo_volume
from anistar.demo.result import DEMO_FILES, PICTURES, VOLUME_PICTURES
from anistar.formats import write
from anistar.runs.own_files import OwnFiles


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write("in.vtu", square(4))
    return tmp_path


def study(*more):
    words = "study in.vtu --exact x*x --complexities 30,60 --repeats 1"
    return main([*words.split(), *more])


def test_study_replaces_its_table_only_when_told(folder, monkeypatch, capsys):
    assert study("--csv", "s.csv") == 0
    Path("s.csv").write_text("mine")
    for flag, path in (("--csv", "s.csv"), ("--csv", "./s.csv"), ("--picture", "old.png")):
        Path("old.png").write_text("mine")
        with monkeypatch.context() as guard:
            guard.setattr(
                "anistar.cli.commands.study.convergence_study",
                lambda *_, **__: pytest.fail("it ran"),
            )
            assert study(flag, path) == 2
        said = f"{path.removeprefix('./')} exists: --force replaces it, or choose another name"
        assert said in capsys.readouterr().err
        assert Path(path).read_text() == "mine"
    assert study("--csv", "s.csv", "--force") == 0
    assert Path("s.csv").read_text().startswith("kind,complexity")


def test_study_never_replaces_its_input_nor_writes_where_it_cannot(folder, monkeypatch, capsys):
    monkeypatch.setattr(
        "anistar.cli.commands.study.convergence_study", lambda *_, **__: pytest.fail("it ran")
    )
    before = Path("in.vtu").read_bytes()
    assert study("--csv", "in.vtu", "--force") == 2
    assert "cannot write in.vtu: it is the input" in capsys.readouterr().err
    assert study("--csv", "gone/s.csv") == 2
    assert "cannot write gone/s.csv: no such folder gone" in capsys.readouterr().err
    assert Path("in.vtu").read_bytes() == before


def test_demo_replaces_an_earlier_demo_only_when_told(folder, monkeypatch, capsys):
    mine = ["notes.txt", "mine.png", "channel_mean.vtu"]
    old = ["report.json", "channel.pvd", "channel_005.vtu", "front_001.vtu", *PICTURES]
    Path("anistar-demo-3d").mkdir()
    for name in [*mine, *old]:
        Path("anistar-demo-3d", name).write_text("old")
    with monkeypatch.context() as guard:
        guard.setattr(demo_volume, "run_volume_demo", lambda *_, **__: pytest.fail("it ran"))
        assert main(["demo", "--dim", "3"]) == 2
    said = capsys.readouterr().err
    assert "anistar-demo-3d holds an earlier run (channel.pvd, channel_005.vtu, " in said
    assert said.endswith(": --force replaces it, or choose another folder\n")
    words = "demo --dim 3 --force --complexities 60,90"
    assert main(words.split()) == 0
    assert "anistar-demo-3d: 11 files of an earlier run removed" in capsys.readouterr().out
    new = {"report.json", "front.pvd", "front_000.vtu", "front_001.vtu", "front_002.vtu"}
    new |= set(VOLUME_PICTURES)
    found = {path.name for path in Path("anistar-demo-3d").iterdir()}
    assert found == {*mine, *new}
    own = OwnFiles(Path("anistar-demo-3d"), DEMO_FILES).found()
    assert {path.name for path in own} == new
