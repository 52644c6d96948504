"""Runner of one component with its aspects: the same in a host process, on the test bench and in a replay."""

import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from fwk.clock import Clock, TimeSource
from fwk.component.blackboard import Blackboard
from fwk.component.calls import Calls
from fwk.component.channels import Reads, ReadsHistory, Stamp, Writes, WritesPlain
from fwk.component.component import DEFAULT_STAGES, Component
from fwk.component.config import LOG_LEVEL, Config
from fwk.component.declaration import Declaration
from fwk.component.each import Each
from fwk.component.images import Frames, Image, Ring, VisionMaster
from fwk.component.log import LEVELS, Logger
from fwk.component.log_lines import LogLines
from fwk.component.main_loop import MainLoop
from fwk.component.plugins import PluginControl
from fwk.component.port import Port
from fwk.component.rate_limit import RateLimit
from fwk.component.services import RequestReader, Serves
from fwk.lcm import envelope
from fwk.lcm.messages import Message, has_header
from fwk.model.service_channels import ANSWERS, client_of, service_of
from lcmtypes.core import header_t, log_t

LOST_FRAMES = "lost_frames"
"""Key in what `Runner.requests` returns: frames that the component did not get."""
NOTHING: list[bytes] = []
"""No messages. Readers never change the messages that they are given."""


@dataclass(frozen=True)
class RunSection:
    """Part of the plan and of the process that the aspects of a component need."""

    seed: int
    period_us: int
    sink: Callable[[log_t], None]
    rings: Mapping[str, Ring]
    """Shared-memory rings by channel."""
    lines_per_s: int = 0
    """Most lines that each component may log in a second; 0: no limit."""
    stages: Sequence[str] = DEFAULT_STAGES
    components: Sequence[str] = ()
    """Names of all components of the run; empty: there are no others."""
    frames: Mapping[str, Frames] = field(default_factory=dict)
    """In a replay: sources of frames that replace the rings, by channel."""


