"""Reads the sections of a launch file about the run as a whole: time, buses, outside, log, recording, display."""

import ipaddress
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import lcmtypes
from fwk.lcm import envelope, messages
from fwk.model.errors import Problems, hint
from fwk.model.names import mistake_in
from fwk.model.plan import ChannelPlan, Plan
from fwk.model.public_url import UrlError, parse_url
from fwk.model.sections import LogPlan, RecordPlan, RunsPlan
from fwk.model.selection import matches
from fwk.plan.classes import UnusableError, find_object, imported
from fwk.plan.files.launch_file import Files

_URL = "udpm://"
_BUFFER = "recv_buf_size"
_PUBLIC_PORT = 7667
_PORTS = range(1024, 65536)
_LIMITS = ("split_mb", "split_s")


def last(files: Files, key: str, default: Any) -> Any:
    """Returns the value of a key in the last layer that sets it."""
    return next(
        (value for layer in reversed(files.layers) if (value := getattr(layer.content, key)) is not None), default
    )


def merged(files: Files, key: str) -> tuple[dict[str, Any], dict[str, str]]:
    """Returns a mapping merged from all layers, and the place of each of its keys; later layers win."""
    values: dict[str, Any] = {}
    places: dict[str, str] = {}
    for layer in files.layers:
        for name, value in getattr(layer.content, key).items():
            values[name], places[name] = value, layer.node.at(key, name).place
    return values, places


def outside_of(files: Files, problems: Problems) -> dict[str, type[messages.Message]]:
    """Returns the channels that programs outside may write, with their types."""
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


def default_public_url(bus_port: int | None) -> str:
    """Returns the URL of the public bus of a run with this bus port, where no file sets another."""
    moved = 0 if bus_port is None else bus_port - Plan.bus_port
    port = _PORTS[(_PUBLIC_PORT - _PORTS[0] + moved) % len(_PORTS)]  # wraps around
    return Plan.public_url.replace(f":{_PUBLIC_PORT}", f":{port}")


def public_url_of(files: Files, problems: Problems, bus_port: int | None) -> str:
    """Returns the URL of the public bus, with a receive buffer that is large enough for bursts; empty: no public bus.

    Where no file sets the URL, its port moves with the bus port, so that two runs do not hear each other.
    """
    url: str = last(files, "public_url", default_public_url(bus_port))
    if not url:
        return ""
    if not url.startswith(_URL):
        text = f"'{url}' is not a public bus; lcm-spy and Java read only {_URL}ADDRESS:PORT, such as {Plan.public_url}"
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
    """Returns the `module:function` of a key after checking that it can be called; empty if no file sets it."""
    use: str = last(files, key, "")
    if use:
        _try(lambda: find_object(use, folders), lambda text: problems.add(_place(files, key), "", f"{key}: {text}"))
    return use


def scoreboard_channels_of(use: str, channels: Sequence[ChannelPlan], folders: tuple[str, ...]) -> tuple[str, ...]:
    """Returns the channels that the scoreboard `use` reads: those that match `CHANNELS` of its module, or else all.

    Raises:
        UnusableError: the module cannot be imported.
    """
    if not use:
        return ()
    patterns = getattr(imported(use.partition(":")[0], folders), "CHANNELS", ("*",))
    return tuple(each.name for each in channels if any(matches(each.name, pattern) for pattern in patterns))


def log_of(files: Files, problems: Problems) -> LogPlan:
    """Returns the targets of the log."""
    log = LogPlan(**_key_by_key(files, "log"))
    if not _is_syslog(log.syslog_to):
        right = "it should be a socket's path, or an address and port such as 10.0.0.7:514"
        place = next(
            node.place for layer in reversed(files.layers) if (node := layer.node.at("log").child("syslog_to"))
        )
        problems.add(place, "", f"'log.syslog_to' is '{log.syslog_to}'; {right}")
    return log


def _is_syslog(to: str) -> bool:
    """Returns whether a text is the path of a socket, or an IPv4 address and a port."""
    address, _, port = to.rpartition(":")
    try:
        ipaddress.IPv4Address(address)
    except ValueError:
        return to.startswith("/")
    return port.isdecimal() and 0 < int(port) < 1 << 16


def runs_of(files: Files) -> RunsPlan:
    """Returns how many run directories are kept."""
    return RunsPlan(**_key_by_key(files, "runs"))


def record_of(
    files: Files,
    channels: Sequence[ChannelPlan],
    options: Mapping[str, Sequence[str]],
    parts: Mapping[str, float],
    problems: Problems,
) -> RecordPlan:
    """Returns what is recorded.

    Args:
        files: the launch file and what it includes.
        channels: those of the whole system.
        options: patterns of the command line, which come before those of the files: `channels` and `exclude`.
        parts: what the command line says about parts, before the files: `split_mb` or `split_s`, and `compress`.
        problems: takes the mistakes.
    """
    cameras = [channel.name for channel in channels if channel.images]
    frames = _patterns(files, "frames", (), cameras, problems)
    names = [channel.name for channel in channels]
    has_limit = any(key in parts for key in _LIMITS)
    limits = {key: parts.get(key, 0.0) if has_limit else _last(files, key, 0.0) for key in _LIMITS}
    return RecordPlan(
        frames=tuple(name for name in cameras if any(matches(name, pattern) for pattern in frames)),
        channels=_patterns(files, "channels", options["channels"], names, problems),
        exclude=_patterns(files, "exclude", options["exclude"], names, problems),
        size_gb=_last(files, "size_gb", 0.0),
        split_mb=limits["split_mb"],
        split_s=limits["split_s"],
        compress=bool(parts.get("compress") or _last(files, "compress", False)),
    )


def _last(files: Files, key: str, default: float) -> float:
    """Returns the value of a key of `record:` in the last layer that sets it."""
    values = (getattr(layer.content.record, key) for layer in reversed(files.layers))
    return next((value for value in values if value is not None), default)


def _patterns(
    files: Files, key: str, option: Sequence[str], names: Sequence[str], problems: Problems
) -> tuple[str, ...]:
    """Returns the patterns of a key of `record`, or of its option; one that matches no name is a mistake."""
    layers = [layer for layer in files.layers if getattr(layer.content.record, key) is not None]
    patterns = option or (getattr(layers[-1].content.record, key) if layers else ())
    for pattern in patterns:
        if not any(matches(name, pattern) for name in names) and not files.gaps:
            place = f"--record-{key}" if option else layers[-1].node.at("record", key).place
            what = "camera publishes" if key == "frames" else "channel matches"
            problems.add(place, "", f"record: no {what} '{pattern}'; {hint(pattern, names)}")
    return tuple(patterns)


def _key_by_key(files: Files, key: str) -> dict[str, Any]:
    """Returns the values that the layers set in a section; later layers win."""
    values: dict[str, Any] = {}
    for layer in files.layers:
        section, node = getattr(layer.content, key), layer.node.child(key)
        values |= {name: getattr(section, name) for name in node.plain()} if node else {}
    return values


def _try(find: Callable[[], object], report: Callable[[str], None]) -> None:
    try:
        if not callable(found := find()):
            report(f"{found!r} is not a function")
    except UnusableError as error:
        report(str(error))


def _place(files: Files, key: str) -> str:
    layer = next(layer for layer in reversed(files.layers) if getattr(layer.content, key) is not None)
    return layer.node.at(key).place
