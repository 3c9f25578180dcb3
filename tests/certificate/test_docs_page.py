"""The code of the page on certificates runs, and its tables are those of the script."""

import re

import pytest
from documents import ROOT, code_blocks, rows_below, run_script, script_of_docs

DOCS = ROOT / "docs"
PAGE = (DOCS / "certificate.md").read_text()


@pytest.fixture(scope="module")
def script():
    pytest.importorskip("matplotlib")
    return script_of_docs("make_certificate_pictures")


@pytest.fixture(scope="module")
def tables():
    return script_of_docs("make_certificate_tables")


def rows_of(header):
    return rows_below(PAGE, header)


def test_a_star_is_checked_by_hand_as_the_page_does_it(tmp_path):
    said = run_script(tmp_path, "\n\n".join(code_blocks("docs/certificate.md", "python")))
    assert said.startswith("certified: star_ok = 1 (")
    assert "is" in said
    assert re.search(r"vertex \d+ is 0\.\d+ from the centre", said)
    (shown,) = code_blocks("docs/certificate.md", "text")
    assert said.endswith(shown)


def test_a_layer_that_is_better_resolved_has_more_certified_stars(tables):
    coarse, finer = tables.resolve(0.025), tables.resolve(0.014)
    assert coarse[-1].startswith("skipped: the metric varies too fast")
    assert finer[-1].startswith("done")
    assert float(coarse[3]) < 0.5 < 0.8 < float(finer[3])
    shown = [float(row[0]) for row in rows_of("| largest $h / ")]
    asked = [scale * tables.LARGEST_GROWTH / tables.THICKNESS for scale in tables.SCALES]
    assert shown == pytest.approx(asked, abs=0.05)


def test_the_tables_show_what_was_asked_for(tables, monkeypatch):
    monkeypatch.setattr(tables, "TIMED", 1)
    small = tables.Case(name="small", field=tables.turning(0.8, 0.1))
    made = tables.outcomes(small)
    shares = [one.certificate.star_ok.mean() for one in made]
    assert shares[0] < 0.8 < shares[1] <= shares[2] <= shares[3] == 1
    heads = (
        "| metric | $\\ln\\gamma$: p90",
        "| $\\ln\\gamma$ | below .1",
        "| metric | vertices | cells",
    )
    for head, row in zip(heads, ("of_agreement", "of_classes", "of_consistency"), strict=True):
        assert {len(cells) for cells in rows_of(head)} == {len(getattr(tables, row)(made[-1]))}


def test_the_table_of_constants_solves_the_inequalities_of_the_theorem(script):
    rows = rows_of(r"| $\gamma_0$ |")
    assert [float(row[0]) for row in rows] == list(script.GAMMAS)
    for row in rows:
        gamma = float(row[0])
        for k, delta in enumerate(script.DELTAS):
            rho, beta, angle = (float(cell.strip("°")) for cell in row[1 + 3 * k : 4 + 3 * k])
            assert (1 - delta) * rho / gamma**3 == pytest.approx(2, rel=5e-3)
            assert (1 - delta) * beta / (gamma**3 * (1 + delta)) == pytest.approx(2, rel=5e-3)
            assert angle == pytest.approx(script.smallest_constants(gamma, delta)[2], abs=0.06)


def test_the_pictures_are_made_and_small(script, tmp_path, monkeypatch):
    monkeypatch.setattr(script, "RUNS", {"slow-before": script.RUNS["slow-before"]})
    row = script.make("slow-before", script.disk(0.1), tmp_path)
    failing = [int(part) for part in row[3].split(" / ")]
    assert failing[0] < failing[1]
    assert (tmp_path / "certificate-slow-before.png").stat().st_size < 200_000
    for name in script.SHOWN:
        assert (DOCS / "images" / f"certificate-{name}.png").stat().st_size < 200_000
