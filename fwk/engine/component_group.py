"""The components of one host: builds them, runs their iterations, collects what they write and request."""

import json
from collections.abc import Callable, Iterable, Mapping, Sequence

from fwk.component.component import Component
from fwk.component.declaration import declaration
from fwk.component.log import Logger
from fwk.engine.assignment import Assignment
from fwk.engine.catch_up import CatchUp
from fwk.engine.channel_buffer import ChannelBuffer
from fwk.engine.failures import Failures
from fwk.engine.input_view import InputView
from fwk.engine.metrics import ComponentMetrics
from fwk.engine.plan_match import check_ports, check_unchanged, config_of
from fwk.engine.runner import LOST_FRAMES, Runner, RunSection
from fwk.model.channel_table import ChannelTable, Fact, OpenChannel, facts_in, facts_of
from fwk.model.plain_values import value_of
from fwk.model.plan import NOBODY, ComponentPlan
from fwk.model.requests import channel_request, lost_frame, main_loop_request, plugin_request
from fwk.plan.wiring.start_order import start_order
from lcmtypes.core import channels_change_t, done_t, log_t, settings_change_t, tick_t

Written = list[tuple[str, bytes]]
"""Messages in the order in which they were written, each with its channel."""


Ran = tuple[Written, int, int]
"""Result of one step of a tick for the whole group: what was written, the logical time of the next tick as a time
source set it (-1: none did), and the wall time that the iterations took, in microseconds."""


