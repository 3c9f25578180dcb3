"""3D views of the report turn in a browser, from the page alone."""

import base64
import json
import re
import shutil
import subprocess

import numpy as np
import pytest
from meshes import cube

import anistar
from anistar.loops.loop import Step
from anistar.runs.folder import RunFolder

pytest.importorskip("matplotlib")
from anistar.demo.volume import unit_cube
from anistar.meshes.plotted import Subject
from anistar.runs.html_report import write_html_report
from anistar.views import web_view
from anistar.views.scene import scene

CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")

# Touches the first view, turns it, and tells what could be seen before and after.
PROBE = """<script>
addEventListener("error", (event) => { document.title = "error: " + event.message; });
addEventListener("load", () => {
  const ink = (canvas) => {
    const gl = canvas.getContext("webgl2");
    const pixels = new Uint8Array(4 * canvas.width * canvas.height);
    gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let count = 0, sum = 0;
    for (let i = 0; i < pixels.length; i += 4)
      if (pixels[i] < 250) { count++; sum += (i * pixels[i]) % 9973; }
    return { share: count / (pixels.length / 4), sum };
  };
  const touch = (element, kind, more) => element.dispatchEvent(
    new PointerEvent(kind, { bubbles: true, cancelable: true, ...more }));
  touch(document.querySelector("figure.turns img"), "pointerdown", {});
  const canvas = document.querySelector("canvas");
  const before = ink(canvas);
  touch(canvas, "pointermove", { buttons: 1, movementX: 70, movementY: 10 });
  document.title = JSON.stringify([before, ink(canvas)]);
});
</script></body>"""


@pytest.fixture
def page(tmp_path):
    """A page about a loop of one solve in 3D."""
    mesh = unit_cube(4)
    assert anistar.validate(mesh) == []
    fields = {"u": mesh.points[:, 0]}
    RunFolder(tmp_path, {}).save(Step(0, None, mesh, fields, None, None, None, {"u": 0.1}, 1.0))
    write_html_report(tmp_path, tmp_path / "page.html")
    return tmp_path / "page.html"


def test_the_page_holds_the_surfaces_and_the_program_and_loads_nothing(page):
    text = page.read_text()
    assert text.count('<figure class="turns">') == 2
    assert text.count("class View") == 1
    assert re.findall(r"(?:src|href)=[\"'](?!data:)", text) == []
    assert "http" not in text.replace("http-equiv", "")
    data = json.loads(re.search(r'<script type="application/json">(.*?)</script>', text)[1])
    triangles = np.frombuffer(base64.b64decode(data["triangles"]), "<u4").reshape(-1, 3)
    points = np.frombuffer(base64.b64decode(data["points"]), "<u2").reshape(-1, 3) / 65535
    assert len(triangles) == 6 * 2 * 16
    assert len(points) == triangles.max() + 1 == 98
    corners = points[triangles]
    areas = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    assert areas.sum() / 2 == pytest.approx(6.0, rel=1e-3)


def test_a_large_surface_stays_a_picture(monkeypatch):
    monkeypatch.setattr(web_view, "MOST_TRIANGLES", 10)
    mesh = cube()
    seen = scene(Subject(mesh=mesh), mesh.points[:, 0])
    figure = web_view.turning_figure(seen, "data:image/png;base64,", "a < b", (0.0, 1.0))
    assert "turns" not in figure
    assert "a &lt; b" in figure


@pytest.mark.skipif(CHROMIUM is None, reason="no chromium on PATH: apt-get install chromium")
def test_a_view_turns_in_a_browser_without_an_error(page, tmp_path):
    page.write_text(page.read_text().replace("</body>", PROBE))
    words = [
        CHROMIUM, "--headless", "--no-sandbox", "--no-first-run", "--use-gl=angle",
        "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--enable-logging=stderr",
        "--disable-background-networking", f"--user-data-dir={tmp_path}/profile", "--dump-dom",
    ]  # fmt: skip
    done = subprocess.run(
        [*words, page.as_uri()], capture_output=True, text=True, timeout=120, check=True
    )
    # a busy machine has the driver say that reading pixels waited
    told = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
    assert [line for line in told if "OpenGL, Performance" not in line] == []
    title = done.stdout.partition("<title>")[2].partition("</title>")[0]
    before, after = json.loads(title)
    assert 0.1 < before["share"] < 0.9
    assert 0.1 < after["share"] < 0.9
    assert before["sum"] != after["sum"]