class Runner:
    """Builds a component and runs it, iteration by iteration.

    Args:
        declaration: what the class declares.
        name: full name of the component.
        config: its settings; None: the defaults of its class.
        channels: names of the channels of each port, by attribute.
        section: what the aspects need of the run.
        incarnation: number of the component's life, from 1.
    """

    def __init__(
        self,
        declaration: Declaration,
        name: str,
        config: Config | None,
        channels: Mapping[str, Sequence[str]],
        section: RunSection,
        incarnation: int = 1,
    ) -> None:
        self.name = name
        self.readers: dict[str, Reads[Any]] = {}
        self.writers: dict[str, Writes[Any]] = {}
        self.images: dict[str, Image] = {}
        self._services: list[Serves[Any, Any] | Calls[Any, Any] | _Early] = []
        self.clock = Clock(section.period_us)
        self.time_source = TimeSource()
        self.is_time_source = "time_source" in declaration.aspects.values()
        """Whether the component sets the logical time."""
        self.main_loop = MainLoop(name, section.stages)
        self.has_main_loop = "main_loop" in declaration.aspects.values()
        """Whether the component may take over the main loop."""
        self.plugins = PluginControl(name, section.components)
        self.has_plugins = "plugins" in declaration.aspects.values()
        """Whether the component may start and stop others."""
        self.stamp = Stamp(name if incarnation == 1 else f"{name}#{incarnation}")
        self._config = config or declaration.config()
        limit = RateLimit(section.lines_per_s)
        self.log = Logger(name, self.clock, section.sink, self._log_level, limit)
        self.component: Component = declaration.component()
        self._rings, self._frames = section.rings, section.frames
        self._histories: dict[str, int] = {}
        for port in declaration.ports:
            if port.history:
                longest = {each: max(port.history, self._histories.get(each, 0)) for each in channels[port.attribute]}
                self._histories |= longest
        self._refreshed: dict[str, Reads[Any]] = {}  # readers with new messages in the last iteration, by channel
        self.component.name = name
        self._provided = [kind() for kind in declaration.asks.values()]
        for attribute, made in zip(declaration.asks, self._provided, strict=True):
            setattr(self.component, attribute, made)
        setattr(self.component, "config", self._config)  # noqa: B010 - not every component declares one
        for port in declaration.ports:
            self._put(port.attribute, self._port(port, channels[port.attribute]))
        self.blackboard = Blackboard(name, self.stamp, self.readers, self.writers)
        self.has_blackboard = "blackboard" in declaration.aspects.values()
        """Whether the component may open channels while it runs."""
        self._begin = [port._begin for port in self._services]  # actions before an iteration
        self._begin += [aspect.begin for aspect in self._provided]
        if self.has_blackboard:
            self._begin.append(self.blackboard._begin)
        for attribute, aspect in declaration.aspects.items():
            self._put(attribute, self._aspect(aspect, section.seed))

    def init(self) -> None:
        """Initialises the aspects that other components provide, then the component."""
        for aspect in self._provided:
            aspect.init()
        self.component.init()
        early = [
            (writer, envelope.decode(writer.message_type, data, writer.channel))
            for writer in self.writers.values()
            for data in writer._pending
        ]
        if early:
            for writer in self.writers.values():
                writer._drop()
            written = _Early(early)
            self._begin.insert(len(self._services), written._begin)
            self._services.append(written)

    def configure(self, settings: Mapping[str, Any]) -> None:
        """Gives the component all its settings between two iterations and names the changed ones."""
        changed = self._config._take_over(type(self._config).model_validate(settings))
        self.log.level = self._log_level
        if changed - {LOG_LEVEL}:
            self.component.changed_settings = changed - {LOG_LEVEL}
            self.component.config_changed()

    def iterate(
        self, tick: int, stage: int, stage_name: str, time_us: int, fresh: Mapping[str, list[bytes]]
    ) -> list[tuple[str, bytes]]:
        """Runs one iteration with its inputs frozen; returns what it wrote as (channel, message), in a fixed order.

        Args:
            tick: the tick.
            stage: step of the tick, as headers have it.
            stage_name: name of the stage.
            time_us: logical time.
            fresh: messages that became visible since the last iteration, by channel, oldest first.

        Raises:
            Exception: whatever the component raises; nothing was written then.
        """
        clock, stamp = self.clock, self.stamp
        clock.tick = stamp.tick = tick
        clock.now_us = stamp.time_us = time_us
        clock.stage, stamp.stage = stage_name, stage
        before, self._refreshed = self._refreshed, {}
        for channel, arrived in fresh.items():
            reader = self._refreshed[channel] = self.readers[channel]
            reader._freeze(arrived)
        for channel, reader in before.items():
            if self._refreshed.get(channel) is not reader:
                reader._freeze(NOTHING)
        self.time_source._next_us = -1
        try:
            for begin in self._begin:
                begin()
            self.component.loop()
        except BaseException:
            for writer in self.writers.values():
                writer._drop()
            raise
        if self.is_time_source and (mistake := self.time_source._mistake(time_us)):
            self.log.warning(mistake)
        return self._written()

    def pass_over(self, tick: int, stage: int, stage_name: str, time_us: int) -> None:
        """Leaves an iteration out: the clock goes on, and what is visible waits for the next iteration."""
        clock, stamp = self.clock, self.stamp
        clock.tick = stamp.tick = tick
        clock.now_us = stamp.time_us = time_us
        clock.stage, stamp.stage = stage_name, stage
        if tick == 1:  # it takes part from the start, so no request that waits was sent before
            for service in self._services:
                if isinstance(service, Serves):
                    service._take_part()

    def finalize(self, tick: int, time_us: int) -> list[tuple[str, bytes]]:
        """Finalizes the component; returns what it wrote, stamped with the given tick."""
        self.clock.tick = self.stamp.tick = tick
        self.clock.now_us = self.stamp.time_us = time_us
        self.stamp.stage = header_t.FINAL
        self.component.finalize()
        for port in self._services:
            port._end()
        return self._written()

    def _written(self) -> list[tuple[str, bytes]]:
        written = []
        for channel, writer in self.writers.items():
            if writer._pending:
                written += [(channel, data) for data in writer._take()]
        return written

    @property
    def _log_level(self) -> int:
        return LEVELS[getattr(self._config, LOG_LEVEL)]

    def requests(self) -> dict[str, Any]:
        """Returns what the iteration requested of the run, by aspect, and the frames that it missed."""
        order = self.main_loop._take()
        asked = {
            "plugins": self.plugins._take(),
            "blackboard": self.blackboard._take(),
            LOST_FRAMES: self.missed_frames(),
        }
        made: dict[str, Any] = {aspect: request for aspect, request in asked.items() if request}
        return made if order is None else {**made, "main_loop": order}

    def missed_frames(self) -> dict[str, list[int]]:
        """Returns the frames that were overwritten before the component read them, by channel."""
        return {channel: numbers for channel, image in self.images.items() if (numbers := image._take_missed())}

    def _put(self, attribute: str, value: Any) -> None:
        """Sets an attribute of the component, or of one of its aspects (`tf.tree`)."""
        outer, _, own = attribute.rpartition(".")
        setattr(getattr(self.component, outer) if outer else self.component, own, value)

    def _aspect(self, aspect: str, seed: int) -> Any:
        if aspect == "rng":
            return np.random.default_rng(seed_of(seed, self.name))
        return {
            "clock": self.clock,
            "log": self.log,
            "time_source": self.time_source,
            "main_loop": self.main_loop,
            "plugins": self.plugins,
            "blackboard": self.blackboard,
        }[aspect]

    def _port(self, port: Port, channels: Sequence[str]) -> Any:
        if port.owns:
            return _one_or_each(
                port, [(each.name, each) for each in (self._serves(port, *row) for row in _rows(channels))]
            )
        if port.sends:
            pairs = zip(channels[::2], channels[1::2], strict=True)
            return _one_or_each(port, [(each.name, each) for each in (self._calls(port, *pair) for pair in pairs)])
        if port.writes:
            kind: type[Writes[Any]] = Writes if has_header(port.message_type) else WritesPlain
            made = {name: kind(name, port.message_type, self.stamp) for name in channels}
            self.writers.update(made)
            if port.kind == "vision_master":
                return VisionMaster(made[channels[0]], self._rings[channels[0]])
            return _one_or_each(port, list(made.items()))
        read = {channel: self._reader(channel, port.message_type) for channel in channels}
        if port.kind == "lines":
            return LogLines(read[channels[0]], self.name)
        if port.images:
            return _one_or_each(port, [(channel, self._image(channel, read[channel])) for channel in channels])
        return _one_or_each(port, list(read.items()))

    def _image(self, channel: str, announcement: Reads[Any]) -> Image:
        """Returns the only view of a camera; several ports may share it."""
        if channel not in self.images:
            self.images[channel] = Image(announcement, self._frames.get(channel) or self._rings[channel], self.log)
        return self.images[channel]

    def _reader(self, channel: str, message_type: type[Message]) -> Reads[Any]:
        """Returns the only reader of a channel; several ports may share it."""
        if channel not in self.readers:
            length = self._histories.get(channel, 0)
            made = ReadsHistory(channel, message_type, length) if length else Reads(channel, message_type)
            self.readers[channel] = made
        return self.readers[channel]

    def _serves(self, port: Port, answers: str, *sources: str) -> Serves[Any, Any]:
        assert port.reply_type
        made: dict[str, RequestReader[Any]] = {name: RequestReader(name, port.message_type) for name in sources}
        self.readers.update(made)
        self.writers[answers] = Writes(answers, port.reply_type, self.stamp)
        service: Serves[Any, Any] = Serves(service_of(answers), self.name, self.clock, made, self.writers[answers])
        self._services.append(service)
        return service

    def _calls(self, port: Port, sent: str, answers: str) -> Calls[Any, Any]:
        assert port.reply_type
        self.writers[sent] = Writes(sent, port.message_type, self.stamp)
        self.readers[answers] = Reads(answers, port.reply_type)
        client: Calls[Any, Any] = Calls(
            service_of(sent), self.name, self.clock, self.writers[sent], self.readers[answers]
        )
        self._services.append(client)
        return client


