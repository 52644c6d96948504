"""`fwk log-info RUN_OR_LOG`: the contents of a log."""

import json
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer

from fwk.cli.output import say, say_table
from fwk.cli.recordings.find_log import failing, find_log_with_types
from fwk.cli.recordings.log_options import Types
from fwk.cli.recordings.progress import progress_of
from fwk.clock import US_PER_S
from fwk.display.table import Column, Table
from fwk.lcm.log_parts import parts_of
from fwk.recording.log_contents import ChannelInfo, LogInfo
from fwk.recording.log_info import log_info as read_info


def log_info(
    file: Annotated[Path, typer.Argument(metavar="RUN_OR_LOG", help="log, or run by its name or directory")],
    check: Annotated[
        bool, typer.Option("--check", help="read every message and compare the check sums; exit 1 at damage")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="for programs")] = False,
    types: Types = Path(),
) -> None:
    """Shows channels, types, counts, rates, ticks, gaps, bookmarks and damage of a log.

    A log with an index beside it (`log.lcm.index`, which a run writes at its end) opens at once, whatever its size.
    """
    with failing(2):
        log = find_log_with_types(file, types)
        with progress_of("reading", log) as progress:
            info = read_info(log, check, progress)
    if as_json:
        typer.echo(json.dumps(_plain(info), indent=2))
    else:
        say(*_summary(info))
        say_table(_table(info))
    if check and (info.damaged_bytes or info.changed or info.missing):
        raise typer.Exit(1)


def _plain(info: LogInfo) -> dict[str, Any]:
    channels = {
        name: {**{key: value for key, value in asdict(made).items() if key[0] != "_"}, "rate_hz": made.rate_hz}
        for name, made in info.channels.items()
    }
    files = [str(file) for file in parts_of(info.file)]
    derived = {"file": str(info.file), "files": files, "duration_s": info.duration_s, "ticks": info.ticks}
    named = {"notes": [note._asdict() for note in info.notes], "changed": [part._asdict() for part in info.changed]}
    return {**asdict(info), **derived, **named, "channels": channels}


def _summary(info: LogInfo) -> list[str]:
    files = len(parts_of(info.file))
    size = f"{info.size_bytes} bytes" + (f" in {files} files" if files > 1 else "")
    made = [f"{info.file}: {size}, {info.events} events on {len(info.channels)} channels"]
    ticks = f", ticks {info.ticks[0]} to {info.ticks[1]}" if info.ticks else ""
    made.append(f"duration {info.duration_s:.3f} s{ticks}")
    if info.excerpt:
        made.append(f"a part of a recording: {info.excerpt}")
    if info.dropped:
        made.append(f"{info.dropped} events were dropped by the program that wrote the log")
    if info.damaged_bytes:
        made.append(f"{info.damaged_bytes} damaged bytes skipped")
    made += [f"damaged: {part}" for part in info.changed]
    made += [f"note, tick {note.tick}, {note.time_us / US_PER_S:.3f} s: {note.text}" for note in info.notes]
    return made


def _table(info: LogInfo) -> Table:
    ranks = {"messages": 0, "Hz": 3, "bytes": 4, "ticks": 5, "lost": 1, "repeated": 6, "undecodable": 2}
    numbers = [Column(title, right=True, rank=rank) for title, rank in ranks.items()]
    table = Table("channel", Column("type", rank=2), *numbers)
    for name, made in info.channels.items():
        ticks = f"{made.first_tick}-{made.last_tick}" if made.first_tick is not None else ""
        counts = [str(made.messages), f"{made.rate_hz:.1f}", str(made.bytes), ticks, _lost(made)]
        table.add(name, ", ".join(made.types), *counts, str(made.repeated or ""), str(made.undecodable or ""))
    return table


def _lost(made: ChannelInfo) -> str:
    """Returns how many messages are missing, and where: `7 (12, 20-25)`."""
    places = [str(first) if first == last else f"{first}-{last}" for first, last in made.gaps]
    more = ", ..." if len(made.gaps) == ChannelInfo.GAPS_SHOWN else ""
    return f"{made.lost} ({', '.join(places)}{more})" if made.lost else ""
