"""The components of a process: what each gets, their iterations, and what they wrote."""

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib import import_module

from pydantic import ValidationError

from fwk.component.declaration import declaration
from fwk.component.log import Logger
from fwk.component.port import DeclarationError
from fwk.engine.channel_buffer import ChannelBuffer
from fwk.engine.runner import LOST_FRAMES, Runner, Surroundings
from fwk.host.assignment import Assignment
from fwk.host.failures import Blame
from fwk.host.hot_reload import check_unchanged
from fwk.host.metrics import Figures
from fwk.model.channel_table import Fact, Instances, Opening, facts_in, facts_of
from fwk.model.plain_values import value_of
from fwk.model.plan import NOBODY, ComponentPlan
from fwk.model.requests import channel_request, lost_frame, main_loop_request, plugin_request
from fwk.plan.wiring.start_order import start_order
from lcmtypes.core import channels_change_t, done_t, log_t, settings_change_t, tick_t


class Members:
    """Takes the components of a host from `init` to `finalize`.

    Whatever one of them raises comes out as `Failure`.
    """

    def __init__(
        self,
        assignment: Assignment,
        make_runner: Callable[..., Runner],
        now_us: Callable[[], int],
        log: Logger,
        send_log: Callable[[log_t], None],
    ) -> None:
        plan = assignment.plan
        self.plans = [plan.components[index] for index in plan.hosts[assignment.host].components]
        self.figures = {component.name: Figures(component.name, now_us) for component in self.plans}
        self.runners: dict[str, Runner] = {}
        self._assignment = assignment
        self._plan = plan
        self._make_runner = make_runner
        self._now_us = now_us
        self._send_log = send_log
        self._blame = Blame(self.figures, plan.memory_limit_mb(assignment.host) or 0.0, log)
        self._index = {component.name: component.index for component in self.plans}
        self._progress = assignment.progress if len(self.plans) > 1 else None  # one alone needs no telling apart
        self._takers: list[Runner] = []  # those that may take over the main loop
        self._wishing: list[Runner] = []  # those that may ask something of the main loop
        self._waiting: dict[str, dict[str, list[bytes]]] = {}  # what each component has not seen yet, by channel
        own = set(self._own)
        self._readers: dict[int, list[str]] = {
            channel.index: [plan.components[reader].name for reader in channel.readers if reader in own]
            for channel in plan.channels
            if not own.isdisjoint(channel.readers)
        }
        self.instances = Instances(plan) if any(each.opens for each in self.plans) else None
        if self.instances:
            self.instances.apply(facts_of(assignment.start.blackboard))
        self._configured = assignment.start.newest_change  # number of the newest change of settings taken over

    @property
    def _own(self) -> Sequence[int]:
        return self._plan.hosts[self._assignment.host].components

    def init(self, told: Callable[[], None]) -> None:
        """Makes and initialises them, in the order of their needs; calls `told` when a state changes."""
        for index in start_order(self._plan.components, self._own):
            plan = self._plan.components[index]
            self.figures[plan.name].state = "init"
            told()
            self._works(index)
            with self._blame.guard(plan.name, "init"):
                runner = self._runner(plan)
                self.runners[plan.name] = runner
                self._waiting[plan.name] = {}
                if runner.has_main_loop:
                    self._takers.append(runner)
                if self.instances:
                    runner.blackboard.first(self.instances)
                misses = runner.images and self._plan.clock == "wall"  # in lockstep no frame is missed
                if runner.has_main_loop or runner.has_plugins or runner.has_blackboard or misses:
                    self._wishing.append(runner)
                runner.init()
            self.figures[plan.name].state = "running"
        self._works(NOBODY)

    def deliver(self, moved: Iterable[ChannelBuffer]) -> None:
        """What became visible in these boxes is there for the next iteration of those who read them."""
        for box in moved:
            arrived, channel = box.take(), box.plan.name
            for name in self._readers[box.plan.index]:
                waiting = self._waiting[name]
                waiting[channel] = waiting[channel] + arrived if channel in waiting else arrived

    def configure(self, settings: Sequence[settings_change_t], channels: Sequence[channels_change_t]) -> None:
        """Takes over changes of settings, each once; those of channels have been taken over by then."""
        for change in settings:
            plan = self._plan.components[change.component]
            if plan.name in self.runners and change.number > self._configured:
                with self._blame.guard(plan.name, "config_changed"):
                    self.runners[plan.name].configure(value_of(change.values))
        newest = [change.number for change in settings] + [change.number for change in channels]
        self._configured = max([self._configured, *newest])

    def news(self, changes: Sequence[channels_change_t]) -> list[Fact]:
        """Returns the decisions about channels that were not taken over yet."""
        return [fact for change in changes if change.number > self._configured for fact in facts_in(change)]

    def take_over(self, fact: Fact) -> bool:
        """Takes over what was decided on the blackboard; whether somebody here reads the fact's channel after that."""
        assert self.instances
        events = self.instances.apply([fact])
        for plan in self.plans:
            if plan.opens:
                runner = self.runners[plan.name]
                done = runner.blackboard.take_over(self.instances, plan.index, fact, events)
                if fact.opening and done == "opened":
                    self._begin_reading(plan.name, fact.opening)
                elif fact.opening and done == "closed":
                    self._readers[fact.opening.channel].remove(plan.name)
                    self._waiting[plan.name].pop(fact.opening.name, None)
        return fact.opening is not None and bool(self._readers.get(fact.opening.channel))

    def _begin_reading(self, own: str, opening: Opening) -> None:
        """If somebody else here reads the channel already, a component begins with what that one has."""
        readers = self._readers.setdefault(opening.channel, [])
        if readers:
            other, name = readers[0], opening.name
            newest = [*filter(None, [self.runners[other].readers[name].raw]), *self._waiting[other].get(name, [])]
            self._waiting[own][name] = newest[-1:]
        readers.append(own)

    def tell_holder(self, component: int) -> None:
        """Says to who cares which component has the main loop."""
        if self._takers:
            name = self._plan.components[component].name if component != NOBODY else ""
            for runner in self._takers:
                runner.main_loop.holder = name

    def run(
        self, names: Sequence[str], stage: str, tick: tick_t, place: int
    ) -> tuple[list[tuple[str, bytes]], int, int]:
        """One iteration of each of these: what they wrote, when the next tick is (or -1), how long it took.

        `place` is the `stage` in the headers of what they write.
        """
        written: list[tuple[str, bytes]] = []
        next_us = -1
        began_us = start_us = self._now_us()
        for name in names:
            runner, waiting = self.runners[name], self._waiting[name]
            if self._progress:
                self._works(self._index[name])
            self._waiting[name] = {}
            try:
                written += runner.iterate(tick.tick, place, stage, tick.time_us, waiting)
            except BaseException as error:
                self._blame.make_room(error)
                self._blame.put(name, f"loop, tick {tick.tick}", error)
                raise
            end_us = self._now_us()
            self.figures[name].ran(end_us - start_us)
            start_us = end_us
            next_us = max(next_us, runner.time_source.said_us)
        if self._progress:
            self._works(NOBODY)
        return written, next_us, start_us - began_us

    def put_requests(self, names: Sequence[str], done: done_t) -> None:
        """Writes what the iterations of these components requested, and the frames that they lost, into a done."""
        for runner in self._wishing:
            if runner.name not in names:  # its stage comes later, as it would alone in its process
                continue
            component, asked = self._index[runner.name], runner.wishes()
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

    def finalize(self) -> tuple[list[tuple[str, bytes]], int]:
        """Finalizes them; returns what they wrote, and the tick that it is stamped with."""
        tick, time_us = max((runner.stamp.tick, runner.stamp.time_us) for runner in self.runners.values())
        written: list[tuple[str, bytes]] = []
        for name, runner in reversed(self.runners.items()):
            self.figures[name].state = "finalizing"
            self._works(self._index[name])
            with self._blame.guard(name, "finalize"):
                written += runner.finalize(tick, time_us)
            self.figures[name].state = "stopped"
        return written, tick

    def out_of_memory(self, error: MemoryError) -> None:
        """Between two iterations memory ran out.

        Raises:
            Failure: always.
        """
        self._blame.put(self.plans[0].name, "its process", error)

    def log_of_now(self) -> Logger | None:
        """That of the component that works now, if there is one."""
        if len(self.plans) == 1:
            name = self.plans[0].name
        else:
            working = self._progress.at(self._assignment.host) if self._progress else NOBODY
            name = self._plan.components[working].name if working != NOBODY else ""
        return self.runners[name].log if name in self.runners else None

    def _works(self, component: int) -> None:
        if self._progress:
            self._progress.works(self._assignment.host, component)

    def _runner(self, plan: ComponentPlan) -> Runner:
        component = getattr(import_module(plan.module), plan.class_name)
        declared = declaration(component)
        surroundings = Surroundings(
            self._plan.seed,
            self._plan.period_us,
            self._send_log,
            self._assignment.rings,
            self._plan.log.lines_per_s,
            self._plan.stages,
            [component.name for component in self._plan.components],
        )
        if before := self._assignment.before.get(plan.name):
            stages = tuple(self._plan.stages[index] for index in plan.stages)
            check_unchanged(plan, stages, before, declared)
        if {port.attribute for port in declared.ports} != set(plan.channels):
            raise DeclarationError(f"{plan.module}: its ports are no longer those of the plan; start the run again")
        changed = self._assignment.start.settings.get(plan.name)
        settings = json.loads(changed) if changed else plan.config
        try:
            config = declared.config.model_validate(settings)
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            wrong = f"'{'.'.join(map(str, first['loc']))}': {first['msg']}"
            raise DeclarationError(f"{plan.module}: the run's settings do not fit its class: {wrong}") from error
        incarnation = self._assignment.start.incarnation
        runner = self._make_runner(declared, plan.name, config, plan.channels, surroundings, incarnation)
        for channel, writer in runner.writers.items():
            writer.sequence = self._assignment.start.sequences.get(channel, 0)
        return runner
