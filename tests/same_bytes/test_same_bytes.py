"""The same input gives the same bytes whatever NumPy and the C library choose for the CPU."""

import json
import sys
from pathlib import Path

import pytest
from cpu_levels import Level, libm_levels, output_at, simd_levels

RESULTS = Path(__file__).with_name("printed_digests.py")


def made_at(level):
    return json.loads(output_at(level, [sys.executable, str(RESULTS)]))


@pytest.fixture(scope="module")
def plain():
    return made_at(Level(name="as this CPU is", variables={}))


@pytest.mark.parametrize("level", [*simd_levels(), *libm_levels()], ids=lambda level: level.name)
def test_every_result_has_the_same_bytes_with_other_loops_and_another_libm(level, plain):
    made = made_at(level)
    assert level.took_effect(made["level"], plain["level"])
    assert made["digests"] == plain["digests"]
