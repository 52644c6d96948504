"""Entry point of the `fwk-launch` command; the command itself is imported where Ctrl-C already ends it tidily."""

import sys

from fwk.cli.output import say
from fwk.program import run_program


def main() -> None:
    """Runs the command line; Ctrl-C before the start ends it with exit code 0."""
    run_program(_run, interrupted=0)


def _run() -> None:
    if sys.argv[1:] == ["--version"]:
        from fwk.cli.version import version

        say(version())
        return
    from fwk.cli.run.launch_command import app

    app(prog_name="fwk-launch")


if __name__ == "__main__":
    main()
