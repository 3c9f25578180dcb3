"""The code of the page on surface stars runs, and its tables are those of the script."""

import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import pytest

from anistar import ConsistencyOptions

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGE = (DOCS / "surface-stars.md").read_text()


@pytest.fixture(scope="module")
def script():
    pytest.importorskip("matplotlib")
    sys.path.insert(0, str(DOCS))
    spec = importlib.util.spec_from_file_location(
        "make_surface_tables", DOCS / "make_surface_tables.py"
    )
    module = importlib.util.module_from_spec(spec)
    sys.modules["make_surface_tables"] = module  # where dataclasses look
    spec.loader.exec_module(module)
    yield module
    sys.path.remove(str(DOCS))


def rows_below(head):
    lines = PAGE[PAGE.index(head) :].splitlines()[2:]
    table = lines[: next(k for k, line in enumerate(lines) if not line.startswith("|"))]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table]


def test_a_facet_is_checked_by_hand_as_the_page_does_it(tmp_path):
    blocks = re.findall(r"^```python\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)
    (tmp_path / "page.py").write_text("\n\n".join(blocks))
    done = subprocess.run(
        [sys.executable, "-W", "error", "page.py"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "surface_star_ok = " in done.stdout


def test_the_conditions_of_the_theorem_are_solved(script):
    rows = rows_below(r"| $\Gamma$ |")
    ours = ConsistencyOptions()
    defaults = [ours.delta, ours.rho_0, ours.beta, 0.5 * ours.alpha_0]
    assert [float(cell) for cell in rows[-1][2:6]] == pytest.approx(defaults)
    assert len(rows) == len(script.CONSTANTS) + 1
    for row, constants in zip(rows, script.CONSTANTS, strict=False):
        assert [float(cell) for cell in row[:3]] == list(constants)
        Gamma, gamma_0, delta = constants
        rho_0, beta, *alphas = (float(cell) for cell in row[3:])
        factor = 5 * (1 + delta) * Gamma**2 * gamma_0**8 / (1 - delta) ** 2
        assert rho_0 == pytest.approx(factor, rel=1e-2)
        assert beta == pytest.approx(factor * (1 + delta), rel=1e-2)
        least = script.largest_alpha_1(*constants, alpha_0=ours.alpha_0, rho_0=rho_0, beta=beta)
        assert alphas == pytest.approx(list(least), rel=2e-2)
        # (52) follows from the others
        bound = (1 - delta) / (1 + delta) / (40 * gamma_0**7)
        assert min(alphas) <= 1.02 * bound


def test_the_bodies_come_out_as_the_table_tells(script, monkeypatch):
    monkeypatch.setattr(script, "COMPLEXITY", 500.0)
    body = script.ball(6)
    made = script.outcomes(body, script.layer_in(body))
    row = script.row_of("ball, layer", made)
    (shown,) = [cells for cells in rows_below("| body, metric |") if cells[0] == "ball, layer"]
    assert len(row) == len(shown)
    stars = [one.certificate.as_dict()["surface_star_ok"] for one in made]
    assert stars[0] < 0.7
    assert stars[1] > 0.97
    assert stars[2] >= stars[1] - 0.01


def test_the_picture_is_drawn_and_small(script, tmp_path):
    script.draw(tmp_path)
    assert 10_000 < (tmp_path / "surface-star.png").stat().st_size < 200_000
    assert (DOCS / "images" / "surface-star.png").stat().st_size < 200_000
