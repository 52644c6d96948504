"""Exports logs to other formats, and imports them."""

import json
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path

from fwk.lcm.event_log import SYNC, LogError
from fwk.log_tools.cut import Progress
from fwk.log_tools.messages_of import Messages, names_of
from fwk.log_tools.new_file import new_file
from fwk.log_tools.plain import plain
from fwk.log_tools.repair import repair
from fwk.log_tools.selection import Selection
from fwk.log_tools.tables import CsvTable, ParquetTable, Tables

INSTALL = "pip install 'fwk[export]'"


class Format(StrEnum):
    """Formats of exports."""

    CSV = "csv"
    JSONL = "jsonl"
    PARQUET = "parquet"
    MCAP = "mcap"


@dataclass
class Exported:
    """Result of an export."""

    out: Path
    messages: int = 0
    """Messages of the log in the export."""
    views: int = 0
    """Further messages in an MCAP file, of Foxglove's well-known types."""
    undecodable: dict[str, int] = field(default_factory=dict)
    """Channels with messages that do not decode, with their numbers; in an MCAP file these are raw bytes."""
    damaged_bytes: int = 0


@dataclass
class Imported:
    """Result of an import."""

    out: Path
    events: int = 0
    left_out: dict[str, str] = field(default_factory=dict)
    """Topics that are not in the log, with the reasons."""


def export(
    log: Path,
    out: Path,
    form: Format,
    selection: Selection,
    replace: bool = False,
    progress: Progress = lambda _: None,
) -> Exported:
    """Writes the messages of a log in another format: to a file, or for tables to a folder with a file a channel.

    Raises:
        LogError: the log cannot be read, the export cannot be written, or a library is missing.
    """
    messages, done = Messages(log, selection, progress), Exported(out)
    with new_file(out, replace) as part:
        if form is Format.MCAP:
            _mcap(log, part, selection, progress, done)
            return done
        if form is Format.JSONL:
            done.messages = _json_lines(messages, part)
        else:
            done.messages = _tables(messages, part, CsvTable if form is Format.CSV else ParquetTable)
    done.undecodable, done.damaged_bytes = messages.undecodable, messages.damaged_bytes
    return done


def import_log(path: Path, out: Path, replace: bool = False, progress: Progress = lambda _: None) -> Imported:
    """Writes an MCAP file, or a log of lcm-logger, to a new log with an index.

    Raises:
        LogError: the file cannot be read, the log cannot be written, or a library is missing.
    """
    try:
        with open(path, "rb") as file:
            is_log = file.read(len(SYNC)) == SYNC
    except OSError as error:
        raise LogError(f"{path}: cannot read: {error.strerror}") from error
    if is_log:
        return Imported(out, repair(path, out, replace, progress).events)
    try:
        from fwk.log_tools.mcap_import import McapImport
    except ImportError as error:
        raise _missing(error) from error
    done = McapImport(path)
    done.write(out, replace)
    return Imported(out, done.events, done.left_out)


def _mcap(log: Path, out: Path, selection: Selection, progress: Progress, done: Exported) -> None:
    try:
        from fwk.log_tools.mcap_export import McapExport
    except ImportError as error:
        raise _missing(error) from error
    made = McapExport(out)
    try:
        made.write(log, selection, progress)
    finally:
        made.close()
    done.messages, done.views = made.messages, made.views
    done.undecodable, done.damaged_bytes = made.undecodable, made.damaged_bytes


def _json_lines(messages: Messages, out: Path) -> int:
    count = 0
    with open(out, "w", encoding="utf-8") as file:
        for found in messages:
            channel, kind = names_of(found)
            row = {"log_time_us": found.event.time_us, "channel": channel, "type": kind}
            if found.header:
                head = found.header
                names = ("tick", "sequence", "time_us", "stage", "writer")
                row["header"] = {name: getattr(head, name) for name in names}
            file.write(json.dumps({**row, "message": plain(found.message)}) + "\n")
            count += 1
    return count


def _tables(messages: Messages, out: Path, kind: type[CsvTable] | type[ParquetTable]) -> int:
    try:
        return Tables(out, kind).write(messages)
    except ImportError as error:
        raise _missing(error) from error


def _missing(error: ImportError) -> LogError:
    return LogError(f"{(error.name or 'a library').partition('.')[0]} is not installed; type: {INSTALL}")
