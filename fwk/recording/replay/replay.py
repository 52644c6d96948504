"""Replays a recording tick by tick and compares what the components write with what they wrote."""

import traceback
from bdb import BdbQuit
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from fwk.component.images import Ring
from fwk.engine.runner import is_new
from fwk.lcm.envelope import fingerprint
from fwk.lcm.messages import MessageError, sequence_of, type_named
from fwk.model.channel_table import Fact, Instances, facts_in
from fwk.model.plain_values import value_of
from fwk.model.plan import NOBODY, ComponentPlan
from fwk.model.tick_events import (
    ChannelsChanged,
    FinalDone,
    FrameLost,
    HostLate,
    HostLost,
    HostStarted,
    HostStopped,
    IterationDone,
    MainLoopGiven,
    MessageLost,
    OutsideTaken,
    StageBegun,
    StageDone,
    TickEvent,
    TickTold,
)
from fwk.recording.difference import Difference, changed, missing
from fwk.recording.replay.actors import Actor, ContinuousActor, Newest, Written
from fwk.recording.replay.frames import FrameSource, RecordedFrames, RingFrames
from fwk.recording.replay.recording import RecordedTick, Recording, RecordingError
from fwk.recording.replay.selection import choose, unrepeatable
from lcmtypes.core import header_t, settings_change_t

Made = list[tuple[Actor, Written]]
Iteration = Callable[[], Written | None]
MESSAGES_MAX = 1_000_000
"""Of a channel in one tick; a record that names more is damaged."""


