"""What is printed is one line of what matters; a notebook gets a table."""

from html.parser import HTMLParser

import numpy as np
import pytest
from meshes import cube, square, two_regions

import anistar
from anistar.metric.base.told import MOST_ROWS, html_table


@pytest.fixture(scope="module")
def results():
    mesh = two_regions(6)

    def solve(mesh, fields):
        return {"u": np.tanh(9 * mesh.points[:, 0])}

    fields = solve(mesh, {})
    done = anistar.adapt(mesh, fields, anistar.AdaptOptions.from_dict({"target_complexity": 60}))
    assert anistar.validate(done.mesh, mesh) == []
    loop = anistar.adapt_loop(solve, mesh, anistar.LoopOptions(complexities=(50,)))
    study = anistar.convergence_study(
        solve, mesh, (40, 80), error=lambda mesh, fields: 1 / mesh.n_points, repeats=1
    )
    unsteady = anistar.unsteady_loop(
        lambda mesh, fields, begin, end: fields, mesh, solve(mesh, {}), (0.0, 1.0),
        anistar.UnsteadyOptions(adapt=anistar.AdaptOptions.from_dict({"target_complexity": 40})),
    )  # fmt: skip
    found = (
        mesh, done, anistar.remesh(done.mesh, done.metric), done.report, done.report.remesh,
        done.report.metric, done.report.transfer, loop, loop.steps[-1], study, unsteady,
        unsteady.last, anistar.certify(done.mesh, done.metric), anistar.Field(fields["u"]),
        anistar.transfer(mesh, fields, done.mesh, outside="nearest"),
    )  # fmt: skip
    return {type(one).__name__: one for one in found}


NAMES = {
    "Mesh": "n_points=49",
    "Adapted": "edge_unit=",
    "Remeshed": "q_min=",
    "AdaptReport": "metric_fields=u",
    "RemeshReport": "star_ok=",
    "Ledger": "target_complexity=60",
    "TransferReport": "method=interpolate",
    "Loop": "stop_reason=complexities done",
    "Step": "iteration=1",
    "Study": "order=",
    "Unsteady": "windows=1",
    "Instant": "time=1",
    "Certificate": "is_certified=",
    "Field": "kind=scalar, on=points",
    "Transferred": "fields=u",
}


class Balanced(HTMLParser):
    """Checks that every element is closed, and collects what is said."""

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.said = [], [], ""
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        if tag != "path":
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.tags.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.said += data


@pytest.mark.parametrize("name", NAMES)
def test_printed_it_is_one_line_of_what_matters(results, name):
    said = repr(results[name])
    assert said.startswith(f"{name}(")
    assert NAMES[name] in said
    assert "\n" not in said
    assert len(said) < 400


@pytest.mark.parametrize("name", NAMES)
def test_a_notebook_shows_a_table(results, name):
    page = Balanced(results[name]._repr_html_())
    assert name in page.said
    assert "tr" in page.tags


def test_a_small_mesh_is_drawn_in_the_notebook_and_others_are_not(results):
    assert Balanced(square(4)._repr_html_()).tags.count("path") == 2
    assert "svg" in Balanced(results["Adapted"]._repr_html_()).tags
    assert "svg" not in Balanced(square(60)._repr_html_()).tags
    assert "svg" not in Balanced(cube()._repr_html_()).tags


def test_names_in_tables_are_text_and_long_tables_are_cut():
    page = html_table(("a",), [("<b>",)] * (MOST_ROWS + 5))
    assert "<b>" not in page
    assert page.count("<tr>") == MOST_ROWS + 2
    assert "…" in page
