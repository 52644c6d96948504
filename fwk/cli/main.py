"""The `fwk` command: each subcommand lives in a module of its own that is imported when it is needed."""

from collections.abc import Iterator, MutableMapping
from importlib import import_module
from typing import Any

import typer
from typer.core import TyperGroup

from fwk.cli.arguments import SeveralNames

NAMES = (
    "check",
    *("status", "top", "start", "stop", "restart", "reload", "load", "unload", "kill", "debug"),
    *("pause", "resume", "step", "speed"),
    *("config", "bb", "log", "note", "send", "call"),
    *("replay", "compare", "log-info", "runs", "video", "cam", "spy", "doctor"),
)
"""As typed, in the order of the help: `log-info` is the function or typer app `log_info` of `fwk/cli/log_info.py`."""


class _Commands(MutableMapping[str, Any]):
    """The subcommands by name, made when asked for: `fwk check` does not wait for what only `fwk web` imports."""

    def __init__(self) -> None:
        self._made: dict[str, Any] = {}

    def __getitem__(self, name: str) -> Any:
        if name not in self._made and name in NAMES:
            self._made[name] = _command(name)
        return self._made[name]

    def __setitem__(self, name: str, command: Any) -> None:
        self._made[name] = command

    def __delitem__(self, name: str) -> None:
        del self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(dict.fromkeys((*NAMES, *self._made)))

    def __len__(self) -> int:
        return len(list(iter(self)))


class _Group(TyperGroup):
    """A typer group whose commands are found in modules."""

    def __init__(self, **attributes: Any) -> None:
        super().__init__(**attributes)
        self.commands = _Commands()


def _command(name: str) -> Any:
    word = name.replace("-", "_")
    made = getattr(import_module(f"fwk.cli.{word}"), word)
    if not isinstance(made, typer.Typer):
        function, made = made, typer.Typer(add_completion=False)
        made.command(name, cls=SeveralNames)(function)
    command = typer.main.get_command(made)
    command.name = name
    return command


app = typer.Typer(cls=_Group, add_completion=False, no_args_is_help=True)


@app.callback()
def fwk() -> None:
    """Tools for runs, launch files and recordings; `fwk-launch` starts a run.

    Exit codes: 0 well, 1 no (a difference, a failed component), 2 bad input.
    """


def main() -> None:
    """Runs the command line."""
    app(prog_name="fwk")


if __name__ == "__main__":
    main()
