"""`fwk send CHANNEL FIELD=VALUE...`: writes a message into a run from outside."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

import typer

from fwk.bus.public import PublicBus
from fwk.cli.run_options import Json, RunChoice, asking
from fwk.control import runs
from fwk.control.requests import refuse_deep_nesting
from fwk.lcm import messages
from fwk.lcm.lcm_file import INTEGERS
from fwk.lcm.messages import MessageError
from fwk.lcm.type_registry import use_types_of
from fwk.model.errors import Problems, hint
from fwk.model.service_channels import is_of_service
from fwk.plan.files.source import read_value
from fwk.program import BAD_INPUT

_NO_FIELD = "'{}' is not FIELD=VALUE; write for example x_m=1.5, or xs=[1, 2]"
_LETTERS_MAX = 1_000_000
_NUMBERS = {*INTEGERS, "float", "double"}

Fields = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="FIELD=VALUE...",
        help="fields of the message, the others are zero; member of a struct: field.below=1; text of a file: "
        "field=@FILE",
    ),
]


def send(
    channel: Annotated[
        str,
        typer.Argument(
            metavar="CHANNEL",
            help="a channel that programs outside may write: 'outside:' of the launch file, or --outside",
        ),
    ],
    fields: Fields = None,
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Publishes one message on the public bus of a run, on a channel that programs outside may write.

    The run stamps the message when it takes it in, between two ticks.
    """
    with asking():
        with runs.gateway(chosen) as board:
            rows = {row["channel"]: row for row in board.ask("channels")["channels"]}
        with runs.supervisor(chosen) as run:
            about = run.ask("run")
    try:
        row = rows.get(channel)
        outside = [name for name, each in rows.items() if each["outside"]]
        if row is None or not row["outside"]:
            raise MessageError(f"{channel}: {_why_not(channel, row, outside)}")
        for folder in about["folders"]:
            use_types_of(Path(folder))
        data = messages.encode(made(row["type"], fields or []), channel)
    except MessageError as error:
        typer.echo(f"error: {error}", err=True)
        raise typer.Exit(BAD_INPUT) from error
    with asking():
        bus = PublicBus(runs.public_bus(about))
    bus.publish(channel, data)
    bus.close()
    sent = {"channel": channel, "type": row["type"], "bytes": len(data)}
    typer.echo(json.dumps(sent) if as_json else f"{channel}: {len(data)} bytes sent")


def _why_not(channel: str, row: dict[str, Any] | None, outside: list[str]) -> str:
    """Returns why a channel cannot be sent to, and what to do."""
    if row is None:
        return f"no such channel; {hint(channel, outside) if outside else 'fwk bb list shows all channels'}"
    if is_of_service(channel):
        return "it carries commands; send one with 'fwk call'"
    without = f"--without {row['writer']} " if row["writer"] else ""
    file = f"in a launch file without {row['writer']}" if row["writer"] else "in the launch file"
    right = f"to write it yourself, start the run with {without}--outside {channel}, or name it under 'outside:' {file}"
    return f"{row['writer'] or 'no component'} writes it; {right}"


def made(type_name: str, fields: list[str]) -> Any:
    """Returns a message with these fields set; `FIELD=@FILE` is the text of a file.

    Raises:
        MessageError: no such type or field, one that is given twice, a file that cannot be read, or a value that is
            not YAML or does not fit.
    """
    message: Any = messages.type_named(type_name)()
    given: set[str] = set()
    for text in fields:
        path, equals, typed = text.partition("=")
        if path in given:
            raise MessageError(f"{path} is given twice")
        given.add(path)
        value = _content(path, typed[1:]) if typed.startswith("@") else _value(path, typed, text)
        if not equals:
            raise MessageError(_NO_FIELD.format(text))
        *above, last = path.split(".")
        target = message
        for name in above:
            target = getattr(target, name, None)
        known = list(getattr(target, "__slots__", ()))
        if last not in known:
            raise MessageError(f"{type_name} has no field '{path}'; {hint(last, known)}")
        place = known.index(last)
        kind = target.__typenames__[place]
        if kind == "string" and target.__dimensions__[place] is None and not isinstance(value, str):
            value = typed  # a text that looks like a number, a truth value or a mapping
        setattr(target, last, _fitting(value, kind, path))
    return message


def _value(path: str, typed: str, text: str) -> Any:
    """Returns the value of an argument `FIELD=VALUE`, which is YAML.

    Raises:
        MessageError: it is not.
    """
    problems = Problems()
    try:
        refuse_deep_nesting(typed)
    except ValueError as error:
        raise MessageError(f"{path}: {error}") from error
    node = read_value(typed, "", problems)
    if problems or node is None:
        raise MessageError(_NO_FIELD.format(text))
    return node.plain()


def _content(path: str, file: str) -> str:
    """Returns the text of a file that `FIELD=@FILE` names.

    Raises:
        MessageError: it cannot be read, or is too long.
    """
    try:
        with open(file, encoding="utf-8") as opened:
            text = opened.read(_LETTERS_MAX + 1)  # a device such as /dev/zero has no end
    except OSError as error:
        raise MessageError(f"{path}: {file}: {error.strerror}") from error
    except ValueError as error:  # no UTF-8, or no name of a file
        raise MessageError(f"{path}: {file}: {error}") from error
    if len(text) > _LETTERS_MAX:
        raise MessageError(f"{path}: {file}: more than {_LETTERS_MAX:,} letters are too many for a message")
    return text


def _fitting(value: Any, kind: str, path: str) -> Any:
    """Returns a value as a message holds it; truth values are no numbers, and numbers no truth values.

    Raises:
        MessageError: the value does not fit the type of its field.
    """
    if kind in _NUMBERS and any(isinstance(each, bool) for each in _flat(value)):
        raise MessageError(f"{path} is {json.dumps(value)}; it should be a number ({kind})")
    if kind == "boolean" and not all(isinstance(each, bool) for each in _flat(value)):
        raise MessageError(f"{path} is {json.dumps(value)}; it should be true or false")
    if kind == "byte" and isinstance(value, list):
        try:
            return bytes(value)
        except (ValueError, TypeError) as error:
            raise MessageError(f"{path}: bytes are numbers from 0 to 255") from error
    return value


def _flat(value: Any) -> Iterator[Any]:
    """Yields the single values of a list of any depth, or the value itself."""
    if isinstance(value, list):
        for each in value:
            yield from _flat(each)
    else:
        yield value
