"""A recording at a tick, in the place of a run: pages read from both in the same way."""

import asyncio
import contextlib
from collections.abc import Sequence
from fnmatch import fnmatchcase
from typing import Any

from fwk.clock import US_PER_S
from fwk.control.client import RefusedError
from fwk.display.graph import channel_rows
from fwk.lcm import messages
from fwk.web.recorded import RecordedRun


class RecordedLink:
    """Answers the questions of pages from a recording, as `RunLink` does from a run.

    Args:
        run: the recording.
        name: name of its run directory.
        tick: the tick after which the newest messages are shown; limited to those of the recording.
    """

    recorded = True
    """Whether a recording answers."""

    def __init__(self, run: RecordedRun, name: str, tick: int) -> None:
        self.run, self.name = run, name
        self.last_tick = max(1, run.last_tick)
        self.tick = min(max(1, tick), self.last_tick)

    async def about(self) -> dict[str, Any]:
        """Returns the description of the recording."""
        return {"pid": 0, "run_dir": str(self.run.path.parent), "bus_port": 0, "public_url": ""}

    async def clock(self) -> dict[str, Any]:
        """Returns tick and logical time."""
        time_us = await asyncio.to_thread(self.run.time_us, self.tick)
        return {"tick": self.tick, "time_us": time_us, "paused": True, "pace": 1.0}

    async def status(self, age_s: float = 0.0) -> dict[str, Any]:
        """Returns stages and components of the plan; a recording does not tell the states of components.

        Raises:
            RefusedError: the log has no plan.
        """
        del age_s
        plan = self._plan()
        components = [
            {"name": each.name, "stages": [plan.stages[index] for index in each.stages], "state": ""}
            for each in plan.components
        ]
        return {"plan": plan.name, "pid": 0, "order": plan.stages, "components": components}

    async def lags(self) -> bool:
        """Returns false: a recording is not slowed down."""
        return False

    async def times(self) -> dict[str, Any]:
        """Returns no histograms."""
        return {"components": {}}

    async def channels(self) -> list[dict[str, Any]]:
        """Returns all channels; numbers of messages and rates are those of the whole recording."""
        newest = await asyncio.to_thread(self.run.newest, self.tick)
        now_us = (await self.clock())["time_us"]
        planned = {row["channel"]: row for row in channel_rows(self.run.plan)} if self.run.plan else {}
        return [
            {
                "channel": name,
                "type": info.types[0] if info.types else "",
                "writer": planned.get(name, {}).get("writer", ""),
                "readers": planned.get(name, {}).get("readers", []),
                "messages": info.messages,
                "bytes": info.bytes,
                "rate_hz": info.rate_hz,
                "age_s": _age_s(newest.get(name), now_us),
                "outside": False,
            }
            for name, info in self.run.info.channels.items()
            if not name.startswith("fwk/")
        ]

    async def show(self, channel: str) -> dict[str, Any]:
        """Returns the newest message of a channel as plain data.

        Raises:
            RefusedError: the recording has no such channel.
        """
        info = self.run.info.channels.get(channel)
        if info is None:
            raise RefusedError(f"no channel '{channel}' in {self.name}")
        found = (await asyncio.to_thread(self.run.newest, self.tick)).get(channel)
        header = getattr(found, "header", None)
        return {
            "channel": channel,
            "type": info.types[0] if info.types else "",
            "value": None if found is None else messages.to_dict(found),
            "sequence": header.sequence if header else "?",
            "tick": header.tick if header else "?",
            "time_us": header.time_us if header else 0,
            "by": ", ".join(info.writers),
            "age_s": _age_s(found, (await self.clock())["time_us"]),
            "plain": header is None,
        }

    async def settings(self, names: Sequence[str] = (), age_s: float = 0.0) -> list[dict[str, Any]]:
        """Returns the settings at the start of the recorded run, which cannot be changed.

        Args:
            names: patterns `COMPONENT.SETTING`, or groups of settings; none: all.
        """
        del age_s
        return [
            {
                **{"component": each.name, "setting": setting, "value": value, "type": type(value).__name__},
                **{"origin": origin, "range": "", "meaning": "", "editable": False},
            }
            for each in self._plan().components
            for setting, origin in each.origins.items()
            for value in [_value(each.config, setting)]
            if not names or any(_means(pattern, each.name, setting) for pattern in names)
        ]

    async def types(self, patterns: Sequence[str] = ("*",)) -> dict[str, Any]:
        """Returns the message types of channels as far as they are known here, by channel."""
        found: dict[str, Any] = {}
        for channel, info in self.run.info.channels.items():
            if any(fnmatchcase(channel, each) for each in patterns) and not channel.startswith("fwk/"):
                with contextlib.suppress(messages.MessageError, IndexError):
                    found[channel] = messages.type_named(info.types[0])
        return found

    async def newest(self, patterns: Sequence[str], members: Sequence[str] = ()) -> dict[str, Any]:
        """Returns the newest messages of channels after the tick, decoded, by channel.

        Args:
            patterns: the channels.
            members: only channels whose type has all of these.
        """
        found = await asyncio.to_thread(self.run.newest, self.tick)
        return {
            channel: value
            for channel, value in found.items()
            if any(fnmatchcase(channel, each) for each in patterns) and {*members} <= {*value.__slots__}
        }

    async def message_type(self, channel: str) -> Any:
        """Returns the class of the messages of a channel.

        Raises:
            RefusedError: no such channel, or its type is not known here.
        """
        kind = (await self.types([channel])).get(channel)
        if kind is None:
            raise RefusedError(f"no channel '{channel}' of a known type in {self.name}")
        return kind

    async def ask(self, verb: str, *_: Any, **fields: Any) -> Any:
        """Refuses: a recording cannot be steered.

        Raises:
            RefusedError: always.
        """
        del fields
        raise RefusedError(f"{self.name} is a recording, which cannot {verb}; branch it on the page Recordings")

    async def call(self, name: str, data: bytes, timeout_s: float) -> dict[str, Any]:
        """Refuses: a recording cannot be steered.

        Raises:
            RefusedError: always.
        """
        del data, timeout_s
        raise RefusedError(f"{self.name} is a recording; '{name}' can only be sent to a run")

    def _plan(self) -> Any:
        if self.run.plan is None:
            raise RefusedError(f"{self.name}: the log has no plan")
        return self.run.plan


def _value(config: Any, setting: str) -> Any:
    for name in setting.split("."):
        config = config.get(name) if isinstance(config, dict) else None
    return config


def _means(pattern: str, component: str, setting: str) -> bool:
    components, _, name = pattern.partition(".")
    return fnmatchcase(component, components) and (setting == name or setting.startswith(f"{name}."))


def _age_s(message: Any, now_us: int) -> float | None:
    header = getattr(message, "header", None)
    return max(0, now_us - header.time_us) / US_PER_S if header else None
