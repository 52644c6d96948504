"""What tests of `fwk eval` share: a launch file, its evaluation by hand, and an executor that does little."""

from concurrent.futures import Executor, Future
from typing import Any

from typer.testing import CliRunner

from fwk.cli.commands import app

LAUNCH = """
name: it
evaluation: tests.fwk.cli.cli_eval_parts:measured
components:
  it/idle: {use: tests.fwk.cli.cli_eval_parts:Idle}
"""


def evaluated(*words: str) -> tuple[int, str, str]:
    result = CliRunner().invoke(app, ["eval", *words])
    return result.exit_code, result.stdout, result.stderr


class Queue(Executor):
    """Runs the first call at once, and never the others."""

    def __init__(self) -> None:
        self.futures: list[Future[Any]] = []

    def submit(self, work: Any, /, *words: Any, **named: Any) -> Future[Any]:
        future: Future[Any] = Future()
        self.futures.append(future)
        if len(self.futures) == 1:
            future.set_result(work(*words, **named))
        return future

    def give_up(self) -> None:
        """Fails the calls that were not run."""
        for future in self.futures[1:]:
            future.set_exception(TimeoutError("never begun, and the first run gave no result"))
