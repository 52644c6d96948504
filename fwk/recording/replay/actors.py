"""A component in a replay: built as in its host process, fed from the recording."""

from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

from fwk.component.declaration import declaration
from fwk.component.images import Ring
from fwk.engine.runner import Runner, Surroundings
from fwk.lcm.messages import decode, sequence_of
from fwk.model.channel_table import Fact, Instances
from fwk.model.plan import ComponentPlan, Plan
from fwk.recording.replay.frames import FrameSource, View
from lcmtypes.core import log_t
from lcmtypes.robot import frame_t

Written = list[tuple[str, bytes]]
Newest = dict[tuple[str, bytes], bytes]
"""The newest message by channel and type, which a channel that is opened again may change."""


class Actor:
    """One life of a component, from its start to its end.

    `settings` are those it was started with, `frames` where those of each camera are.
    """

    def __init__(
        self,
        plan: Plan,
        component: ComponentPlan,
        incarnation: int,
        rings: Mapping[str, Ring],
        settings: Mapping[str, Any],
        frames: Mapping[str, FrameSource],
    ) -> None:
        self.plan = component
        self._views = {channel: View(source) for channel, source in frames.items()}
        self._stages = plan.stages
        declared = declaration(getattr(import_module(component.module), component.class_name))
        config = declared.config.model_validate(settings)
        names = [each.name for each in plan.components]
        surroundings = Surroundings(
            plan.seed, plan.period_us, _silent, rings, stages=plan.stages, components=names, frames=self._views
        )
        self.runner = Runner(declared, component.name, config, component.channels, surroundings, incarnation)
        self._arrived: dict[str, list[bytes]] = {}  # visible, but its process was not told yet
        self._waiting: dict[str, list[bytes]] = {}  # its process has it, its next iteration will
        self._instances = Instances(plan)
        self._facts: list[Fact] = []  # of the blackboard, which it is told with its next iteration
        self._missed: set[tuple[str, int]] = set()  # channel and number of messages that it never saw
        self._changes: list[Mapping[str, Any]] = []  # of settings, which it is told with its next iteration
        self.runner.init()

    def continue_at(self, channel: str, sequence: int) -> None:
        """Where a written channel goes on after a restart."""
        if channel in self.runner.writers:
            self.runner.writers[channel].sequence = sequence

    def configure(self, settings: Mapping[str, Any]) -> None:
        """New settings, which it has from its next iteration on."""
        self._changes.append(settings)

    def see(self, channel: str, data: list[bytes]) -> None:
        """Messages became visible; the next iteration has them."""
        if self._reads(channel):
            self._arrived.setdefault(channel, []).extend(data)

    def _reads(self, channel: str) -> bool:
        return channel in self.runner.readers

    def miss(self, channel: str, sequence: int) -> None:
        """A message that is there in the recording never came to its process."""
        self._missed.add((channel, sequence))

    def begin(self, instances: Instances) -> None:
        """What is open when it is started."""
        self._instances.apply(instances.snapshot())
        self.runner.blackboard.first(self._instances)

    def open(self, fact: Fact) -> None:
        """Something was decided on the blackboard, which it hears of with the next tick that it is told."""
        self._facts.append(fact)

    def take_over(self, newest: Newest) -> None:
        """A tick tells it what was decided; a channel that is new to it begins with its newest message."""
        facts, self._facts = self._facts, []
        for name, data in self._open(facts, newest):
            self._waiting.pop(name, None)
            self._arrived.pop(name, None)
            if data:
                self._arrived[name] = data

    def _open(self, facts: Sequence[Fact], newest: Newest) -> Iterator[tuple[str, list[bytes]]]:
        """What was decided; channels that it reads from now on with what they begin with, or does not any more."""
        for fact in facts:
            events = self._instances.apply([fact])
            done = self.runner.blackboard.take_over(self._instances, self.plan.index, fact, events)
            if done and fact.opening:
                name, kind = fact.opening.name, fact.opening.begins
                yield name, [newest[name, kind]] if done == "opened" and (name, kind) in newest else []

    def miss_frame(self, channel: str, number: int) -> None:
        """In the run this frame was overwritten before it came to read it."""
        self._views[channel].miss(number)

    def hold_newest_frames(self) -> None:
        """It is late: its next iteration looks at the frames of now."""
        for channel, image in self.runner.images.items():
            arrived = self._arrived.get(channel) or self._waiting.get(channel)
            self._hold(channel, decode(frame_t, arrived[-1], channel) if arrived else image.announcement.value)

    def hold_last_frames(self) -> None:
        """It leaves: when it finalizes, it may look at the frames of its last iteration."""
        for channel, image in self.runner.images.items():
            self._hold(channel, image.announcement.value)

    def _hold(self, channel: str, frame: frame_t) -> None:
        if frame.frame:
            self._views[channel].hold(frame.frame, frame.height_px * frame.width_px * frame.channels)

    def tell(self, newest_only: bool) -> None:
        """Its process is told what is visible; a new one, or one that was away for long, wants the newest alone."""
        arrived, self._arrived = self._arrived, {}
        for channel, data in arrived.items():
            self._waiting.setdefault(channel, []).extend(data[-1:] if newest_only else data)

    def iteration(self, tick: int, place: int, stage: int, time_us: int, holder: str) -> Callable[[], Written | None]:
        """What its host does in a stage, when the result is called: takes over settings, iterates if it takes part.

        The iteration has everything that its process was told and had not been before its last one.
        """
        changes, self._changes = self._changes, []
        takes_part = stage in self.plan.stages
        waiting: dict[str, list[bytes]] = {}
        if takes_part:
            waiting, self._waiting = self._waiting, {}

        def run() -> Written | None:
            for settings in changes:
                self.runner.configure(settings)
            self.runner.main_loop.holder = holder
            if not takes_part:
                return None
            written = self.runner.iterate(tick, place, self._stages[stage], time_us, self._seen(waiting))
            self.runner.wishes()  # what came of them is in the recording
            return written

        return run

    def _seen(self, fresh: dict[str, list[bytes]]) -> dict[str, list[bytes]]:
        """Of what its process was told, what it got."""
        if not self._missed:
            return fresh
        return {
            channel: [data for data in arrived if (channel, sequence_of(data)) not in self._missed]
            for channel, arrived in fresh.items()
        }

    def finalize(self, tick: int, time_us: int) -> Written:
        """What it writes when it is stopped."""
        return self.runner.finalize(tick, time_us)