class ComponentGroup:
    """Takes the components of a host from `init` to `finalize`.

    Every exception of a component leaves the group as a `ComponentFailedError`.
    """

    def __init__(
        self,
        assignment: Assignment,
        find_class: Callable[[ComponentPlan], type[Component]],
        make_runner: Callable[..., Runner],
        now_us: Callable[[], int],
        lift_memory_limit: Callable[[], None],
        log: Logger,
        send_log: Callable[[log_t], None],
    ) -> None:
        plan = assignment.plan
        self.plans = [plan.components[index] for index in plan.hosts[assignment.host].components]
        self.metrics = {component.name: ComponentMetrics(component.name, now_us) for component in self.plans}
        self.runners: dict[str, Runner] = {}
        self.table = ChannelTable(plan) if any(each.opens for each in self.plans) else None
        """All channels of the run; None if no component of the group can open channels."""
        self._assignment = assignment
        self._plan = plan
        self._find_class = find_class
        self._make_runner = make_runner
        self._now_us = now_us
        self._send_log = send_log
        limit_mb = plan.memory_limit_mb(assignment.host) or 0.0
        self._failures = Failures(self.metrics, limit_mb, lift_memory_limit, log)
        self._index = {component.name: component.index for component in self.plans}
        self._in_turns = {component.name: component for component in self.plans if component.every > 1}
        self._marker = assignment.marker if len(self.plans) > 1 else None  # a single component needs no marker
        self._with_main_loop: list[Runner] = []
        self._requesting: list[Runner] = []  # runners whose components may request or report something with a done
        incarnation = assignment.start.incarnation
        self._views = {
            component.name: InputView(CatchUp(incarnation, component.rate_hz is not None)) for component in self.plans
        }
        own = {component.index for component in self.plans}
        self._readers: dict[int, list[str]] = {
            channel.index: [plan.components[reader].name for reader in channel.readers if reader in own]
            for channel in plan.channels
            if not own.isdisjoint(channel.readers)
        }
        if self.table:
            self.table.apply(facts_of(assignment.start.blackboard))
        self._newest_change = assignment.start.newest_change  # number of the newest change that was taken over

    def init(self, report: Callable[[], None]) -> None:
        """Builds and initialises the components in the order of their needs.

        Args:
            report: called when the state of a component has changed.

        Raises:
            ComponentFailedError: a component cannot be built, or its `init` raised.
        """
        for index in start_order(self._plan.components, [component.index for component in self.plans]):
            component = self._plan.components[index]
            self.metrics[component.name].state = "init"
            report()
            self._mark(index)
            with self._failures.guard(component.name, "init"):
                runner = self._runner(component)
                self.runners[component.name] = runner
                if runner.has_main_loop:
                    self._with_main_loop.append(runner)
                if self.table:
                    runner.blackboard._first(self.table)
                # In lockstep no frame is overwritten before its readers have seen it.
                loses_frames = runner.images and self._plan.clock == "wall"
                if runner.has_main_loop or runner.has_plugins or runner.has_blackboard or loses_frames:
                    self._requesting.append(runner)
                runner.init()
            self.metrics[component.name].state = "running"
        self._mark(NOBODY)

    def deliver(self, moved: Iterable[ChannelBuffer]) -> None:
        """Hands newly visible messages to the components that read them."""
        for buffer in moved:
            arrived, channel = buffer.take(), buffer.plan.name
            for name in self._readers[buffer.plan.index]:
                self._views[name].arrive(channel, arrived)

    def configure(self, settings: Sequence[settings_change_t], channels: Sequence[channels_change_t]) -> None:
        """Applies changes of settings, each once; changes of channels have been taken over by then.

        Raises:
            ComponentFailedError: a component refused its new settings.
        """
        for change in settings:
            component = self._plan.components[change.component]
            if component.name in self.runners and change.number > self._newest_change:
                with self._failures.guard(component.name, "config_changed"):
                    self.runners[component.name].configure(value_of(change.values))
        newest = [change.number for change in settings] + [change.number for change in channels]
        self._newest_change = max([self._newest_change, *newest])

    def new_facts(self, changes: Sequence[channels_change_t]) -> list[Fact]:
        """Returns the decisions about channels that were not taken over yet."""
        return [fact for change in changes if change.number > self._newest_change for fact in facts_in(change)]

    def take_over(self, fact: Fact) -> bool:
        """Applies a blackboard decision; returns whether a component of the group reads its channel afterwards."""
        assert self.table
        events = self.table.apply([fact])
        for component in self.plans:
            if component.opens:
                runner = self.runners[component.name]
                done = runner.blackboard._take_over(self.table, component.index, fact, events)
                if fact.channel and done == "opened":
                    self._begin_reading(component.name, fact.channel)
                elif fact.channel and done == "closed":
                    self._readers[fact.channel.index].remove(component.name)
                    self._views[component.name].leave(fact.channel.name)
        return fact.channel is not None and bool(self._readers.get(fact.channel.index))

    def _begin_reading(self, name: str, opened: OpenChannel) -> None:
        """Starts a component on the newest message that another reader in the group has; otherwise on none."""
        readers, channel = self._readers.setdefault(opened.index, []), opened.name
        newest: list[bytes] = []
        if readers:
            other = readers[0]
            before = self.runners[other].readers[channel]._raw
            newest = [*([before] if before else []), *self._views[other].waiting(channel)][-1:]
        self._views[name].join(channel, newest)
        readers.append(name)

    def set_holder(self, component: int) -> None:
        """Tells the components that may take the main loop over which component has it; `NOBODY`: none."""
        if self._with_main_loop:
            name = self._plan.components[component].name if component != NOBODY else ""
            for runner in self._with_main_loop:
                runner.main_loop.holder = name

    def run(self, names: Sequence[str], stage: str, tick: tick_t, place: int) -> Ran:
        """Runs one iteration of each of these components that is due in the tick, in this order.

        Args:
            names: the components.
            stage: name of the stage; empty for a continuous component.
            tick: the tick that the iterations answer.
            place: `stage` in the headers of what they write: step of the tick, or number of the iteration.

        Raises:
            ComponentFailedError: a `loop` raised.
        """
        written: Written = []
        next_us, now_us = -1, self._now_us
        began_us = start_us = now_us()
        for name in names:
            runner = self.runners[name]
            if name in self._in_turns and not self._in_turns[name].due(tick.tick):
                runner.pass_over(tick.tick, place, stage, tick.time_us)
                self._views[name].pass_over(tick.tick)
                continue
            if self._marker:
                self._mark(self._index[name])
            try:
                seen = self._views[name].take(tick.tick)
                written += runner.iterate(tick.tick, place, stage, tick.time_us, seen)
            except BaseException as error:
                self._failures.make_room(error)
                self._failures.put(name, f"loop, tick {tick.tick}", error)
                raise
            end_us = now_us()
            self.metrics[name].times.add(end_us - start_us)
            start_us = end_us
            if runner.is_time_source:
                next_us = max(next_us, runner.time_source.next_us)
        if self._marker:
            self._mark(NOBODY)
        return written, next_us, start_us - began_us

    def put_requests(self, names: Sequence[str], done: done_t) -> None:
        """Writes what the iterations of these components requested, and the frames that they lost, into a done."""
        for runner in self._requesting:
            if runner.name not in names:  # its stage comes later, as it would in a separate process
                continue
            component, asked = self._index[runner.name], runner.requests()
            if (order := asked.get("main_loop")) is not None:
                schedule = [self._plan.stages.index(stage) for stage in order]
                done.main_loop.append(main_loop_request(component, schedule))
            done.plugins += [plugin_request(component, *request) for request in asked.get("plugins", ())]
            done.channels += [channel_request(component, request) for request in asked.get("blackboard", ())]
            self._put_lost_frames(component, asked.get(LOST_FRAMES, {}), done)

    def put_lost_frames(self, done: done_t) -> None:
        """Writes the frames that the components lost while they finalized into a done."""
        for name, runner in self.runners.items():
            self._put_lost_frames(self._index[name], runner.missed_frames(), done)

    def _put_lost_frames(self, component: int, lost: Mapping[str, Sequence[int]], done: done_t) -> None:
        cameras = {channel.name: channel.index for channel in self._plan.channels if channel.images} if lost else {}
        done.lost_frames += [
            lost_frame(component, cameras[channel], frame) for channel, frames in lost.items() for frame in frames
        ]

    def finalize(self) -> tuple[Written, int]:
        """Finalizes the components; returns what they wrote and the newest tick that any of them ran in.

        The messages of each component carry the tick of its own last iteration.

        Raises:
            ComponentFailedError: a `finalize` raised.
        """
        tick = max(runner.stamp.tick for runner in self.runners.values())
        written: Written = []
        for name, runner in reversed(self.runners.items()):
            self.metrics[name].state = "finalizing"
            self._mark(self._index[name])
            with self._failures.guard(name, "finalize"):
                written += runner.finalize(runner.stamp.tick, runner.stamp.time_us)
            self.metrics[name].state = "stopped"
        return written, tick

    def out_of_memory(self, error: MemoryError) -> None:
        """Attributes memory that ran out between two iterations to the first component.

        Raises:
            ComponentFailedError: always.
        """
        self._failures.put(self.plans[0].name, "its process", error)

    def current_log(self) -> Logger | None:
        """Returns the log of the component that is being executed; None if none is."""
        if len(self.plans) == 1:
            name = self.plans[0].name
        else:
            working = self._marker.at(self._assignment.host) if self._marker else NOBODY
            name = self._plan.components[working].name if working != NOBODY else ""
        return self.runners[name].log if name in self.runners else None

    def _mark(self, component: int) -> None:
        if self._marker:
            self._marker.works(self._assignment.host, component)

    def _runner(self, component: ComponentPlan) -> Runner:
        declared = declaration(self._find_class(component))
        if before := self._assignment.before.get(component.name):
            stages = tuple(self._plan.stages[index] for index in component.stages)
            check_unchanged(component, stages, before, declared)
        check_ports(component, declared)
        start = self._assignment.start
        changed = start.settings.get(component.name)
        config = config_of(component, declared, json.loads(changed) if changed else component.config)
        section = RunSection(
            self._plan.seed,
            self._plan.period_us,
            self._send_log,
            self._assignment.rings,
            self._plan.log.lines_per_s,
            self._plan.stages,
            [each.name for each in self._plan.components],
            self._assignment.frames,
        )
        runner = self._make_runner(declared, component.name, config, component.channels, section, start.incarnation)
        runner.clock.every = component.every
        for channel, writer in runner.writers.items():
            writer.sequence = start.sequences.get(channel, 0)
        return runner
