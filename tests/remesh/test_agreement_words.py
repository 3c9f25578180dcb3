"""What a report says of agreement."""

from types import SimpleNamespace

import pytest

from anistar._core import AgreementOutcome, AgreementStop, StopReason
from anistar.remeshing.report.verdict import agreement_text


def report(outcome, **known):
    silent = {
        "stopped_by": StopReason.finished,
        "percent": 0,
        "ln_gamma": 0.0,
        "largest_ln_gamma": 0.0,
        "stop": AgreementStop.agreed,
        "disagreeing": 0,
    }
    return SimpleNamespace(outcome=outcome, **{**silent, **known})


@pytest.mark.parametrize(
    ("outcome", "known", "in_2d", "in_3d"),
    [
        ("off", {}, "off", "off"),
        ("done", {}, "done", "done"),
        (
            "done",
            {"stop": AgreementStop.trials, "disagreeing": 12},
            "done",
            "done, too many trials with 12 facets left",
        ),
        (
            "stopped",
            {
                "stopped_by": StopReason.max_seconds,
                "stop": AgreementStop.interrupted,
                "disagreeing": 3,
            },
            "stopped by max_seconds",
            "done, interrupted with 3 facets left",
        ),
        (
            "stopped_before",
            {"stopped_by": StopReason.max_vertices},
            "skipped: stopped by max_vertices",
            "skipped: stopped by max_vertices",
        ),
        (
            "varies_too_fast",
            {"percent": 99, "ln_gamma": 0.8765432109, "largest_ln_gamma": 0.6},
            "skipped: the metric varies too fast, ln gamma of 1 % of the edges is above 0.876543",
            "skipped: the metric varies too fast, ln gamma p99 0.88 > 0.6",
        ),
    ],
)
def test_what_became_of_agreement_is_put_into_words(outcome, known, in_2d, in_3d):
    found = report(AgreementOutcome[outcome], **known)
    assert [agreement_text(found, dim) for dim in (2, 3)] == [in_2d, in_3d]
