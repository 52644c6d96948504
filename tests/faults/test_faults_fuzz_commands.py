"""Whatever is typed behind a command, it ends with an answer or a sentence, never with a traceback."""

import json
from itertools import islice
from pathlib import Path
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as some
from typer import Typer
from typer.testing import CliRunner

from fwk import messages
from fwk.cli import launch as launching
from fwk.cli.bb import _message
from fwk.cli.launch import app as fwk_launch
from fwk.cli.main import app as fwk
from fwk.cli.send import made
from fwk.gateway.board import plain
from fwk.messages import MessageError
from tests.faults.faults_fuzz import HOSTILE_TEXT, all_types
from tests.system.system_runs import write_files

TINY = {
    "tiny.py": """
from fwk import Component, Config


class TinyConfig(Config):
    gain: float = 1.0
    names: list[str] = []


class Tiny(Component):
    stage = "think"
    config: TinyConfig
""",
    "tiny.yaml": 'name: tiny\ncomponents: {a/tiny: {use: "tiny:Tiny"}}\n',
}


class _WouldRun(Exception):  # noqa: N818 - what happens
    pass


@pytest.fixture
def tiny(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a launch file whose run is not started."""

    def run(*_: object) -> None:
        raise _WouldRun

    write_files(tmp_path, TINY)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setattr(launching, "run", run)
    return tmp_path


def check(app: Typer, *arguments: str) -> None:
    result = CliRunner().invoke(app, arguments)
    caught = result.exception
    assert caught is None or isinstance(caught, SystemExit | _WouldRun), (arguments, caught)
    assert result.exit_code in (0, 1, 2)


OPTIONS = [
    "--ticks",
    "--time",
    "--speed",
    "--seed",
    "--record",
    "--set",
    "--hosting",
    "--only",
    "--without",
    "--debug",
    "--debugpy",
    "--bus-port",
    "--video",
]


@pytest.mark.parametrize("option", OPTIONS)
def test_every_option_of_fwk_launch(tiny: Path, option: str) -> None:
    for text in HOSTILE_TEXT:
        check(fwk_launch, "tiny.yaml", option, text)


@pytest.mark.parametrize("path", ["", "a/tiny.", "a/tiny.gain=", "a/tiny.names=", "a/tiny.names.0=", "*/tiny.gain="])
def test_every_part_of_set(tiny: Path, path: str) -> None:
    for text in HOSTILE_TEXT:
        check(fwk_launch, "tiny.yaml", "--set", path + text)


def test_every_launch_file(tiny: Path) -> None:
    for text in HOSTILE_TEXT:
        check(fwk_launch, text)
        check(fwk, "check", text)


COMMANDS = [
    "status",
    "top",
    "bb show",
    "bb list",
    "bb watch",
    "config get",
    "config set",
    "config list",
    "send",
    "send a/b",
    "start",
    "restart",
    "log",
    "log-info",
    "log-info --types",
    "compare",
    "compare x",
    "replay",
    "replay x --only",
    "replay x --from-tick",
    "video",
]


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command(tiny: Path, command: str) -> None:
    for text in HOSTILE_TEXT:
        check(fwk, *command.split(), text)


@pytest.mark.parametrize("command", ["status", "bb list", "config list", "log", "doctor"])
def test_every_bus_port(tiny: Path, command: str) -> None:
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
def test_every_field_and_value_of_fwk_send(name: str, value: Any, data: some.DataObject | None) -> None:
    kind: Any = messages.type_named(name)
    fields = [*kind.__slots__, "", ".", "header.tick", "header.__class__", "decode", "a.b"]
    field = data.draw(some.sampled_from(fields)) if data else fields[-1]
    text = value if isinstance(value, str) else json.dumps(value)
    try:
        sent = messages.encode(made(name, [f"{field}={text}"]), "a/b")
    except MessageError:
        return
    shown = {"channel": "a/b", "type": name, "sequence": 1, "tick": 1, "time_us": 1, "value": plain(kind.decode(sent))}
    assert json.dumps(shown)
    if messages.has_header(kind):
        assert list(islice(_message(shown), 1000))
