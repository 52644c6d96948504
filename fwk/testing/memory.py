"""A whole system in one process and one thread."""

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from fwk.bus.sync import place_of
from fwk.clock import US_PER_S
from fwk.component.component import DEFAULT_STAGES, Component
from fwk.component.declaration import declaration
from fwk.component.images import Ring
from fwk.engine.assignment import Assignment, Start
from fwk.engine.channel_grants import ChannelGrants
from fwk.engine.component_group import Written
from fwk.engine.failures import ComponentFailedError
from fwk.engine.runner import Runner
from fwk.engine.schedule import Schedule
from fwk.engine.visibility import Visibility
from fwk.gateway.ingress import WRITER
from fwk.host.memory_host import MemoryHost
from fwk.lcm import envelope, messages
from fwk.model.channel_table import change_message
from fwk.model.errors import hint
from fwk.model.names import LINES
from fwk.model.plan import NOBODY, ChannelPlan, ComponentPlan, Plan
from fwk.model.requests import channel_request_of
from fwk.model.sections import LogPlan
from fwk.plan.hosting import Hosting, share_out
from fwk.testing.plans import plan_of
from lcmtypes.core import done_t, header_t, log_t

T = TypeVar("T")


class MemorySystem:
    """Components in lockstep, in the same `Host` objects as in processes, driven by a loop in memory.

    `MemorySystem({"cyan1/base": Base, ...}, settings={"cyan1/base": {...}})`, then `tick()`. The messages are those
    of the same components in processes. A test writes the channels of `outside`, given with their types, with
    `come_in`. `turns` are `every` and `offset` of components, where they differ from the class; `launched` is the
    plan of a launch file, as `plan_of` takes it. `hosting` means the same as for `fwk-launch`: messages between
    components of one host are not packed, so `single` is the fastest.

    Raises:
        ValueError: the components do not fit together.
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
        turns: Mapping[str, tuple[int, int]] | None = None,
        hosting: Hosting = "process",
        launched: Plan | None = None,
    ) -> None:
        for name, kind in components.items():
            if "plugins" in declaration(kind).aspects.values():
                raise ValueError(f"{name} declares PluginControl, which needs processes; use Bench, or a run")
        plan = plan_of(
            components,
            settings,
            channels,
            _groups(components, hosting),
            period_s=period_s,
            stages=stages,
            seed=seed,
            outside={name: messages.type_name(kind) for name, kind in (outside or {}).items()},
            log=LogPlan(lines_per_s=0),
            turns=turns,
            launched=launched,
        )
        self.now_us = 0
        self.ticks = 0
        self.logged: list[log_t] = []
        self.sent: dict[str, list[bytes]] = {channel.name: [] for channel in plan.channels}
        """All messages so far, by channel."""
        self._plan = plan
        self._types = {channel.name: messages.type_named(channel.type_name) for channel in plan.channels}
        self._indices = {channel.name: channel.index for channel in plan.channels}
        self._receivers = {channel.index: _receivers(plan, channel) for channel in plan.channels}
        self._newest: dict[int, bytes] = {}
        self._ledger = Visibility(plan)
        self._schedule = Schedule(plan)
        self._grants = ChannelGrants(plan)
        self._changes = 0
        self._next_us = -1  # logical time of the next tick, as the time source set it last
        # Host and step of the components that set the time.
        self._time_source = {
            (each.host, stage)
            for each in plan.components
            if "time_source" in declaration(components[each.name]).aspects.values()
            for stage in each.stages
        }
        self._due_us: dict[int, int] = {}  # of the continuous components
        rings = {channel.name: Ring.create(channel.name) for channel in plan.channels if channel.images}
        for component in plan.components:
            self._grants.came(component.index, 1)
        self._hosts = [
            MemoryHost(
                Assignment(plan, host.index, 0, Start(1, {}, {}), rings),
                self._ledger,
                self.logged.append,
                lambda component: components[component.name],
            )
            for host in plan.hosts
        ]
        self._in_stage = [
            [
                host.index
                for host in plan.hosts
                if any(stage in plan.components[each].stages for each in host.components)
            ]
            for stage in range(len(stages))
        ]
        for host in self._hosts:
            self._call(host.init)
        self.runners: dict[str, Runner] = {
            component.name: self._hosts[component.host].runners[component.name] for component in plan.components
        }

    def tick(self, times: int = 1) -> None:
        """Runs the main loop.

        Raises:
            Exception: whatever a component raises.
        """
        for _ in range(times):
            if LINES in self.sent:
                for line in self.logged[len(self.sent[LINES]) :]:
                    self.come_in(LINES, line)
            self.ticks += 1
            self.now_us = self._next_us if self._next_us >= 0 else self.now_us + self._plan.period_us
            self._schedule.decide()
            if self._grants.asked:
                self._decide()
            self._ledger.begin()
            late = [self._iterate_on(component) for component in self._due()]
            for step, stage in self._schedule.steps:
                self._ledger.begin()
                ran = [self._iterate(host, step, stage) for host in self._in_stage[stage]]
                for written in ran:
                    self._publish(written)
            for written in late:
                self._publish(written)

    def come_in(self, channel: str, message: Any) -> None:
        """Writes a message as a program outside does; it is visible from the next tick on."""
        stamp = envelope.stamper(self._types[channel], channel)
        number = len(self.sent[channel]) + 1
        self._publish([(channel, stamp(message, self.ticks + 1, number, self.now_us, header_t.OUTSIDE, WRITER))])

    def newest(self, channel: str) -> Any:
        """Returns the newest message of a channel, decoded; the type's zero before the first.

        Raises:
            KeyError: there is no such channel; the text names the nearest.
        """
        if channel not in self.sent:
            raise KeyError(f"no channel '{channel}'; {hint(channel, self.sent)}")
        sent = self.sent[channel]
        return envelope.decode(self._types[channel], sent[-1], channel) if sent else self._types[channel]()

    def _due(self) -> list[ComponentPlan]:
        """Returns the continuous components that are due by logical time; an iteration takes no longer than a tick."""
        found = []
        for component in self._plan.components:
            due_us = self._due_us.get(component.index, 0)
            if component.rate_hz is not None and self.now_us >= due_us:
                period_us = round(US_PER_S / component.rate_hz) if component.rate_hz else 0
                self._due_us[component.index] = max(self.now_us, due_us) + period_us
                found.append(component)
        return found

    def _iterate(self, host: int, step: int, stage: int) -> Written:
        memory = self._hosts[host]
        tick = memory.compose(self.ticks, step, self.now_us, self._schedule.holder)
        written, done = self._call(lambda: memory.tick(tick, stage))
        if (host, stage) in self._time_source:
            self._next_us = done.next_time_us
        self._take_requests(done)
        return written

    def _iterate_on(self, component: ComponentPlan) -> Written:
        host = self._hosts[component.host]
        host.tell(host.compose(self.ticks, 0, self.now_us, self._schedule.holder))
        written, done = self._call(host.iterate)
        self._take_requests(done)
        return written

    def _take_requests(self, done: done_t) -> None:
        """Takes what components asked for in a done: the main loop, dynamic channels."""
        for request in done.main_loop:
            self._schedule.ask(done.tick, place_of(done), request)
        for asked in done.channels:
            name = self._plan.components[asked.component].name
            self._grants.ask(done.tick, place_of(done), name, [channel_request_of(asked)])

    def _publish(self, written: Written) -> None:
        """Makes messages visible from the next step of the tick on."""
        for channel, data in written:
            index = self._indices[channel]
            self.sent[channel].append(data)
            self._newest[index] = data
            self._ledger.publish(index, messages.sequence_of(data))
            for receiver in self._receivers[index]:
                self._hosts[receiver].put(index, data)

    def _decide(self) -> None:
        """Decides the requests for dynamic channels at the boundary."""
        facts, _ = self._grants.decide()
        numbered = [fact.numbered(self._ledger.latest(fact.channel.index)) if fact.channel else fact for fact in facts]
        self._changes += 1
        change = change_message(self._changes, numbered)
        self._ledger.opened(self._grants.table)
        for fact in numbered:
            if fact.channel:
                opened = fact.channel
                self._types[opened.name] = messages.type_named(opened.type_name)
                self.sent.setdefault(opened.name, [])
                self._receivers.setdefault(opened.index, set())
                if fact.kind == "write":
                    self._indices[opened.name] = opened.index
                elif fact.kind == "read":
                    self._receivers[opened.index].add(self._plan.components[fact.component].host)
        for host in self._plan.hosts:
            if any(self._plan.components[each].opens for each in host.components):
                self._hosts[host.index].decide(change, self._newest)

    @staticmethod
    def _call(work: Callable[[], T]) -> T:
        """Lets a host work; exceptions of a component leave as they were raised, unless they would end the program."""
        try:
            return work()
        except ComponentFailedError as failure:
            if isinstance(failure.__cause__, SystemExit):
                raise
            raise failure.__cause__ or failure from None


def _groups(components: Mapping[str, type[Component]], hosting: Hosting) -> list[list[str]]:
    """Returns the names of the components of each host; a continuous component has its own."""
    names = list(components)
    alone = {name for name, kind in components.items() if declaration(kind).rate_hz is not None}
    return [[names[each] for each in host.components] for host in share_out(names, hosting, {}, alone=alone)]


def _receivers(plan: Plan, channel: ChannelPlan) -> set[int]:
    """Returns the hosts that get the messages of a channel from elsewhere: all of its readers but the writer's own."""
    readers = {plan.components[reader].host for reader in channel.readers}
    return readers - ({plan.components[channel.writer].host} if channel.writer != NOBODY else set())
