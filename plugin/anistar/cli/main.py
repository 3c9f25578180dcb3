"""Parse the command line, run the command, turn errors into one line and an exit code."""

from __future__ import annotations

import argparse
import sys
import traceback
from collections.abc import Sequence
from contextlib import suppress
from typing import NoReturn

from .. import __version__
from ..base.errors import MeshingError
from ..base.progress import quiet
from ..metric.base.aliases import advice
from .commands import (
    adapt,
    check,
    convert,
    demo,
    doctor,
    generate,
    loop,
    metric,
    remesh,
    report,
    study,
    transfer,
)
from .options import canonical_flags
from .streams import complain, open_closed_streams, readers_may_leave

OK, FAILED, BAD_INPUT = 0, 1, 2

COMMANDS = (
    generate, adapt, metric, remesh, transfer, loop, study, report, check, convert, doctor, demo,
)  # fmt: skip

EXIT_CODES = "exit codes: 0 done, 1 failed (or a check found problems), 2 wrong usage or input"


class OneLineParser(argparse.ArgumentParser):
    """A parser whose errors are one line on stderr."""

    def error(self, message: str) -> NoReturn:
        """Print the error and where help is, and exit with code 2."""
        one_line = " ".join(message.split())
        self.exit(BAD_INPUT, f"{self.prog}: error: {one_line} (see {self.prog} --help)\n")


def parser() -> argparse.ArgumentParser:
    """Return the parser of all commands."""
    top = OneLineParser(
        prog="anistar",
        description="Anisotropic mesh adaptation for any PDE code.",
        epilog=EXIT_CODES,
        allow_abbrev=False,
    )
    top.add_argument("--version", action="version", version=f"anistar {__version__}")
    commands = top.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for module in COMMANDS:
        name = module.__name__.rpartition(".")[2]
        command = commands.add_parser(
            name,
            help=module.SUMMARY,
            description=f"{module.SUMMARY[0].upper()}{module.SUMMARY[1:]}.",
            epilog=f"example:\n  {module.EXAMPLE}\n\n{EXIT_CODES}",
            formatter_class=argparse.RawDescriptionHelpFormatter,
            allow_abbrev=False,
        )
        module.add_arguments(command)
        command.add_argument("--json", action="store_true", help="print the report as JSON")
        command.add_argument(
            "--quiet", action="store_true", help="show no progress and tell no forecast"
        )
        command.add_argument("--debug", action="store_true", help="show the traceback of an error")
        command.set_defaults(run=module.run, command_parser=command)
    return top


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    argv : sequence of str, optional
        The words after ``anistar``; those of the process by default.

    Returns
    -------
    int
        0 done, 1 failed, 2 wrong usage or input.
    """
    open_closed_streams()
    words = canonical_flags(sys.argv[1:] if argv is None else argv)
    try:
        arguments = _parsed(words)
    except SystemExit as stop:
        with suppress(RuntimeError), readers_may_leave():
            sys.stdout.flush()  # what --help has printed
        return int(stop.code or 0)
    try:
        with quiet(arguments.quiet or arguments.json):
            return int(arguments.run(arguments))
    except KeyboardInterrupt:
        complain(f"anistar {arguments.command}: interrupted")
        return FAILED
    except Exception as error:
        if arguments.debug:
            traceback.print_exc()
        complain(f"anistar {arguments.command}: error: {one_line(error)}")
        return exit_code(error)


def _parsed(words: Sequence[str]) -> argparse.Namespace:
    """Return the arguments; the command whose they are says which of them it does not know."""
    arguments, unknown = parser().parse_known_args(words)
    if unknown:
        command = arguments.command_parser
        flag = next((word for word in unknown if word.startswith("-")), None)
        known = [name for name in command._option_string_actions if name.startswith("--")]
        hint = f": {advice(flag.partition('=')[0], known)}" if flag is not None else ""
        command.error(f"unrecognized arguments: {' '.join(unknown)}{hint}")
    return arguments


def one_line(error: BaseException) -> str:
    """Return the message of an error and its notes on one line."""
    text = str(error) or type(error).__name__
    if isinstance(error, OSError) and error.strerror and error.filename:
        text = f"{error.filename}: {error.strerror}"
    return " ".join("; ".join([text, *getattr(error, "__notes__", [])]).split())


def exit_code(error: BaseException) -> int:
    """Return 2 for what the caller can put right, 1 for what failed."""
    cause = error.__cause__ if isinstance(error, MeshingError) and error.__cause__ else error
    return BAD_INPUT if isinstance(cause, ValueError | TypeError | OSError) else FAILED
