"""``anistar report``."""

from __future__ import annotations

import argparse
from pathlib import Path

from .. import console

SUMMARY = "make one HTML page about a loop"
EXAMPLE = "anistar report run -o run.html"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("folder", help="what anistar loop left")
    parser.add_argument("-o", "--output", help="HTML file (default: report.html in the folder)")


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    from ...runs.html_report import write_html_report  # matplotlib is optional

    path = Path(arguments.output or Path(arguments.folder) / "report.html")
    write_html_report(arguments.folder, path)
    if arguments.json:
        console.show_json({"path": path})
    else:
        console.say(f"{path}: open it in a browser")
    return 0
