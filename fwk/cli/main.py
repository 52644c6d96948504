"""Entry point of the `fwk` command: help, version and thin commands at once, all others through typer.

Typer and rich alone take longer to import than `fwk status` may take, so the thin commands do without them.
"""

import sys
from collections.abc import Callable

from fwk.cli.output import say
from fwk.display.table import Column, Table, terminal_width
from fwk.program import BAD_INPUT, complain, imported, run_program

HIDDEN = "__complete"
"""First word of the calls that the shells' completion makes."""
_HELP = """\
Usage: fwk COMMAND [WORDS]...

Tools for runs, launch files and recordings; fwk-launch starts a run.
'fwk COMMAND --help' explains a command.

"""
_EXIT_CODES = """
Exit codes: 0 success; 1 a negative result, such as a difference or a failed component; 2 bad input.
"""


def main() -> None:
    """Runs the command line."""
    run_program(lambda: run(sys.argv[1:]))


def run(words: list[str]) -> int | None:
    """Runs a command and returns its exit code; typer's commands raise `SystemExit` instead."""
    if words[:1] == [HIDDEN]:
        from fwk.cli.complete.candidates import complete

        say(*complete(words[1:]))
        return 0
    if not words or words[0] in ("--help", "-h"):
        say(help_text())
        return 0 if words else BAD_INPUT
    if words[0] == "--version":
        from fwk.cli.version import version

        say(version())
        return 0
    thin = _thin(words)
    if thin:
        imported()
        return thin()
    from fwk.cli.unknown import mistake

    if wrong := mistake(words):
        complain(wrong)
        return BAD_INPUT
    from fwk.cli.commands import app

    imported()
    app(args=words, prog_name="fwk")
    return 0


def help_text() -> str:
    """Returns the overview of all commands."""
    from fwk.cli.index import read, subcommands

    table = Table("", Column("", prose=True))
    for name, summary in subcommands(read(), ("fwk",)).items():
        table.add(f"  {name}", summary)
    return _HELP + "\n".join(table.lines(terminal_width())) + "\n" + _EXIT_CODES.rstrip()


def _thin(words: list[str]) -> Callable[[], int] | None:
    """Returns a command that needs neither typer nor rich, if `words` are one and have no mistake."""
    from fwk.cli.thin import prepared

    return prepared(words)


if __name__ == "__main__":
    main()
