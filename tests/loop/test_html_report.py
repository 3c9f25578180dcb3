"""The page about a loop is one file, complete, and a browser shows it."""

import json
import shutil
import subprocess
from html.parser import HTMLParser

import numpy as np
import pytest
from meshes import cube, square

import anistar
from anistar.base.errors import FormatError
from anistar.cli import main
from anistar.loops.loop import LoopOptions, adapt_loop
from anistar.runs.folder import RunFolder

pytest.importorskip("matplotlib")

from anistar.runs.html_report import write_html_report

CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")


def solve(mesh, fields):
    return {"<heat>": np.tanh(10 * (mesh.points.sum(axis=1) - 1.1)), "v": mesh.points}


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = RunFolder(tmp_path_factory.mktemp("run"), {"command": "solver {mesh} {solution}"})
    folder.close(
        adapt_loop(solve, square(6), LoopOptions(complexities=(60, 120)), callback=folder.save)
    )
    return folder.folder


class Page(HTMLParser):
    """Counts elements, collects text, and checks that every element is closed."""

    def __init__(self, text):
        super().__init__()
        self.open, self.count, self.sources, self.said = [], {}, [], ""
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        self.count[tag] = self.count.get(tag, 0) + 1
        self.sources += [value for name, value in attributes if name in ("src", "href")]
        if tag not in ("meta", "img"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.said += data


def test_the_page_is_one_file_that_needs_no_other(run, tmp_path):
    write_html_report(run, tmp_path / "page.html")
    page = Page((tmp_path / "page.html").read_text())
    assert page.sources
    assert all(source.startswith("data:image/png;base64,") for source in page.sources)


def test_the_page_shows_every_iteration_with_pictures_histograms_and_tables(run, tmp_path):
    write_html_report(run, tmp_path / "page.html")
    page = Page((tmp_path / "page.html").read_text())
    # Convergence; mesh and one scalar for each of three meshes; two histograms for each new one.
    assert page.count["img"] == 1 + 3 * 2 + 2 * 2
    report = json.loads((run / "report.json").read_text())
    for step in report["steps"]:
        assert f"Iteration {step['iteration']}: {step['points']} points" in page.said
    for words in (
        "complexities done",
        "certified stars",
        "The mesh. Certified: star_ok = 1 (",
        "bottom",
        "integral",
        "v[1]",
    ):
        assert words in page.said


def test_names_are_shown_as_they_are_and_not_as_markup(run, tmp_path):
    write_html_report(run, tmp_path / "page.html")
    assert "<heat>" not in (tmp_path / "page.html").read_text()
    assert "The field <heat>." in Page((tmp_path / "page.html").read_text()).said


def test_the_command_writes_into_the_folder(run, capsys):
    assert main(["report", str(run)]) == 0
    assert "report.html" in capsys.readouterr().out.replace("\n", "")
    assert (run / "report.html").stat().st_size > 100_000


def test_a_page_about_a_3d_loop_shows_the_mesh_from_outside_and_cut(tmp_path):
    folder = RunFolder(tmp_path, {})
    mesh = cube()
    folder.save(
        anistar.loops.loop.Step(
            0, None, mesh, {"u": mesh.points[:, 0]}, None, None, None, {"u": 0.1}, 1.0
        )
    )
    write_html_report(tmp_path, tmp_path / "page.html")
    page = Page((tmp_path / "page.html").read_text())
    assert "The mesh and the field u." in page.said
    assert "u, the half with small x." in page.said


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (None, "cannot read .*report.json: No such file"),
        ("{", "is no report of a loop"),
        ('{"stop_reason": "x", "steps": []}', "it has no finished step"),
    ],
)
def test_a_folder_without_a_loop_is_refused(tmp_path, content, message):
    if content is not None:
        (tmp_path / "report.json").write_text(content)
    with pytest.raises(FormatError, match=message):
        write_html_report(tmp_path, tmp_path / "page.html")


@pytest.mark.skipif(CHROMIUM is None, reason="no chromium on PATH: ./bootstrap.sh programs")
def test_a_browser_shows_the_page(run, tmp_path):
    """Without a server; pictures that did not decode would have no size."""
    path = tmp_path / "page.html"
    write_html_report(run, path)
    probe = (
        "<script>addEventListener('load', () => { document.title = [...document.images].filter("
        "image => image.naturalWidth > 100).length + ' pictures, ' + "
        "document.querySelectorAll('tbody tr').length + ' rows' })</script></body>"
    )
    path.write_text(path.read_text().replace("</body>", probe))
    words = [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom"]
    words += ["--no-first-run", "--disable-background-networking"]
    done = subprocess.run(
        [*words, f"--user-data-dir={tmp_path}/profile", path.as_uri()],
        capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    title = done.stdout.partition("<title>")[2].partition("</title>")[0]
    assert title.startswith("11 pictures, ")
    assert int(title.split()[2]) > 20
