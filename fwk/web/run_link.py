"""The console's connection to one run, which may end and start again."""

import asyncio
import contextlib
from collections.abc import Callable, Collection, Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from fwk.clock import monotonic_us
from fwk.control import runs
from fwk.control.address import gateway_address, running, supervisor_address
from fwk.control.client import Client, ControlError, RefusedError
from fwk.lcm import envelope, messages
from fwk.lcm.type_registry import use_types_of
from fwk.lcm.typegen import TypeGenerationError
from fwk.web.pace import PaceMeter
from fwk.web.shared import Shared

_LOOK_AGE_S = 1.0
_CLOCK_AGE_S = 0.4
_STATUS_AGE_S = 1.0
_CHANNELS_AGE_S = 1.9
_SETTINGS_AGE_S = 4.0
_SHOW_AGE_S = 0.2
_TIMES_AGE_S = 1.5
_FRAME_AGE_S = 0.04
_TIMEOUT_S = 3.0


class NotRunningError(ControlError):
    """The chosen run does not exist at the moment."""


class Runs:
    """All runs of this user on this machine.

    Args:
        shared: answers that browsers share.
        look: asks all runs about themselves; on a busy machine a run may not answer in time.
        ports: finds the bus ports of all runs that exist, whether or not they answer.
    """

    def __init__(
        self,
        shared: Shared,
        look: Callable[[], dict[int, dict[str, Any]]] = runs.look,
        ports: Callable[[], Collection[int]] = running,
    ) -> None:
        self._shared = shared
        self._look = look
        self._ports = ports
        self._seen: dict[int, dict[str, Any]] = {}
        self._links: dict[str, RunLink] = {}

    async def all(self) -> dict[str, dict[str, Any]]:
        """Returns the descriptions of all runs: by name, or by port where several runs share a name."""
        found = await self._shared.get("look", _LOOK_AGE_S, lambda: asyncio.to_thread(self._all))
        names = [run.get("name") or run["plan"] for run in found.values()]
        return {
            name if names.count(name) == 1 else str(port): run
            for name, (port, run) in zip(names, found.items(), strict=True)
        }

    def _all(self) -> dict[int, dict[str, Any]]:
        """Returns the descriptions of all runs by port; a run that does not answer in time is as it was before."""
        found = self._look()
        silent = self._seen.keys() - found.keys()
        if silent:
            silent &= {*self._ports()}
        self._seen = dict(sorted({**found, **{port: self._seen[port] for port in silent}}.items()))
        return self._seen

    def link(self, name: str) -> "RunLink":
        """Returns the connection to the run of that name, whether or not it exists at the moment."""
        if name not in self._links:
            self._links[name] = RunLink(name, self, self._shared)
        return self._links[name]


