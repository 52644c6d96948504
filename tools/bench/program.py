"""Command line of a measurement: bad input and failed runs end it with a sentence and an exit code."""

from collections.abc import Callable

import typer

from fwk.model.errors import PlanError
from fwk.program import BAD_INPUT, FAILED, complain, imported, run_program
from tools.bench.driver import RunFailedError


def run(command: Callable[..., None]) -> None:
    """Runs a command with the words of the command line and exits.

    Exit codes: 0 success; 1 a run failed; 2 bad input, such as a launch file with mistakes.
    """

    def program() -> int:
        imported()
        try:
            typer.run(command)
        except PlanError as error:
            complain(str(error))
            return BAD_INPUT
        except RunFailedError as error:
            complain(str(error))
            return FAILED
        return 0

    run_program(program)