def _silent(line: log_t) -> None:
    """The recorded run has logged it already."""


@dataclass(frozen=True)
class _Told:
    """What a tick told a continuous component."""

    tick: int
    time_us: int
    holder: str
    arrived: dict[str, list[bytes]] = field(default_factory=dict)
    changes: Sequence[Mapping[str, Any]] = ()
    facts: Sequence[Fact] = ()
    newest: Newest = field(default_factory=dict)
    """Of the channels that it begins to read with its next iteration, as of this tick."""


class ContinuousActor(Actor):
    """One life of a continuous component: it iterates on what it was told up to a tick, whenever its done comes."""

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self._told: deque[_Told] = deque()
        self._opening: set[str] = set()  # channels that it begins to read with its next iteration

    def _reads(self, channel: str) -> bool:
        return channel in self._opening or super()._reads(channel)

    def tell_tick(self, tick: int, time_us: int, holder: str, newest: Newest) -> None:
        """A tick says that everything seen so far is visible, and what was decided on the blackboard."""
        arrived, self._arrived = self._arrived, {}
        changes, self._changes = self._changes, []
        facts, self._facts = self._facts, []
        self._opening |= self._begun_by(facts)
        opening = {key: data for key, data in newest.items() if key[0] in self._opening} if self._opening else {}
        self._told.append(_Told(tick, time_us, holder, arrived, changes, facts, opening))

    def _begun_by(self, facts: Sequence[Fact]) -> set[str]:
        """Channels that it reads by these decisions."""
        own = [fact for fact in facts if fact.kind == "read" and fact.component == self.plan.index]
        return {fact.opening.name for fact in own if fact.opening}

    def iterate_on(self, tick: int, number: int) -> Written:
        """Its iteration of that number on the marks of a tick."""
        fresh: dict[str, list[bytes]] = {}
        told = [self._told.popleft()]
        while self._told and told[-1].tick < tick:
            told.append(self._told.popleft())
        newest = told[-1]
        self._told.appendleft(_Told(newest.tick, newest.time_us, newest.holder))
        self._opening = {name for each in self._told for name in self._begun_by(each.facts)}
        for each in told:
            for channel, data in each.arrived.items():
                fresh.setdefault(channel, []).extend(data)
        fresh |= dict(self._open([fact for each in told for fact in each.facts], newest.newest))
        fresh = {channel: data for channel, data in fresh.items() if data and channel in self.runner.readers}
        for settings in (changed for each in told for changed in each.changes):
            self.runner.configure(settings)
        self.runner.main_loop.holder = newest.holder
        if self.runner.is_new(tick):
            fresh = {channel: arrived[-1:] for channel, arrived in fresh.items()}
        written = self.runner.iterate(tick, number, "", newest.time_us, self._seen(fresh))
        self.runner.wishes()
        return written