class RunLink:
    """Asks one run, found by its name each time: a run that starts again under that name is found again.

    Answers are shared between browsers and have a least age, so the work that a run has with a console is bounded:
    dear answers, such as the settings of all components, are asked for more rarely than cheap ones.
    """

    recorded = False
    """Whether a recording answers."""

    def __init__(self, name: str, runs: Runs, shared: Shared) -> None:
        self.name = name
        self._runs = runs
        self._shared = shared
        self._raw: dict[str, bytes] = {}
        self._raw_of = 0  # process of the run that `_raw` belongs to
        self._typed: set[str] = set()
        self._pace = PaceMeter()

    async def about(self) -> dict[str, Any]:
        """Returns the description of the run.

        Raises:
            NotRunningError: it does not exist.
        """
        runs = await self._runs.all()
        ports = {str(run.get("bus_port")): run for run in runs.values()}
        found = runs.get(self.name) or ports.get(self.name)
        if found is None:
            raise NotRunningError(f"'{self.name}' does not run")
        return found

    async def clock(self) -> dict[str, Any]:
        """Returns tick, logical time, desired speed, and whether the run is paused."""
        return await self._kept("speed", _CLOCK_AGE_S)

    async def status(self, age_s: float = _STATUS_AGE_S) -> dict[str, Any]:
        """Returns the state of the run and of its components, at most so old."""
        return await self._kept("status", age_s)

    async def lags(self) -> bool:
        """Tells whether the run needs all processors: it is behind its desired speed, or runs as fast as possible."""
        self._pace.note(await self.clock(), monotonic_us())
        return self._pace.lags

    async def times(self) -> dict[str, Any]:
        """Returns histograms of the times of ticks, stages and components."""
        return await self._kept("times", _TIMES_AGE_S)

    async def channels(self) -> list[dict[str, Any]]:
        """Returns all channels."""
        answer = await self._kept("channels", _CHANNELS_AGE_S, of_gateway=True)
        rows: list[dict[str, Any]] = answer["channels"]
        return rows

    async def show(self, channel: str) -> dict[str, Any]:
        """Returns the newest message of a channel as plain data."""
        return await self._kept("show", _SHOW_AGE_S, of_gateway=True, channel=channel)

    async def settings(self, names: Sequence[str] = (), age_s: float = _SETTINGS_AGE_S) -> list[dict[str, Any]]:
        """Returns the settings of components."""
        answer = await self._kept("settings", age_s, names=tuple(names))
        rows: list[dict[str, Any]] = answer["settings"]
        return rows

    async def types(self, patterns: Sequence[str] = ("*",)) -> dict[str, Any]:
        """Returns the message types of channels as far as they are known here, by channel."""
        await self._use_types()
        found: dict[str, Any] = {}
        for row in await self.channels():
            if any(fnmatchcase(row["channel"], each) for each in patterns):
                with contextlib.suppress(messages.MessageError):
                    found[row["channel"]] = messages.type_named(row["type"])
        return found

    async def newest(self, patterns: Sequence[str], members: Sequence[str] = ()) -> dict[str, Any]:
        """Returns the newest messages of channels, decoded, by channel; those that do not decode are left out.

        Args:
            patterns: the channels.
            members: only channels whose type has all of these.
        """
        found = await self.types(patterns)
        types = {channel: kind for channel, kind in found.items() if {*members} <= {*kind.__slots__}}
        await self._take_newest(sorted(types))
        made = {}
        for channel in self._raw.keys() & types.keys():
            with contextlib.suppress(messages.MessageError):
                made[channel] = envelope.decode(types[channel], self._raw[channel], channel)
        return made

    async def ask(self, verb: str, timeout_s: float = _TIMEOUT_S, of_gateway: bool = False, **fields: Any) -> Any:
        """Asks the run at once, past everything that is kept.

        Raises:
            ControlError: it does not exist, does not answer, or refuses.
        """
        port = (await self.about())["bus_port"]
        address = gateway_address(port) if of_gateway else supervisor_address(port)
        return await asyncio.to_thread(_asked, address, verb, timeout_s, fields)

    async def call(self, name: str, data: bytes, timeout_s: float) -> dict[str, Any]:
        """Sends a request to a component; returns its last answer within the time."""
        port = (await self.about())["bus_port"]
        return await asyncio.to_thread(_called, gateway_address(port), name, data, timeout_s)

    async def message_type(self, channel: str) -> Any:
        """Returns the class of the messages of a channel.

        Raises:
            RefusedError: no such channel, or its type is not known here.
        """
        await self._use_types()
        kinds = {row["channel"]: row["type"] for row in await self.channels()}
        if channel not in kinds:
            raise RefusedError(f"no channel '{channel}' in {self.name}")
        try:
            return messages.type_named(kinds[channel])
        except messages.MessageError as error:
            raise RefusedError(str(error)) from error

    async def _kept(self, verb: str, age_s: float, of_gateway: bool = False, **fields: Any) -> dict[str, Any]:
        pid = (await self.about())["pid"]
        key = (self.name, pid, verb, *fields.items())
        made = await self._shared.get(key, age_s, lambda: self.ask(verb, of_gateway=of_gateway, **fields))
        answer: dict[str, Any] = made
        return answer

    async def _take_newest(self, channels: Sequence[str]) -> None:
        """Gets the messages that are newer than the known ones."""
        pid = (await self.about())["pid"]
        if pid != self._raw_of:
            self._raw, self._raw_of = {}, pid

        async def take() -> None:
            known = {name: messages.sequence_of(self._raw[name]) if name in self._raw else 0 for name in channels}
            answer = await self.ask("newest", of_gateway=True, known=known)
            self._raw.update({name: bytes.fromhex(data) for name, data in answer["messages"].items()})

        await self._shared.get((self.name, pid, "newest", *channels), _FRAME_AGE_S, take)

    async def _use_types(self) -> None:
        for folder in (await self.about()).get("folders", []):
            if folder not in self._typed:
                self._typed.add(folder)
                with contextlib.suppress(TypeGenerationError, OSError):  # types that are installed still decode
                    use_types_of(Path(folder))


def _asked(address: str, verb: str, timeout_s: float, fields: dict[str, Any]) -> dict[str, Any]:
    with Client(address, timeout_s) as run:
        return run.ask(verb, timeout_s, **{name: list(v) if isinstance(v, tuple) else v for name, v in fields.items()})


def _called(address: str, name: str, data: bytes, timeout_s: float) -> dict[str, Any]:
    last: dict[str, Any] = {"state": "not sent", "reason": "the run has ended"}
    with Client(address) as gateway:
        for answer in gateway.follow("call", timeout_s, name=name, data=data.hex(), expires_s=timeout_s):
            last = {"reason": "", "reply": {}, **answer}
            if last["state"] not in ("sent", "accepted"):
                break
    return last