class Replay:
    """Real components on recorded inputs.

    `only` are names or patterns; nothing means all components that can be run again. A camera whose frames a chosen
    component reads is replayed with it, unless the frames are in the recording.

    Raises:
        RecordingError: no component has such a name, or none that can be run again. While it runs: the log is damaged,
            or a component fails.
    """

    def __init__(self, recording: Recording, only: Sequence[str] = ()) -> None:
        plan = recording.plan
        self.recording = recording
        self.iterations = 0
        self.compared = 0
        self.differences: list[Difference] = []
        self.lost: dict[str, set[int]] = {}
        """Sequence numbers by channel that are not in the recording, and that no chosen component wrote again."""
        self._plan = plan
        choice = choose(recording, only)
        self._chosen = choice.components
        self.left_out = {plan.components[index].name: reason for index, reason in choice.left_out.items()}
        """Components that are not run, with the reason."""
        self._recorded = {channel: RecordedFrames(recording.path, channel) for channel in plan.record.frames}
        self._rings = {channel.name: Ring.create(channel.name) for channel in plan.channels if channel.images}
        live = {channel: RingFrames(ring) for channel, ring in self._rings.items()}
        self._frames: dict[str, FrameSource] = {**live, **self._recorded}
        self._host_channels = [
            [channel.name for channel in plan.channels if channel.writer in host.components] for host in plan.hosts
        ]
        self._instances = Instances(plan)
        self._names = {channel.index: channel.name for channel in plan.channels}  # and of channels opened at run time
        self._outside = {channel.name for channel in plan.channels if channel.writer == NOBODY}
        self._actors: dict[int, list[Actor]] = {}
        self._holder = ""  # component that has the main loop
        self._leaving: dict[int, list[Actor]] = {}  # were asked to stop and have not finalized yet
        self._time_us: dict[int, int] = {}  # host to the time of its newest iteration
        self._answered: dict[int, int] = {}  # host to the newest tick that its process has answered
        self._changes: dict[int, list[tuple[int, Any]]] = {}  # component to the numbers and values of its new settings
        self._newest: Newest = {}
        self._marks: dict[int, int] = {}
        self._sequences: dict[str, int] = {}
        self._hidden: dict[tuple[str, int, int], list[bytes]] = {}  # written, not visible yet
        self._revealed: list[tuple[str, list[bytes]]] = []  # visible from the next stage on
        self._owed: dict[tuple[int, int, int], tuple[int, list[tuple[Actor, Iteration]]]] = {}
        """By host, tick and place: what has not been answered yet, and its time."""

    def run(self, to_tick: int | None = None, begins: Callable[[int], None] = lambda _: None) -> None:
        """Replays all ticks, or until `to_tick`; calls `begins(tick)` before each."""
        for tick in self.recording.ticks(to_tick, self._types()):
            begins(tick.record.tick)
            self._tick(tick)

    def _types(self) -> dict[str, bytes]:
        """What the messages begin with that the chosen components read and write."""
        concerned = [
            channel
            for channel in self._plan.channels
            if not self._chosen.isdisjoint((channel.writer, *channel.readers))
        ]
        try:
            return {channel.name: fingerprint(type_named(channel.type_name)) for channel in concerned}
        except MessageError as error:
            raise RecordingError(
                f"{self.recording.path}: {error}; the run directory keeps the types of the run"
            ) from error

    def _tick(self, tick: RecordedTick) -> None:
        self._hidden.update(tick.messages)
        for picture in tick.frames:
            if picture.camera in self._recorded:
                self._recorded[picture.camera].add(picture)
        record, stage, place = tick.record, -1, -1
        decided = {each.number: facts_in(each) for each in record.channels}
        for facts in decided.values():
            self._names |= {fact.opening.channel: fact.opening.name for fact in facts if fact.opening}
        self._lose(tick)
        for change in record.settings:
            self._change(change, record.tick)
        for event in tick.events:
            if isinstance(event, StageBegun):
                stage, place = event
                self._show()
            elif isinstance(event, StageDone):
                self._on_stage_done(event, stage, record.time_us)
            elif isinstance(event, IterationDone):
                self._done(event.host, event.tick, event.iteration, self._iterate_on(*event))
            elif isinstance(event, FinalDone):
                self._done(event.host, event.tick, header_t.FINAL, self._finalize(*event))
            elif isinstance(event, HostLate):
                for actor in self._actors.get(event.host, []):
                    actor.hold_newest_frames()
                self._begin(event.host, record.tick, place, stage, record.time_us)
            elif isinstance(event, TickTold):
                self._show()
                for actor in self._continuous():
                    actor.tell_tick(record.tick, record.time_us, self._holder, self._newest)
            elif isinstance(event, OutsideTaken):
                self._come_in()
            elif isinstance(event, ChannelsChanged):
                self._open(decided[event.change])
            elif isinstance(event, MainLoopGiven):
                self._holder = self._plan.components[event.component].name if event.component != NOBODY else ""
            else:
                self._on_host_event(event)

    def _on_stage_done(self, event: StageDone, stage: int, time_us: int) -> None:
        host, tick, step = event
        if (host, tick, step) not in self._owed:
            self._begin(host, tick, step, stage, time_us)
        self._done(host, tick, step, self._run(host, tick, step))

    def _on_host_event(self, event: TickEvent) -> None:
        if isinstance(event, HostStarted):
            self._start(event.host, event.incarnation, event.change)
        elif isinstance(event, HostStopped):
            self._leaving[event.host] = self._actors.pop(event.host, [])
            for actor in self._leaving[event.host]:
                actor.hold_last_frames()
        elif isinstance(event, HostLost):
            self._end(event.host)
        elif isinstance(event, MessageLost):
            for actor in self._living(event.host):
                actor.miss(self._names[event.channel], event.sequence)
        elif isinstance(event, FrameLost):
            component, channel = self._plan.components[event.component], self._plan.channels[event.channel]
            self._miss_frame(component, channel.name, event.frame)

    def _lose(self, tick: RecordedTick) -> None:
        """Finds out which messages became visible and are not there: the gateway never got them."""
        here: dict[str, list[int]] = {}
        for (channel, _, _), data in tick.messages.items():
            here.setdefault(channel, []).extend(map(sequence_of, data))
        for index, mark in zip(tick.record.channel, tick.record.sequence, strict=True):
            channel = self._names[index]
            before, self._marks[index] = self._marks.get(index, 0), mark
            if mark - before > MESSAGES_MAX:
                raise RecordingError(
                    f"{self.recording.path}: damaged: {channel} cannot have {mark - before} messages in tick "
                    f"{tick.record.tick}; replay what is before it with --to-tick {tick.record.tick - 1}"
                )
            if len(here.get(channel, ())) < mark - before:
                self.lost.setdefault(channel, set()).update({*range(before + 1, mark + 1)} - {*here.get(channel, ())})

    def _change(self, change: settings_change_t, tick: int) -> None:
        settings = value_of(change.values)
        self._check(change.component, settings, tick)
        self._changes.setdefault(change.component, []).append((change.number, settings))
        for actor in self._actors.get(self._plan.components[change.component].host, []):
            if actor.plan.index == change.component:
                actor.configure(settings)

    def _open(self, facts: Sequence[Fact]) -> None:
        """What components asked of the blackboard was decided."""
        for fact in facts:
            self._instances.apply([fact])
            if fact.kind == "write" and fact.opening:
                for channels in self._host_channels:
                    if fact.opening.name in channels:
                        channels.remove(fact.opening.name)
                self._host_channels[self._plan.components[fact.component].host].append(fact.opening.name)
            for actors in self._actors.values():
                for actor in actors:
                    if actor.plan.opens:
                        actor.open(fact)

    def _living(self, host: int) -> list[Actor]:
        """Those of a host that run, and those that have not finalized yet."""
        return [*self._actors.get(host, []), *self._leaving.get(host, [])]

    def _miss_frame(self, component: ComponentPlan, channel: str, number: int) -> None:
        for actor in self._living(component.host):
            if actor.plan.index == component.index:
                actor.miss_frame(channel, number)

    def _check(self, component: int, settings: Any, tick: int) -> None:
        """Whether a component can still be run again with its new settings."""
        plan = self._plan.components[component]
        if component in self._chosen and (reason := unrepeatable(plan, settings)):
            raise RecordingError(
                f"{self.recording.path}: {plan.name} cannot be replayed with the settings of tick {tick}: {reason}; "
                f"replay what is before it with --to-tick {tick - 1}, or others with --only"
            )

    def _start(self, host: int, incarnation: int, started_with: int) -> None:
        """Starts a host's components with the settings after that change, then takes over what was changed since."""
        self._end(host)
        self._actors[host] = []
        for index in self._plan.hosts[host].components:
            if index not in self._chosen:
                continue
            component, changes = self._plan.components[index], self._changes.get(index, [])
            before = [settings for number, settings in changes if number <= started_with]
            with self._failing(component, "its start"):
                kind = Actor if component.rate_hz is None else ContinuousActor
                settings = [component.config, *before][-1]
                actor = kind(self._plan, component, incarnation, self._rings, settings, self._frames)
            for _, settings in changes[len(before) :]:
                actor.configure(settings)
            if component.opens:
                actor.begin(self._instances)
            for (channel, _), data in self._newest.items():
                actor.see(channel, [data])
            for channel, sequence in self._sequences.items():
                actor.continue_at(channel, sequence)
            self._actors[host].append(actor)

    def _end(self, host: int) -> None:
        """What it was late with it takes along."""
        self._actors.pop(host, None)
        self._leaving.pop(host, None)
        self._time_us.pop(host, None)
        self._answered.pop(host, None)
        self._owed = {key: owed for key, owed in self._owed.items() if key[0] != host}

    def _begin(self, host: int, tick: int, place: int, stage: int, time_us: int) -> None:
        """Freezes what a host sees in a stage. Its iterations run when its done comes: one that was late may have died
        over it, or have left without ever having run it.
        """
        owed: list[tuple[Actor, Iteration]] = []
        newest_only = is_new(tick, self._answered.get(host, 0))
        for actor in self._actors.get(host, []):
            actor.take_over(self._newest)
            actor.tell(newest_only)
            iteration = actor.iteration(tick, place, stage, time_us, self._holder)
            owed.append((actor, iteration))
        self._owed[host, tick, place] = time_us, owed

    def _run(self, host: int, tick: int, place: int) -> Made:
        made = []
        self._time_us[host], owed = self._owed.pop((host, tick, place))
        self._answered[host] = tick
        for actor, iteration in owed:
            with self._failing(actor.plan, f"tick {tick}"):
                written = iteration()
            if written is not None:
                made.append((actor, written))
                self.iterations += 1
        return made

    def _finalize(self, host: int, tick: int) -> Made:
        made = []
        for actor in reversed(self._leaving.pop(host, [])):
            with self._failing(actor.plan, "finalize"):
                made.append((actor, actor.finalize(tick, self._time_us.get(host, 0))))
        return made

    def _continuous(self) -> list[ContinuousActor]:
        return [actor for actors in self._actors.values() for actor in actors if isinstance(actor, ContinuousActor)]

    def _iterate_on(self, host: int, tick: int, number: int) -> Made:
        """A continuous component has run on the marks of a tick, perhaps long ago."""
        made: Made = []
        for actor in self._actors.get(host) or self._leaving.get(host, []):
            if isinstance(actor, ContinuousActor):
                with self._failing(actor.plan, f"iteration {number} on tick {tick}"):
                    made.append((actor, actor.iterate_on(tick, number)))
                self._time_us[host] = actor.runner.stamp.time_us
                self.iterations += 1
        return made

    @contextmanager
    def _failing(self, component: ComponentPlan, moment: str) -> Iterator[None]:
        try:
            yield
        except (BdbQuit, RecordingError):  # somebody left the debugger; a frame is not in the recording
            raise
        except Exception as error:
            trace = "".join(traceback.format_exception(error)).rstrip()
            raise RecordingError(
                f"{self.recording.path}: {component.name} fails in {moment} as it did not in the run: the recording is "
                f"damaged, or the component was changed or depends on something else\n{trace}"
            ) from error

    def _done(self, host: int, tick: int, place: int, made: Made) -> None:
        recorded: dict[str, list[bytes]] = {}
        for channel in self._host_channels[host]:
            data = self._hidden.pop((channel, tick, place), [])
            if channel in self.lost:
                data = self._with_lost(channel, data, made)
            if data:
                recorded[channel] = data
                self._sequences[channel] = sequence_of(data[-1])  # a successor counts on from here
                self._revealed.append((channel, data))
        for actor, written in made:
            for channel in actor.runner.writers:
                ours = [data for name, data in written if name == channel]
                self._compare(channel, recorded.get(channel, []), ours)

    def _with_lost(self, channel: str, recorded: list[bytes], made: Made) -> list[bytes]:
        """A message that is not in the recording is there again if its writer is replayed."""
        lost = self.lost[channel]
        again = [data for _, written in made for name, data in written if name == channel and sequence_of(data) in lost]
        lost.difference_update(map(sequence_of, again))
        self.compared -= len(again)
        return sorted([*recorded, *again], key=sequence_of)

    def _come_in(self) -> None:
        """What came from outside is visible from the beginning of its tick on."""
        for key in [key for key in self._hidden if key[0] in self._outside]:
            self._revealed.append((key[0], self._hidden.pop(key)))

    def _compare(self, channel: str, recorded: list[bytes], ours: list[bytes]) -> None:
        for place in range(max(len(recorded), len(ours))):
            self.compared += 1
            if place >= len(ours):
                self._differ(missing(channel, recorded[place], place + 1, 1))
            elif place >= len(recorded):
                self._differ(missing(channel, ours[place], place + 1, 0))
            elif recorded[place] != ours[place]:
                self._differ(changed(channel, recorded[place], ours[place], place + 1))

    def _differ(self, difference: Difference) -> None:
        self.differences.append(difference)

    def _show(self) -> None:
        for channel, data in self._revealed:
            self._newest[channel, data[-1][:8]] = data[-1]
            for actors in self._actors.values():
                for actor in actors:
                    actor.see(channel, data)
        self._revealed = []
