"""Commands answer any arguments with a result or a sentence, never with a traceback."""

import json
from collections.abc import Iterator
from functools import cache
from itertools import islice
from pathlib import Path
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as some
from typer import Typer, testing
from typer.main import get_command
from typer.testing import CliRunner

from fwk.cli.commands import app as fwk
from fwk.cli.look import log
from fwk.cli.look.bb import _message
from fwk.cli.run import launch_command as launching
from fwk.cli.run.launch_command import app as fwk_launch
from fwk.cli.steer.send import made
from fwk.control import address
from fwk.gateway.channel_server import plain
from fwk.lcm import messages
from fwk.lcm.messages import MessageError
from fwk.web import background
from tests.harness.components import sources
from tests.harness.fuzz import HOSTILE_TEXT, all_types
from tests.harness.runs import PortBlock, write_files

TINY = {
    **sources("tiny.py"),
    "tiny.yaml": 'name: tiny\ncomponents: {a/tiny: {use: "tiny:Tiny"}}\n',
}


made_once = cache(get_command)
"""Makes the commands of an application as typer does for each command line, but once."""


class _WouldRunError(Exception):
    pass


@pytest.fixture
def tiny(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a launch file whose run is never started; nor are commands that serve until Ctrl-C."""

    def run(*_: object) -> None:
        raise _WouldRunError

    write_files(tmp_path, TINY)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setattr(address, "running", list)  # no command may act on a run that goes on beside the tests
    monkeypatch.setattr(launching, "run", run)
    monkeypatch.setattr(log, "running", list)
    monkeypatch.setattr(background, "continue_in_background", run)
    monkeypatch.setattr(testing, "_get_command", made_once)
    for command in ("view", "foxglove"):  # they would follow another user's run on this machine
        monkeypatch.setattr(f"fwk.cli.look.{command}.listening", run)
    return tmp_path


def check(app: Typer, *arguments: str) -> None:
    result = CliRunner().invoke(app, arguments)
    caught = result.exception
    assert caught is None or isinstance(caught, SystemExit | _WouldRunError), (arguments, caught)
    assert result.exit_code in (0, 1, 2)


OPTIONS = [
    "--ticks",
    "--time",
    "--speed",
    "--seed",
    "--record",
    "--record-split",
    "--set",
    "--hosting",
    "--profile",
    "--only",
    "--without",
    "--debug",
    "--debugpy",
    "--bus-port",
    "--video",
]


@pytest.mark.slow
@pytest.mark.parametrize("option", OPTIONS)
def test_every_option_of_fwk_launch_is_answered(tiny: Path, option: str) -> None:
    for text in HOSTILE_TEXT:
        check(fwk_launch, "tiny.yaml", option, text)


@pytest.mark.slow
@pytest.mark.parametrize("path", ["", "a/tiny.", "a/tiny.gain=", "a/tiny.names=", "a/tiny.names.0=", "*/tiny.gain="])
def test_every_part_of_set_is_answered(tiny: Path, path: str) -> None:
    for text in HOSTILE_TEXT:
        check(fwk_launch, "tiny.yaml", "--set", path + text)


def test_every_launch_file_argument_is_answered(tiny: Path) -> None:
    for text in HOSTILE_TEXT:
        check(fwk_launch, text)
        check(fwk, "check", text)


def commands(path: tuple[str, ...], command: Any) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Every command of `fwk` with its words."""
    below: Any = getattr(command, "commands", {})
    if not below:
        yield path, command
    for name in below:
        yield from commands((*path, name), below[name])


COMMANDS = {" ".join(path): command for path, command in commands((), get_command(fwk)) if path != ("spy",)}
"""Without the command that starts another program."""


def places(command: Any) -> Iterator[tuple[str, ...]]:
    """Command lines to extend by any text: as an argument, after other arguments, and after each option."""
    arguments = [each for each in command.params if each.param_type_name == "argument"]
    for count in range(len(arguments)):
        yield ("x",) * count
    needed = ("x",) * sum(each.required for each in arguments)
    for option in command.params:
        if option.param_type_name == "option" and not option.is_flag:
            yield (*needed, option.opts[0])


@pytest.mark.slow
@pytest.mark.parametrize("command", COMMANDS)
def test_every_argument_of_every_command_is_answered(tiny: Path, ports: PortBlock, command: str) -> None:
    made = COMMANDS[command]
    nobody = ("--bus-port", str(ports.bus))  # not another user's run on this machine
    has_port = any("--bus-port" in each.opts for each in made.params)
    for before in places(made):
        port = nobody if has_port and before[-1:] != ("--bus-port",) else ()
        for text in HOSTILE_TEXT:
            check(fwk, *command.split(), *port, *before, text)


@pytest.mark.parametrize("command", ["status", "bb list", "config list", "log", "doctor"])
def test_every_bus_port_is_answered(tiny: Path, command: str) -> None:
    for text in ("-1", "0", "1", "65535", "65536", "x", str(2**64)):
        check(fwk, *command.split(), "--bus-port", text)


TYPES = [messages.type_name(kind) for kind in all_types()]
VALUES = some.recursive(
    some.none() | some.booleans() | some.integers() | some.floats() | some.text(max_size=8),
    lambda below: some.lists(below, max_size=3) | some.dictionaries(some.text(max_size=3), below, max_size=2),
    max_leaves=4,
)


@given(some.sampled_from(TYPES), VALUES | some.sampled_from(HOSTILE_TEXT), some.data())
@example("robot.imu_t", "[" * 1200, None)
def test_every_field_and_value_of_fwk_send_is_answered(name: str, value: Any, data: some.DataObject | None) -> None:
    kind: Any = messages.type_named(name)
    fields = [*kind.__slots__, "", ".", "header.tick", "header.__class__", "decode", "a.b"]
    field = data.draw(some.sampled_from(fields)) if data else fields[-1]
    text = value if isinstance(value, str) else json.dumps(value)
    try:
        sent = messages.encode(made(name, [f"{field}={text}"]), "a/b")
    except MessageError:
        return
    shown = {
        "channel": "a/b",
        "type": name,
        "by": "a/c",
        "sequence": 1,
        "tick": 1,
        "time_us": 1,
        "plain": not messages.has_header(kind),
        "value": plain(kind.decode(sent)),
    }
    assert json.dumps(shown)
    if messages.has_header(kind):
        assert list(islice(_message(shown), 1000))
