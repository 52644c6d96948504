"""The subcommands of `fwk` as a typer application; each is imported from its module when it is used."""

from collections.abc import Iterator, MutableMapping
from importlib import import_module
from keyword import iskeyword
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from fwk.cli.arguments import SeveralNames
from fwk.cli.examples import add_examples
from fwk.cli.version import version

MODULES = {
    "new": "project.new",
    "add": "project.add",
    "remove": "project.remove",
    "types": "project.types",
    "check": "check.check",
    "ps": "look.ps",
    "status": "look.status",
    "top": "look.top",
    **dict.fromkeys(("start", "stop", "restart", "reload", "load", "unload", "kill"), "steer.lifecycle"),
    "debug": "steer.debug",
    **dict.fromkeys(("pause", "resume", "step", "speed"), "steer.clock"),
    "config": "steer.config",
    **dict.fromkeys(("graph", "who"), "look.graph"),
    "bb": "look.bb",
    "log": "look.log",
    "note": "steer.note",
    "send": "steer.send",
    "call": "steer.call",
    "play": "recordings.play",
    "replay": "recordings.replay",
    "bisect": "recordings.bisect",
    "compare": "recordings.compare",
    "log-info": "recordings.log_info",
    **dict.fromkeys(("cut", "filter"), "recordings.cut"),
    "merge": "recordings.merge",
    "repair": "recordings.repair",
    "compress": "recordings.compress",
    **dict.fromkeys(("export", "import"), "recordings.export"),
    "plot": "look.plot",
    "runs": "recordings.runs",
    "video": "recordings.video",
    "eval": "recordings.evaluate",
    "cam": "look.cam",
    "web": "look.web",
    "monitor": "look.monitor",
    "view": "look.view",
    "foxglove": "look.foxglove",
    "spy": "look.spy",
    "doctor": "check.doctor",
    "completion": "complete.completion",
}
"""Command, as typed and in the order of the help, to its module in `fwk.cli`. The function or typer application there
has the command's name: `log-info` is `log_info`, `import` is `import_`.
"""


class _Commands(MutableMapping[str, Any]):
    """Subcommands by name, imported on first use: `fwk check` does not wait for the imports of `fwk cam`."""

    def __init__(self) -> None:
        self._made: dict[str, Any] = {}

    def __getitem__(self, name: str) -> Any:
        if name not in self._made and name in MODULES:
            self._made[name] = _command(name)
        return self._made[name]

    def __setitem__(self, name: str, command: Any) -> None:
        self._made[name] = command

    def __delitem__(self, name: str) -> None:
        del self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(dict.fromkeys((*MODULES, *self._made)))

    def __len__(self) -> int:
        return len(list(iter(self)))


class _Group(TyperGroup):
    """A typer group whose commands come from modules."""

    def __init__(self, **attributes: Any) -> None:
        super().__init__(**attributes)
        self.commands = _Commands()


def _command(name: str) -> Any:
    word = f"{name}_" if iskeyword(name) else name.replace("-", "_")
    made = getattr(import_module(f"fwk.cli.{MODULES[name]}"), word)
    if not isinstance(made, typer.Typer):
        function, made = made, typer.Typer(add_completion=False)
        made.command(name, cls=SeveralNames)(function)
    command = typer.main.get_command(made)
    command.name = name
    add_examples(f"fwk {name}", command)
    return command


app = typer.Typer(cls=_Group, add_completion=False, no_args_is_help=True, pretty_exceptions_enable=False)


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(version())
        raise typer.Exit


VersionFlag = Annotated[
    bool, typer.Option("--version", callback=_print_version, is_eager=True, help="print the version and exit")
]


@app.callback()
def fwk(_version: VersionFlag = False) -> None:
    """Tools for runs, launch files and recordings; `fwk-launch` starts a run.

    Exit codes: 0 success; 1 a negative result, such as a difference or a failed component; 2 bad input.
    """
