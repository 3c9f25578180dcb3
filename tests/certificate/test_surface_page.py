"""The code of the page on surface stars runs, and its tables are those of the script."""

import pytest
from documents import ROOT, code_blocks, rows_below, run_script, script_of_docs

from anistar import ConsistencyOptions

PAGE = (ROOT / "docs" / "surface-stars.md").read_text()


@pytest.fixture(scope="module")
def script():
    pytest.importorskip("matplotlib")
    return script_of_docs("make_surface_tables")


def test_a_facet_is_checked_by_hand_as_the_page_does_it(tmp_path):
    code = "\n\n".join(code_blocks("docs/surface-stars.md", "python"))
    assert "surface_star_ok = " in run_script(tmp_path, code)


def test_the_conditions_of_the_theorem_are_solved(script):
    rows = rows_below(PAGE, r"| $\Gamma$ |")
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
    stars = [0.0, 0.0, 0.0]
    facets = 0
    for complexity in (500.0, 600.0, 700.0):
        monkeypatch.setattr(script, "COMPLEXITY", complexity)
        body = script.ball(6)
        made = script.outcomes(body, script.layer_in(body))
        facets += made[1].certificate.surface_stars[1]
        for k, one in enumerate(made):
            stars[k] += one.certificate.surface_stars[0]
    assert stars[0] < 0.7 * facets
    assert stars[1] > 0.93 * facets
    assert stars[2] > 0.96 * facets
    shown = rows_below(PAGE, "| body, metric |")
    assert {len(cells) for cells in shown} == {len(script.row_of("a body", made))}
    assert [cells[0].split(",")[0] for cells in shown if "layer" in cells[0]] == list(script.BODIES)


def test_the_picture_is_drawn_and_small(script, tmp_path):
    script.draw(tmp_path)
    assert 10_000 < (tmp_path / "surface-star.png").stat().st_size < 200_000
    assert (ROOT / "docs" / "images" / "surface-star.png").stat().st_size < 200_000
