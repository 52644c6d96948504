"""`fwk bb`: the channels of a run and their newest messages."""

import json
import re
from collections.abc import Iterator
from fnmatch import fnmatchcase
from typing import Annotated, Any

import typer

from fwk.cli.look.channel_rates import channels_with_rates
from fwk.cli.output import say_table
from fwk.cli.run_options import Json, RunChoice, asking
from fwk.clock import US_PER_S
from fwk.control import runs
from fwk.display.table import Column, Table
from fwk.model.errors import hint
from fwk.program import BAD_INPUT, notice

_ITEMS_SHOWN = 12
_ROW_SHOWN = 4
bb = typer.Typer(add_completion=False, no_args_is_help=True)
Channel = Annotated[str, typer.Argument(metavar="CHANNEL", help="full name of a channel, such as cyan1/odometry")]


@bb.callback()
def blackboard() -> None:
    """Shows the channels of a run and their newest messages."""


@bb.command("list")
def list_channels(
    patterns: Annotated[
        list[str] | None, typer.Argument(metavar="PATTERN...", help="such as 'cyan1/*'; all by default")
    ] = None,
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Lists channels with type, writer, rate, readers, newest sequence number, tick and age.

    Rate and age are wall time: messages per second over one second, and time since the newest message.
    """
    with asking():
        rows = channels_with_rates(chosen)
    wanted = [row for row in rows if not patterns or any(fnmatchcase(row["channel"], each) for each in patterns)]
    if as_json:
        typer.echo(json.dumps(wanted, indent=2))
        return
    for pattern in patterns or ():
        if not any(fnmatchcase(row["channel"], pattern) for row in wanted):
            notice(f"no channel matches '{pattern}'; {hint(pattern, [row['channel'] for row in rows])}")
    say_table(_table(wanted))


@bb.command()
def show(
    channel: Channel,
    whole: Annotated[bool, typer.Option("--all", help="also all items of long arrays")] = False,
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Shows a channel's newest message, field by field; long arrays are shortened, except with --json or --all."""
    with asking(), runs.gateway(chosen) as run:
        answer = run.ask("show", channel=channel)
    typer.echo(json.dumps(answer, indent=2) if as_json else "\n".join(_message(answer, whole)))


@bb.command()
def watch(
    channel: Channel,
    count: Annotated[
        int | None, typer.Option("--count", min=1, metavar="N", help="end after N messages; otherwise with Ctrl-C")
    ] = None,
    fields: Annotated[
        list[str] | None,
        typer.Option("--field", metavar="FIELD", help="only this field, such as pose.x_m or xs[2]; repeatable"),
    ] = None,
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Shows a channel's newest message, and from then on each new one, until the run ends.

    A reader that is slower than the channel misses messages; their number is shown. `--json` prints a line for each
    message. With `--field` a line has tick, logical time and the values of these fields.
    """
    with asking(), runs.gateway(chosen) as run:
        for seen, answer in enumerate(run.follow("watch", channel=channel), 1):
            if fields and answer["value"] is not None:
                typer.echo(_field_line(answer, fields, as_json))
            else:
                typer.echo(json.dumps(answer) if as_json else "\n".join([*_message(answer), ""]))
            if seen == count:
                return


def _field_line(answer: dict[str, Any], fields: list[str], as_json: bool) -> str:
    """Returns the line for these fields of a message."""
    try:
        values = {name: field_of(answer["value"], name) for name in fields}
    except LookupError as error:
        typer.echo(f"error: {answer['channel']} ({answer['type']}): {error.args[0]}", err=True)
        raise typer.Exit(BAD_INPUT) from error
    if as_json:
        return json.dumps({"tick": answer["tick"], "time_us": answer["time_us"], **values})
    shown = "  ".join(f"{name}={_words(value, whole=False)}" for name, value in values.items())
    return f"{answer['tick']:>8}  {answer['time_us'] / US_PER_S:.3f} s  {shown}"


def field_of(value: Any, path: str) -> Any:
    """Returns a member of a message as plain data; `path` is such as `pose.x_m` or `robots[0].y_m`.

    Raises:
        LookupError: there is no such member; the text says which there are.
    """
    for name in re.findall(r"[^.\[\]]+", path):
        if isinstance(value, dict) and name in value:
            value = value[name]
        elif isinstance(value, list) and name.isdecimal() and int(name) < len(value):
            value = value[int(name)]
        elif isinstance(value, list):
            raise LookupError(f"no item '{name}' in '{path}'; it has {len(value)}")
        else:
            known = hint(name, list(value)) if isinstance(value, dict) else "it is a value without fields"
            where = f" in '{path}'" if path != name else ""
            raise LookupError(f"no field '{name}'{where}; {known}")
    return value


def _table(rows: list[dict[str, Any]]) -> Table:
    table = Table(
        "channel",
        Column("type", rank=2),
        Column("writer", rank=1),
        Column("Hz", right=True, rank=3),
        Column("messages", right=True, rank=8),
        Column("sequence", right=True, rank=4),
        Column("tick", right=True, rank=6),
        Column("age s", right=True, rank=2),
        Column("bytes", right=True, rank=7),
        Column("readers", rank=5, prose=True),
    )
    for row in rows:
        age = "never" if row["age_s"] is None else f"{row['age_s']:.2f}"
        table.add(
            *(row["channel"], row["type"], row["writer"], f"{row['rate_hz']:.1f}", row["messages"], row["sequence"]),
            *(row["tick"], age, row["bytes"], ", ".join(row["readers"])),
            style="dim" if row["age_s"] is None else "",
        )
    return table


def _message(answer: dict[str, Any], whole: bool = False) -> Iterator[str]:
    skipped = f", {answer['skipped']} left out" if answer.get("skipped") else ""
    if answer["value"] is None:
        yield f"{answer['channel']} ({answer['type']}): never written"
        return
    yield (
        f"{answer['channel']} ({answer['type']}) sequence {answer['sequence']}, tick {answer['tick']}, "
        f"{answer['time_us'] / US_PER_S:.3f} s, by {answer['by']}{skipped}"
    )
    for name, value in answer["value"].items():
        if name != "header" or answer["plain"]:
            yield from field_lines(name, value, "  ", whole)


def field_lines(name: str, value: Any, indent: str, whole: bool = False) -> Iterator[str]:
    """Yields a line for each value, indented by structs; long arrays are shortened unless `whole` is set."""
    if isinstance(value, dict):
        yield f"{indent}{name}:"
        for key, below in value.items():
            yield from field_lines(key, below, f"{indent}  ", whole)
    elif isinstance(value, list) and value and isinstance(value[0], dict):
        shown = value if whole else value[:_ITEMS_SHOWN]
        for number, item in enumerate(shown):
            yield from field_lines(f"{name}[{number}]", item, indent, whole)
        if len(shown) < len(value):
            yield f"{indent}{name}: ... {len(value) - len(shown)} more; --all shows them"
    else:
        yield f"{indent}{name}: {_words(value, whole)}"


def _words(value: Any, whole: bool) -> str:
    if not isinstance(value, list):
        return f"{value:.6g}" if isinstance(value, float) else str(value)
    if whole or _size(value) <= _ITEMS_SHOWN:
        return f"[{', '.join(_words(each, True) for each in value)}]"
    if isinstance(value[0], list):
        return f"[{_words(value[0], False)}, ...] ({_shape(value)} items; --all shows them)"
    first = ", ".join(_words(each, True) for each in value[:_ROW_SHOWN])
    return f"[{first}, ..., {_words(value[-1], True)}] ({len(value)} items)"


def _size(value: Any) -> int:
    return sum(map(_size, value)) if isinstance(value, list) else 1


def _shape(value: Any) -> str:
    sizes = []
    while isinstance(value, list):
        sizes.append(str(len(value)))
        value = value[0] if value else None
    return " x ".join(sizes)
