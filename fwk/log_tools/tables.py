"""Exports a log to tables, one for each channel: CSV and Parquet."""

import csv
import json
from pathlib import Path
from typing import Any, Protocol

from fwk.lcm.messages import Header, type_name, type_named
from fwk.lcm.type_registry import MessageType
from fwk.log_tools.columns import Column, columns_of
from fwk.log_tools.messages_of import Decoded, Messages
from fwk.log_tools.plain import members_of, plain
from lcmtypes.core import header_t

LOG_TIME = "log_time_us"
"""First column: the time stamp of the event in the log."""
_HEADER = [Column(f"header.{column.name}", column.kind) for column in columns_of(header_t)]
_BATCH = 10_000


class Table(Protocol):
    """File with one row for each message of a channel."""

    def add(self, row: list[Any]) -> None:
        """Adds a row, in the order of the columns."""

    def close(self) -> None:
        """Completes the file."""


class CsvTable:
    """CSV file: a title line, then a line for each message; a list is JSON in one cell."""

    suffix = ".csv"

    def __init__(self, path: Path, columns: list[Column]) -> None:
        self._file = open(path, "w", newline="", encoding="utf-8")  # noqa: SIM115 - closed by close()
        self._lists = [bool(column.dimensions) for column in columns]
        self._writer = csv.writer(self._file, lineterminator="\n")
        self._writer.writerow([column.name for column in columns])

    def add(self, row: list[Any]) -> None:
        """Adds a line."""
        cells = zip(row, self._lists, strict=True)
        self._writer.writerow([json.dumps(plain(value)) if is_list else value for value, is_list in cells])

    def close(self) -> None:
        """Closes the file."""
        self._file.close()


class ParquetTable:
    """Parquet file with typed columns; a list column has lists of numbers, texts or structs, and bytes are binary."""

    suffix = ".parquet"

    def __init__(self, path: Path, columns: list[Column]) -> None:
        import pyarrow as pa
        from pyarrow import parquet

        kinds = {"boolean": pa.bool_(), "byte": pa.uint8(), "string": pa.string(), "float": pa.float32()}
        kinds |= {"double": pa.float64(), **{f"int{bits}_t": getattr(pa, f"int{bits}")() for bits in (8, 16, 32, 64)}}

        def arrow(kind: str, dimensions: tuple[int | str, ...]) -> Any:
            if kind == "byte" and len(dimensions) == 1:
                return pa.binary()
            if dimensions:
                return pa.list_(arrow(kind, dimensions[1:]))
            if kind in kinds:
                return kinds[kind]
            rows = members_of(type_named(kind))
            return pa.struct([pa.field(name, arrow(inner, tuple(sizes))) for name, inner, sizes in rows])

        self._schema = pa.schema([pa.field(column.name, arrow(column.kind, column.dimensions)) for column in columns])
        self._batch_of = pa.RecordBatch.from_pydict
        self._columns: list[list[Any]] = [[] for _ in columns]
        self._lists = [bool(column.dimensions) for column in columns]
        self._writer = parquet.ParquetWriter(path, self._schema)

    def add(self, row: list[Any]) -> None:
        """Adds a row; rows are written in batches."""
        for values, value, is_list in zip(self._columns, row, self._lists, strict=True):
            values.append(_native(value) if is_list else value)
        if len(self._columns[0]) >= _BATCH:
            self._flush()

    def close(self) -> None:
        """Writes the remaining rows and completes the file."""
        self._flush()
        self._writer.close()

    def _flush(self) -> None:
        named = dict(zip(self._schema.names, self._columns, strict=True))
        self._writer.write_batch(self._batch_of(named, schema=self._schema))
        self._columns = [[] for _ in self._columns]


class Tables:
    """Tables of the channels of a log: `folder`/cyan1/odometry.csv for the channel `cyan1/odometry`."""

    def __init__(self, folder: Path, make: type[CsvTable] | type[ParquetTable]) -> None:
        self._folder = folder
        self._make = make
        self._tables: dict[tuple[str, MessageType], tuple[list[Column], Table]] = {}
        self._paths: set[Path] = set()

    def write(self, messages: Messages) -> int:
        """Writes all messages; returns their number."""
        count = 0
        try:
            for found in messages:
                columns, table = self._table(found)
                table.add(
                    [found.event.time_us, *_stamp_values(found.header), *(c.value(found.message) for c in columns)]
                )
                count += 1
        finally:
            for _, table in self._tables.values():
                table.close()
        return count

    def _table(self, found: Decoded) -> tuple[list[Column], Table]:
        key = found.event.channel, found.kind
        if key not in self._tables:
            own = columns_of(found.kind)
            stamped = _HEADER if found.header else []
            path = self._path(found)
            path.parent.mkdir(parents=True, exist_ok=True)
            self._tables[key] = own, self._make(path, [Column(LOG_TIME, "int64_t"), *stamped, *own])
        return self._tables[key]

    def _path(self, found: Decoded) -> Path:
        """Returns the file of a channel; a second type on the channel has its name in that of the file."""
        parts = [part for part in found.event.channel.split("/") if part.strip(".")] or ["channel"]
        path = self._folder.joinpath(*parts[:-1], parts[-1] + self._make.suffix)
        if path in self._paths:
            path = path.with_name(f"{parts[-1]}.{type_name(found.kind)}{self._make.suffix}")
        self._paths.add(path)
        return path


def _stamp_values(header: Header | None) -> list[Any]:
    return [getattr(header, column.name.removeprefix("header.")) for column in _HEADER] if header else []


def _native(value: Any) -> Any:
    """Returns nested messages as dicts, and everything else as it is."""
    if hasattr(value, "__typenames__"):
        return {name: _native(getattr(value, name)) for name in value.__slots__}
    return [_native(each) for each in value] if isinstance(value, list | tuple) else value
