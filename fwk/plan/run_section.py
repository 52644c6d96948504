"""What a launch file says of the run as a whole: time, buses, what programs outside may write, display."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import lcmtypes
from fwk.lcm import envelope, messages
from fwk.model.errors import Problems, hint
from fwk.model.names import mistake_in
from fwk.model.plan import ChannelPlan, LogPlan, Plan, RecordPlan, RunsPlan
from fwk.model.public_url import UrlError, parse_url
from fwk.model.selection import matches
from fwk.plan.classes import UnusableError, find_object, imported
from fwk.plan.files.launch_file import Files

_URL = "udpm://"
_BUFFER = "recv_buf_size"
_PUBLIC_PORT = 7667
_PORTS = range(1024, 65536)


def last(files: Files, key: str, default: Any) -> Any:
    """What the last layer that says something of a key says of it."""
    return next(
        (value for layer in reversed(files.layers) if (value := getattr(layer.content, key)) is not None), default
    )


def merged(files: Files, key: str) -> tuple[dict[str, Any], dict[str, str]]:
    """A mapping that all layers add to, and where each of its keys stands; later layers win."""
    values: dict[str, Any] = {}
    places: dict[str, str] = {}
    for layer in files.layers:
        for name, value in getattr(layer.content, key).items():
            values[name], places[name] = value, layer.node.at(key, name).place
    return values, places


def outside_of(files: Files, problems: Problems) -> dict[str, type[messages.Message]]:
    """Channels that programs outside may write, with their types."""
    names, places = merged(files, "outside")
    found = {}
    for channel, type_name in names.items():
        if mistake := mistake_in(channel):
            problems.add(places[channel], "", mistake)
            continue
        try:
            kind = messages.type_named(type_name)
        except messages.MessageError as error:
            problems.add(places[channel], "", f"{channel}: {error}; {hint(type_name, _types())}")
            files.gaps.add(channel.rpartition("/")[0])
            continue
        if mistake := envelope.mistake_in(kind):
            problems.add(places[channel], "", f"{channel}: {mistake}")
        else:
            found[channel] = kind
    return found


def _types() -> list[str]:
    return [f"{file.parent.name}.{file.stem}" for entry in lcmtypes.__path__ for file in Path(entry).glob("*/*_t.py")]


def public_url_of(files: Files, problems: Problems, bus_port: int | None) -> str:
    """The URL of the public bus; a receive buffer large enough for bursts is added where it is missing.

    Where no file names one, the usual port moves by as much as the bus port does, so that two runs keep apart.
    """
    moved = 0 if bus_port is None else bus_port - Plan.bus_port
    port = _PORTS[(_PUBLIC_PORT - _PORTS[0] + moved) % len(_PORTS)]  # below the lowest comes the highest
    url: str = last(files, "public_url", Plan.public_url.replace(f":{_PUBLIC_PORT}", f":{port}"))
    if not url.startswith(_URL):
        text = f"'{url}' is no public bus; lcm-spy and Java read only {_URL}ADDRESS:PORT, such as {Plan.public_url}"
        problems.add(_place(files, "public_url"), "", text)
    else:
        try:
            parse_url(url)
        except UrlError as error:
            problems.add(_place(files, "public_url"), "", str(error))
    if _BUFFER in url:
        return url
    return f"{url}{'&' if '?' in url else '?'}{Plan.public_url.rpartition('&')[2]}"


def function_of(files: Files, key: str, folders: tuple[str, ...], problems: Problems) -> str:
    """The `module:function` behind a key, which is there and can be called; empty if the files do not name one."""
    use: str = last(files, key, "")
    if use:
        _try(lambda: find_object(use, folders), lambda text: problems.add(_place(files, key), "", f"{key}: {text}"))
    return use


def scoreboard_channels_of(use: str, channels: Sequence[ChannelPlan], folders: tuple[str, ...]) -> tuple[str, ...]:
    """Names of the channels that the scoreboard `use` reads: those that fit `CHANNELS` of its module, or else all.

    Raises:
        UnusableError: there is no such module.
    """
    if not use:
        return ()
    patterns = getattr(imported(use.partition(":")[0], folders), "CHANNELS", ("*",))
    return tuple(each.name for each in channels if any(matches(each.name, pattern) for pattern in patterns))


def log_of(files: Files) -> LogPlan:
    """Where lines of text go."""
    return LogPlan(**_key_by_key(files, "log"))


def runs_of(files: Files) -> RunsPlan:
    """How many run directories stay."""
    return RunsPlan(**_key_by_key(files, "runs"))


def record_of(files: Files, channels: Sequence[ChannelPlan], problems: Problems) -> RecordPlan:
    """Which cameras' frames are recorded; `channels` are those of the whole system."""
    layers = [layer for layer in files.layers if layer.content.record.frames is not None]
    if not layers:
        return RecordPlan()
    cameras = [channel.name for channel in channels if channel.images]
    patterns = layers[-1].content.record.frames or []
    for pattern in patterns:
        if not any(matches(name, pattern) for name in cameras) and not files.gaps:
            place = layers[-1].node.at("record", "frames").place
            problems.add(place, "", f"record: no camera gives out '{pattern}'; {hint(pattern, cameras)}")
    return RecordPlan(tuple(name for name in cameras if any(matches(name, pattern) for pattern in patterns)))


def _key_by_key(files: Files, key: str) -> dict[str, Any]:
    said: dict[str, Any] = {}
    for layer in files.layers:
        said |= getattr(layer.content, key).model_dump(exclude_none=True)
    return said


def _try(find: Callable[[], object], report: Callable[[str], None]) -> None:
    try:
        if not callable(found := find()):
            report(f"{found!r} is no function")
    except UnusableError as error:
        report(str(error))


def _place(files: Files, key: str) -> str:
    layer = next(layer for layer in reversed(files.layers) if getattr(layer.content, key) is not None)
    return layer.node.at(key).place
