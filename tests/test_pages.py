"""Every command of every page is understood, and the code of the pages without a test runs."""

import re
import shlex

import numpy as np
import pytest
from documents import ROOT, code_blocks
from meshes import square

import anistar
from anistar.cli.main import parser
from anistar.cli.options import canonical_flags

PAGES = [
    "README.md",
    "CONTRIBUTING.md",
    *sorted(str(path.relative_to(ROOT)) for path in (ROOT / "docs").rglob("*.md")),
]


def commands(page):
    """Every command in a block for the shell, and those in the text that are complete."""
    for block in code_blocks(page, "sh"):
        for line in block.replace("\\\n", " ").splitlines():
            words = shlex.split(line, comments=True)
            if words and words[0].removeprefix(".venv/bin/") == "anistar":
                yield words[1:]
    for text in re.findall(
        r"`(?:\.venv/bin/)?(anistar [^`]* -o [^`]*)`", (ROOT / page).read_text()
    ):
        yield shlex.split(text)[1:]


COMMANDS = [(page, words) for page in PAGES for words in commands(page)]


@pytest.mark.parametrize(("page", "words"), COMMANDS, ids=lambda part: " ".join(part)[:40])
def test_a_command_of_the_pages_is_understood(page, words):
    parser().parse_args(canonical_flags(words))


def test_the_commands_that_the_contributors_read_of_are_targets_of_the_makefile():
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    named = set(re.findall(r"`make ([a-z-]+)", (ROOT / "CONTRIBUTING.md").read_text()))
    shown = set(re.findall(r"^([a-z-]+):.*##", (ROOT / "Makefile").read_text(), re.MULTILINE))
    assert named <= targets
    assert shown - named == {"help", "demo", "clean"}


def test_pages_link_to_pages_that_exist():
    for page in PAGES:
        folder = (ROOT / page).parent
        text = re.sub(r"```.*?```", "", (ROOT / page).read_text(), flags=re.DOTALL)
        for link in re.findall(r"\]\((?!https?:|#)([^)#]+)", text):
            if "auto_examples" in link:
                script = link.partition("auto_examples/")[2].replace(".rst", ".py")
                script = script.replace("index.py", "GALLERY_HEADER.rst")
                target = ROOT / "solver_examples" / script
            else:
                target = folder / link
            assert target.exists(), f"{page}: {link}"


def test_the_code_of_the_page_on_recovery_runs():
    (code,) = code_blocks("docs/metric-recovery.md", "python")
    mesh = square(8)
    x, y = mesh.points.T
    names = {"anistar": anistar, "mesh": mesh, "u": x**2 + x * y, "v": y**2}
    exec(code, names)
    assert np.allclose(names["H"], [[2, 1], [1, 0]], atol=1e-8)
    assert np.allclose(names["both"]["u"], names["H"])
    assert names["g"].shape == (mesh.n_points, 2)
    assert (names["trust"].order == 2).all()
    assert names["ledger"].reached


def test_the_code_of_the_page_on_seeing_prints_a_line_and_leaves_pictures(
    tmp_path, monkeypatch, capsys
):
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    anistar.write("in.vtu", square(8))
    code = "".join(code_blocks("docs/how-to/seeing.md", "python"))
    names = {}
    exec(code.replace("path=", 'backend="matplotlib", path='), names)
    assert anistar.validate(names["done"].mesh, square(8)) == []
    first, second = capsys.readouterr().out.splitlines()
    assert first.startswith("Adapted(points=")
    assert second.startswith("about ")
    sizes = {path.name: path.stat().st_size for path in tmp_path.glob("*.png")}
    assert sizes.keys() == {"tags.png", "u.png", "quality.png", "certificate.png"}
    assert min(sizes.values()) > 10_000


def test_the_code_of_the_first_page_adapts_a_file_and_loops(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mesh = square(8)

    def solve(mesh, fields):
        return {"u": np.tanh(20 * (mesh.points.sum(axis=1) - 1))}

    anistar.write("in.vtu", mesh, solve(mesh, {}))
    code = "\n".join(code_blocks("docs/index.md", "python"))
    names = {"solve": solve}
    exec(code.replace("10_000", "300").replace("(1000, 2000, 4000)", "(100, 200)"), names)
    adapted, fields = anistar.read("out.vtu")
    assert anistar.validate(adapted, mesh) == []
    assert set(fields) == {"u"}
    assert anistar.validate(names["loop"].steps[-1].mesh, mesh) == []


def test_the_pipeline_of_the_page_on_vtk_adapts_a_file(tmp_path):
    pytest.importorskip("vtkmodules")
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

    code, *_ = code_blocks("docs/how-to/vtk.md", "python")
    mesh = square(8)
    anistar.write(tmp_path / "in.vtu", mesh, {"pressure": np.tanh(9 * mesh.points[:, 0] - 4)})
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(tmp_path / "in.vtu"))
    names = {"reader": reader}
    exec(code.replace("5000", "300"), names)
    from anistar.adapters.vtk import from_vtk

    new, fields = from_vtk(names["grid"])
    assert anistar.validate(new, mesh) == []
    assert "pressure" in fields


def test_the_code_of_the_page_on_petsc_carries_labels_fields_and_metrics():
    petsc = pytest.importorskip("anistar.adapters.petsc", reason="no petsc4py for Python 3.11")
    _, code, _ = code_blocks("docs/how-to/petsc.md", "python")
    mesh = square(8)
    dm = petsc.to_dmplex(mesh)
    vec = petsc.to_vec(dm, np.tanh(9 * mesh.points[:, 0] - 4))
    options = anistar.AdaptOptions.from_dict({"target_complexity": 300})
    names = {"anistar": anistar, "petsc": petsc, "dm": dm, "vec": vec, "options": options}
    exec(code, names)
    assert anistar.validate(names["done"].mesh, names["mesh"]) == []
    assert names["dm"].getNumLabels() >= dm.getNumLabels()
    assert np.array_equal(petsc.from_vec(names["dm"], names["vec"]), names["done"].fields["u"])
    assert np.allclose(petsc.metric_from_vec(names["dm"], names["metric"]), names["done"].metric)