class _Early:
    """Messages written in `init`: sent before those of the first iteration, with the same stamp."""

    def __init__(self, written: Sequence[tuple[Writes[Any], Any]]) -> None:
        self._written = written

    def _begin(self) -> None:
        """Writes the messages of `init` when the first iteration begins."""
        for writer, value in self._written:
            own, writer.value = writer.value, value
            writer.write()
            writer.value = own
        self._written = ()

    def _end(self) -> None:
        """Does nothing: without an iteration the messages of `init` are not sent."""


def _rows(channels: Sequence[str]) -> list[Sequence[str]]:
    """Returns the channels of a service, a row for each name: the channel of the replies, then those of the clients."""
    begins = [place for place, name in enumerate(channels) if client_of(name) == ANSWERS]
    return [channels[begin:end] for begin, end in zip(begins, [*begins[1:], len(channels)], strict=True)]


def _one_or_each(port: Port, ports: Sequence[tuple[str, Any]]) -> Any:
    """Returns the only port, or an `Each` of all of them by the namespaces of their names."""
    return Each({name.rpartition("/")[0]: made for name, made in ports}) if port.each else ports[0][1]


def seed_of(seed: int, name: str) -> int:
    """Returns the seed of a component's random numbers, which does not depend on processes and other components."""
    return int.from_bytes(hashlib.sha256(f"{seed}/{name}".encode()).digest()[:8], "big")
