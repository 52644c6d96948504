"""A whole system in one process and one thread: the iteration contract without buses, for tests of many components."""

from collections import ChainMap
from collections.abc import Mapping, MutableMapping, Sequence
from typing import Any

from fwk.clock import US_PER_S
from fwk.component.component import DEFAULT_STAGES, Component
from fwk.component.declaration import declaration
from fwk.component.images import Ring
from fwk.component.main_loop import Holding
from fwk.engine.runner import Runner, Surroundings
from fwk.gateway.ingress import STAGE, WRITER
from fwk.lcm import envelope, messages
from fwk.model.names import LINES
from fwk.plan.wiring.component_spec import Wish
from fwk.plan.wiring.wiring import wire
from fwk.testing.opening import Opening
from fwk.testing.plans import plan_of
from lcmtypes.core import log_t


class MemorySystem:
    """Components in lockstep: `MemorySystem({"cyan1/base": Base, ...}, settings={"cyan1/base": {...}})`, then `tick()`.

    Gives the same messages as the same components in processes of their own. The channels of `outside`, given with
    their types, are the test's to write, with `come_in`.
    """

    def __init__(
        self,
        components: Mapping[str, type[Component]],
        settings: Mapping[str, Mapping[str, Any]] | None = None,
        channels: Mapping[str, Mapping[str, str]] | None = None,
        seed: int = 1,
        period_s: float = 0.05,
        stages: tuple[str, ...] = DEFAULT_STAGES,
        outside: Mapping[str, type[messages.Message]] | None = None,
    ) -> None:
        mistakes: list[str] = []
        wishes = [
            Wish(name, declaration(component), (channels or {}).get(name, {})) for name, component in components.items()
        ]
        wiring = wire(wishes, lambda name, _, text: mistakes.append(f"{name}: {text}"), outside)
        if mistakes:
            raise ValueError("\n".join(mistakes))
        self.now_us = 0
        self.ticks = 0
        self.logged: list[log_t] = []
        self.sent: dict[str, list[bytes]] = {channel.name: [] for channel in wiring.channels}
        """Every message so far, by channel."""
        self._types: MutableMapping[str, type[messages.Message]] = {
            channel.name: messages.type_named(channel.type_name) for channel in wiring.channels
        }
        self._period_us = round(period_s * US_PER_S)
        self._stages = stages
        self._time_source: Runner | None = None
        rings = {channel.name: Ring.create(channel.name) for channel in wiring.channels if channel.images}
        surroundings = Surroundings(seed, self._period_us, self.logged.append, rings, stages=stages)
        self._holding = Holding({wish.name: wish.declaration.stages for wish in wishes})
        self.runners: dict[str, Runner] = {}
        self._seen: dict[str, dict[str, int]] = {}
        self._continuous: list[tuple[Runner, int]] = []  # with the time from iteration to iteration
        self._due_us: dict[str, int] = {}
        self._by_stage: dict[str, list[Runner]] = {stage: [] for stage in stages}
        for wish, ports in zip(wishes, wiring.ports, strict=True):
            config_type = wish.declaration.config
            config = config_type(**(settings or {}).get(wish.name, {}))
            runner = Runner(wish.declaration, wish.name, config, ports, surroundings)
            self.runners[wish.name] = runner
            self._seen[wish.name] = dict.fromkeys(runner.readers, 0)
            for stage in wish.declaration.stages:
                self._by_stage[stage].append(runner)
            if runner.has_plugins:
                raise ValueError(f"{wish.name} asks for PluginControl, and here are no processes; take Bench, or a run")
            if wish.declaration.rate_hz is not None:
                rate_hz = wish.declaration.rate_hz
                self._continuous.append((runner, round(US_PER_S / rate_hz) if rate_hz else 0))
                self._due_us[wish.name] = 0
            if "time_source" in wish.declaration.aspects.values():
                self._time_source = runner
        self._opening: Opening | None = None
        if any(runner.has_blackboard for runner in self.runners.values()):
            plan = plan_of(
                components,
                settings,
                channels,
                stages=stages,
                outside={name: messages.type_name(kind) for name, kind in (outside or {}).items()},
            )
            self._opening = Opening(plan, self.runners, self.sent)
            self._types = ChainMap(self._types, self._opening.types)
        for runner in self.runners.values():
            runner.init()

    def tick(self, times: int = 1) -> None:
        """Runs the main loop."""
        for _ in range(times):
            if LINES in self.sent:
                for line in self.logged[len(self.sent[LINES]) :]:
                    self.come_in(LINES, line)
            self.ticks += 1
            if self._time_source and self._time_source.time_source.next_us >= 0:
                self.now_us = self._time_source.time_source.next_us
            else:
                self.now_us += self._period_us
            self._holding.decide()
            if self._opening:
                self._open(self._opening)
            visible = {channel: len(sent) for channel, sent in self.sent.items()}
            done = [made for runner in self._due() for made in self._run(runner, 1, "", visible)]
            for number, stage in enumerate(self._holding.order or self._stages):
                visible = {channel: len(sent) for channel, sent in self.sent.items()}
                for runner in self._by_stage[stage]:
                    self._publish(self._run(runner, number, stage, visible))
            self._publish(done)

    def _open(self, opening: Opening) -> None:
        for name, channel, first in opening.decide():
            if first < 0:
                del self._seen[name][channel]
            else:
                self._seen[name][channel] = first

    def come_in(self, channel: str, message: Any) -> None:
        """Between two ticks: a program outside writes a message, visible from the next tick on."""
        stamp = envelope.stamper(self._types[channel], channel)
        sent = self.sent[channel]
        sent.append(stamp(message, self.ticks + 1, len(sent) + 1, self.now_us, STAGE, WRITER))

    def newest(self, channel: str) -> Any:
        """The newest message of a channel, decoded; the type's zero before the first."""
        sent = self.sent[channel]
        return envelope.decode(self._types[channel], sent[-1], channel) if sent else self._types[channel]()

    def _due(self) -> list[Runner]:
        """Continuous components whose time has come: here it is logical time, and they are done at the tick's end."""
        found = []
        for runner, period_us in self._continuous:
            if self.now_us >= self._due_us[runner.name]:
                self._due_us[runner.name] = max(self.now_us, self._due_us[runner.name]) + period_us
                found.append(runner)
        return found

    def _publish(self, written: Sequence[tuple[str, bytes]]) -> None:
        for channel, data in written:
            self.sent[channel].append(data)

    def _run(self, runner: Runner, number: int, stage: str, visible: Mapping[str, int]) -> list[tuple[str, bytes]]:
        seen = self._seen[runner.name]
        fresh = {channel: self.sent[channel][seen[channel] : visible[channel]] for channel in seen}
        if self._opening:
            fresh = self._opening.of_their_types(runner, fresh)
        for channel in seen:
            seen[channel] = visible[channel]
        runner.main_loop.holder = self._holding.holder
        written = runner.iterate(self.ticks, number, stage, self.now_us, fresh)
        if self._opening:
            self._opening.ask(self.ticks, number, runner)
        wish = runner.main_loop.take()
        if wish is not None:
            self._holding.ask(self.ticks, number, runner.name, wish)
        return written
