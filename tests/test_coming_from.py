"""What the page for users of other meshers calls anistar's is there."""

import argparse
import ast
import importlib
import inspect
import re
from dataclasses import fields

import pytest
from documents import ROOT

import anistar
from anistar.cli.main import parser
from anistar.cli.options import canonical_flags
from anistar.metric.base.aliases import our_name

PAGE = (ROOT / "docs" / "coming-from.md").read_text()
ROWS = [
    [cell.strip() for cell in row.strip("|").split(" | ")]
    for row in PAGE.splitlines()
    if row.startswith("| ") and not re.match(r"\|[-| ]+\|$", row)
]


def spans(columns):
    """Return the pieces of code in some columns of all tables."""
    cells = [cell for row in ROWS for cell in row[columns]]
    return sorted({span for cell in cells for span in re.findall("`([^`]+)`", cell)})


SPANS, FLAGS = spans(slice(1, 2)), spans(slice(2, None))
OPTIONS = (
    anistar.AdaptOptions,
    anistar.GenerateOptions,
    anistar.LoopOptions,
    anistar.MetricOptions,
    anistar.RemeshOptions,
    anistar.TransferOptions,
    anistar.metric.RecoveryOptions,
)
KEYWORDS = {item.name for options in OPTIONS for item in fields(options)} | set(
    {
        **inspect.signature(anistar.remesh).parameters,
        **inspect.signature(anistar.generate).parameters,
    }
)
COMMANDS = next(
    action.choices for action in parser()._actions if isinstance(action, argparse._SubParsersAction)
)


def named(path):
    """Return what a dotted name below anistar stands for."""
    module, found = "anistar", anistar
    for part in path.split(".")[1:]:
        module += f".{part}"
        found = getattr(found, part, None) or importlib.import_module(module)
    return found


@pytest.mark.parametrize("span", [span for span in SPANS if span.startswith("anistar.")])
def test_a_function_that_the_tables_name_can_be_called(span):
    assert callable(named(re.match(r"[\w.]+", span)[0]))


@pytest.mark.parametrize("span", [span for span in SPANS if span.endswith(")")])
def test_a_call_in_the_tables_has_keywords_that_its_function_takes(span):
    call = ast.parse(span, mode="eval").body
    taken = KEYWORDS | set(inspect.signature(named(ast.unparse(call.func))).parameters)
    assert [word.arg for word in call.keywords if word.arg not in taken] == []


@pytest.mark.parametrize("span", [span for span in SPANS if span.endswith("=")])
def test_a_keyword_that_the_tables_name_is_one(span):
    assert our_name(span.removesuffix("=")) in KEYWORDS


@pytest.mark.parametrize("span", FLAGS)
def test_a_flag_that_the_tables_name_is_one_of_its_command(span):
    command = "adapt" if span.startswith("--") else span.split()[1]
    known = {flag for action in COMMANDS[command]._actions for flag in action.option_strings}
    flags = [word for word in canonical_flags(span.split()) if word.startswith("-")]
    assert [flag for flag in flags if flag not in known] == []


def test_every_table_has_three_columns_and_little_else_in_the_second():
    assert len(ROWS) > 60
    assert {len(row) for row in ROWS} <= {2, 3}
    others = [span for span in SPANS if not span.startswith("anistar.") and span[-1] != "="]
    assert others == ['"auto"', "LoopOptions", "done.fields", "grid.anistar", "mixed"]
