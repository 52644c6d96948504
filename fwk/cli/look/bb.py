"""`fwk bb`: the blackboard of a run from outside."""

import json
import sys
from collections.abc import Iterator
from fnmatch import fnmatchcase
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.table import Table

from fwk.cli.run_options import Json, RunChoice, asking
from fwk.clock import US_PER_S
from fwk.control import client

WIDTH_IN_A_PIPE = 240
bb = typer.Typer(add_completion=False, no_args_is_help=True)
Channel = Annotated[str, typer.Argument(metavar="CHANNEL", help="its full name, such as cyan1/odometry")]


@bb.callback()
def blackboard() -> None:
    """Shows the channels of a run and what was written on them last."""


@bb.command("list")
def list_channels(
    patterns: Annotated[
        list[str] | None, typer.Argument(metavar="PATTERN...", help="such as 'cyan1/*'; all by default")
    ] = None,
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Lists channels with type, writer, readers, newest sequence number, tick and age.

    The age is wall time since the newest message.
    """
    with asking(), client.gateway(chosen) as run:
        rows = run.ask("channels")["channels"]
    wanted = [row for row in rows if not patterns or any(fnmatchcase(row["channel"], each) for each in patterns)]
    if as_json:
        typer.echo(json.dumps(wanted, indent=2))
        return
    Console(width=None if sys.stdout.isatty() else WIDTH_IN_A_PIPE).print(_table(wanted))


@bb.command()
def show(channel: Channel, chosen: RunChoice = None, as_json: Json = False) -> None:
    """Shows a channel's newest message, field by field."""
    with asking(), client.gateway(chosen) as run:
        answer = run.ask("show", channel=channel)
    typer.echo(json.dumps(answer, indent=2) if as_json else "\n".join(_message(answer)))


@bb.command()
def watch(
    channel: Channel,
    count: Annotated[
        int | None, typer.Option("--count", min=1, metavar="N", help="end after N messages; otherwise with Ctrl-C")
    ] = None,
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Shows a channel's newest message, and from then on each new one, until the run ends.

    Who is slower than the channel misses messages and is told how many. With `--json` there is a line for each message.
    """
    with asking(), client.gateway(chosen) as run:
        for seen, answer in enumerate(run.follow("watch", channel=channel), 1):
            typer.echo(json.dumps(answer) if as_json else "\n".join([*_message(answer), ""]))
            if seen == count:
                return


def _table(rows: list[dict[str, Any]]) -> Table:
    table = Table("channel", "type", "writer", box=None, pad_edge=False)
    for title in ("messages", "sequence", "tick", "age s", "bytes"):
        table.add_column(title, justify="right")
    table.add_column("readers")
    for row in rows:
        age = "never" if row["age_s"] is None else f"{row['age_s']:.2f}"
        numbers = [str(row["messages"]), str(row["sequence"]), str(row["tick"]), age, str(row["bytes"])]
        table.add_row(row["channel"], row["type"], row["writer"], *numbers, ", ".join(row["readers"]))
    return table


def _message(answer: dict[str, Any]) -> Iterator[str]:
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
            yield from field_lines(name, value, "  ")


def field_lines(name: str, value: Any, indent: str) -> Iterator[str]:
    """A line a value; below a struct, and below each struct of a list, its own fields."""
    if isinstance(value, dict):
        yield f"{indent}{name}:"
        for key, below in value.items():
            yield from field_lines(key, below, f"{indent}  ")
    elif isinstance(value, list) and value and isinstance(value[0], dict):
        for number, item in enumerate(value):
            yield from field_lines(f"{name}[{number}]", item, indent)
    else:
        yield f"{indent}{name}: {_number(value)}"


def _number(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_number, value))}]"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
