"""``anistar doctor``."""

from __future__ import annotations

import argparse

from .. import console
from ..diagnosis import diagnose

SUMMARY = "check this installation"
EXAMPLE = "anistar doctor"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command: there are none."""


def run(arguments: argparse.Namespace) -> int:
    """Run the command; 1 if something is broken."""
    diagnosis = diagnose()
    if arguments.json:
        console.show_json(diagnosis)
    else:
        rows = [[item.name, item.state, item.detail] for item in diagnosis.findings]
        console.show_table("anistar doctor", ["part", "state", "detail"], rows)
    return 0 if diagnosis.is_sound else 1
