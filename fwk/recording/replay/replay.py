"""Replays a recording tick by tick and compares what the components write with what they wrote."""

import json
import traceback
from bdb import BdbQuit
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from typing import Any

from fwk.engine.assignment import Start
from fwk.engine.component_group import Written
from fwk.engine.failures import ComponentFailedError
from fwk.engine.visibility import Visibility
from fwk.lcm.messages import sequence_of
from fwk.model.channel_table import ChannelTable, facts_in
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
from fwk.recording.difference import Difference
from fwk.recording.replay.comparison import OutputComparison
from fwk.recording.replay.frames import FrameSource, RecordedFrames, RingFrames, private_ring
from fwk.recording.replay.guard import Guard, ReachesOutsideError
from fwk.recording.replay.life import Life, Owed, blackboard_at, one_component_a_host
from fwk.recording.replay.recorded_messages import RecordedMessages
from fwk.recording.replay.recording import RecordedTick, Recording, RecordingError
from fwk.recording.replay.selection import choose, first_bytes, reaches_outside, unrepeatable
from lcmtypes.core import channels_change_t, header_t, settings_change_t

Made = list[tuple[Life, Written]]
"""Messages of the incarnations of a host in one step of a tick."""


class Replay:
    """Runs components again on recorded inputs: each in a `Host` that gets the ticks of the recorded run.

    Every component has a host of its own, whatever hosts the run had: the iteration contract makes no difference
    between them.

    Args:
        recording: the recording.
        only: names or patterns of components; none means all components that can be run again. A camera whose frames
            a chosen component reads is replayed with it, unless the recording has the frames.

    Raises:
        RecordingError: no component has such a name, or none of them can be run again. While it runs: the log is
            damaged, or a component fails.
    """

    def __init__(self, recording: Recording, only: Sequence[str] = ()) -> None:
        plan = recording.plan
        self.recording = recording
        self.iterations = 0
        self._comparison = OutputComparison()
        self._messages = RecordedMessages(recording.path, self._comparison.lost)
        self._run_plan = plan
        self._plan = one_component_a_host(plan)
        self._guard = Guard()
        choice = choose(recording, only, self._guard)
        self._chosen = choice.components
        self.left_out = {plan.components[index].name: reason for index, reason in choice.left_out.items()}
        """Components that are not run, with the reason."""
        self._recorded = {channel: RecordedFrames(recording.path, channel) for channel in plan.record.frames}
        self._rings = {channel.name: private_ring(channel.name) for channel in plan.channels if channel.images}
        live = {channel: RingFrames(ring) for channel, ring in self._rings.items()}
        self._frames: dict[str, FrameSource] = {**live, **self._recorded}
        self._host_channels = [
            [channel.name for channel in plan.channels if channel.writer in host.components] for host in plan.hosts
        ]
        self._ledger = Visibility(self._plan)
        self._table = ChannelTable(plan)
        self._names = {channel.index: channel.name for channel in plan.channels}  # with dynamic channels
        self._indices = {channel.name: channel.index for channel in plan.channels}  # of the messages written now
        self._outside = {channel.name for channel in plan.channels if channel.writer == NOBODY}
        self._lives: dict[int, list[Life]] = {}  # by host of the run
        self._leaving: dict[int, list[Life]] = {}  # incarnations that were asked to stop and have not finalized yet
        self._owed: dict[StageDone, list[Owed]] = {}
        self._holder = NOBODY  # component that has the main loop
        self._now = self._time_us = 0  # the running tick and its logical time
        self._stage = self._step = -1  # of the running tick
        self._changes: dict[int, channels_change_t] = {}  # of channels that the tick begins with, by number
        self._settings: dict[int, list[settings_change_t]] = {}  # by component
        self._decided: list[channels_change_t] = []
        self._newest: dict[int, bytes] = {}
        self._revealed: list[tuple[int, list[bytes]]] = []  # messages that the next step of the tick makes visible

    @property
    def compared(self) -> int:
        """Number of messages that were compared."""
        return self._comparison.compared

    @property
    def differences(self) -> list[Difference]:
        """Differences between the replay and the recording."""
        return self._comparison.differences

    @property
    def lost(self) -> dict[str, set[int]]:
        """Sequence numbers by channel that are not in the recording, and that no chosen component wrote again."""
        return self._comparison.lost

    def run(self, to_tick: int | None = None, begins: Callable[[int], None] = lambda _: None) -> None:
        """Replays all ticks, or until `to_tick`; calls `begins(tick)` before each."""
        for tick in self.recording.ticks(to_tick, first_bytes(self.recording, self._chosen)):
            begins(tick.record.tick)
            self._tick(tick)
        for component in self._plan.components:
            if component.name in self._guard.refused and component.index in self._chosen:  # one of its threads did
                self._leave_out(component, self._guard.refused[component.name])

    def _tick(self, tick: RecordedTick) -> None:
        for picture in tick.frames:
            if picture.camera in self._recorded:
                self._recorded[picture.camera].add(picture)
        record = tick.record
        self._begin_tick(record.tick, record.time_us, record.channels)
        self._messages.add(tick, self._names)
        for settings in record.settings:
            self._set(settings, record.tick)
        for event in tick.events:
            self._take_event(event)
        for index, mark in zip(record.channel, record.sequence, strict=True):
            self._ledger.publish(index, mark)  # includes messages that the recording lost

    def _begin_tick(self, tick: int, time_us: int, channels: Sequence[channels_change_t]) -> None:
        self._now, self._time_us, self._stage, self._step = tick, time_us, -1, -1
        self._changes = {change.number: change for change in channels}
        for change in channels:
            self._names |= {fact.channel.index: fact.channel.name for fact in facts_in(change) if fact.channel}

    def _take_event(self, event: TickEvent) -> None:
        """Carries out a decision of the main loop."""
        if isinstance(event, StageBegun):
            self._stage, self._step = event
            self._reveal()
        elif isinstance(event, TickTold):
            self._reveal()
            self._tell()
        elif isinstance(event, OutsideTaken):
            self._take_in()
        elif isinstance(event, ChannelsChanged):
            self._decide(self._changes[event.change])
        elif isinstance(event, StageDone):
            if event not in self._owed:
                self._owe(event)
            self._compare(event.host, event.tick, event.step, self._iterate(event))
        elif isinstance(event, IterationDone):
            self._compare(*event, self._iterate_on(*event))
        elif isinstance(event, FinalDone):
            self._compare(event.host, event.tick, header_t.FINAL, self._finalize(event.host))
        elif isinstance(event, HostLate):
            for life in self._lives.get(event.host, []):
                life.hold_newest_frames(self._newest)
            self._owe(StageDone(event.host, self._now, self._step))
        elif isinstance(event, MainLoopGiven):
            self._holder = event.component
        else:
            self._take_change(event)

    def _take_change(self, event: TickEvent) -> None:
        """Handles an event that changes the participants, or the missing messages."""
        if isinstance(event, HostStarted):
            self._start(event.host, event.incarnation, event.change)
        elif isinstance(event, HostStopped):
            self._leaving[event.host] = self._lives.pop(event.host, [])
            for life in self._leaving[event.host]:
                life.hold_last_frames()
        elif isinstance(event, HostLost):
            self._end(event.host)
        elif isinstance(event, MessageLost):
            for life in self._living(event.host):
                life.host.lose(event.channel, event.sequence)
        elif isinstance(event, FrameLost):
            component = self._run_plan.components[event.component]
            for life in self._living(component.host):
                if life.plan.index == component.index:
                    life.miss_frame(self._run_plan.channels[event.channel].name, event.frame)

    def _set(self, change: settings_change_t, tick: int) -> None:
        """Takes new settings of a component."""
        self._check_repeatable(change.component, value_of(change.values), tick)
        self._settings.setdefault(change.component, []).append(change)
        for life in self._lives.get(self._run_plan.components[change.component].host, []):
            if life.plan.index == change.component:
                life.host.set(change)

    def _decide(self, change: channels_change_t) -> None:
        """Takes decisions about channels."""
        facts = facts_in(change)
        self._decided.append(change)
        self._table.apply(facts)
        self._ledger.opened(self._table)
        for fact in facts:
            if fact.kind == "write" and fact.channel:
                name = fact.channel.name
                self._indices[name] = fact.channel.index
                for channels in self._host_channels:
                    if name in channels:
                        channels.remove(name)
                self._host_channels[self._run_plan.components[fact.component].host].append(name)
        for lives in self._lives.values():
            for life in lives:
                if life.plan.opens:
                    life.host.decide(change, self._newest)

    def _living(self, host: int) -> list[Life]:
        """Returns the lives of a host that run, and those that have not finalized yet."""
        return [*self._lives.get(host, []), *self._leaving.get(host, [])]

    def _check_repeatable(self, component: int, settings: Any, tick: int) -> None:
        plan = self._run_plan.components[component]
        if component in self._chosen and (reason := unrepeatable(plan, settings)):
            raise RecordingError(
                f"{self.recording.path}: {plan.name} cannot be replayed with the settings of tick {tick}: {reason}; "
                f"replay the ticks before it with --to-tick {tick - 1}, or others with --only"
            )

    def _start(self, host: int, incarnation: int, newest_change: int) -> None:
        """Starts the chosen components of a host as they were started after that change."""
        self._end(host)
        self._lives[host] = []
        for index in self._run_plan.hosts[host].components:
            if index in self._chosen:
                self._begin_life(self._plan.components[index], host, incarnation, newest_change)

    def _begin_life(self, component: ComponentPlan, host: int, incarnation: int, newest_change: int) -> None:
        changed = [each for each in self._settings.get(component.index, []) if each.number <= newest_change]
        start = Start(
            incarnation,
            self._ledger.sequences(component.index),
            {component.name: json.dumps(value_of(changed[-1].values))} if changed else {},
            blackboard_at(self._run_plan, self._decided, newest_change) if component.opens else "[]",
            newest_change,
        )
        with self._failing(component, "its start"):
            beside = self._run_plan.hosts[self._run_plan.components[component.index].host].components
            stages = sorted({stage for index in beside for stage in self._run_plan.components[index].stages})
            self._lives[host].append(
                Life(self._plan, component, start, self._rings, self._frames, self._ledger, stages)
            )
        if component.index not in self._chosen:  # it reached outside
            return
        life = self._lives[host][-1]
        for settings in self._settings.get(component.index, []):
            if settings.number > newest_change:
                life.host.set(settings)
        for change in self._decided if component.opens else ():
            if change.number > newest_change:
                life.host.decide(change, self._newest)
        for channel, data in self._newest.items():
            life.see(channel, data)

    def _end(self, host: int) -> None:
        """Ends the lives of a host and drops its unanswered ticks."""
        for life in self._living(host):
            life.host.close()
        self._lives.pop(host, None)
        self._leaving.pop(host, None)
        self._owed = {done: owed for done, owed in self._owed.items() if done.host != host}

    def _owe(self, done: StageDone) -> None:
        """Sends a tick with the present marks to a host.

        Its components run when its done comes: a late host may die during its iteration, or leave without it.
        """
        self._owed[done] = [
            Owed(life, life.host.compose(done.tick, done.step, self._time_us, self._holder), self._stage)
            for life in self._lives.get(done.host, [])
            if life.hears(done.tick, self._stage)
        ]

    def _iterate(self, done: StageDone) -> Made:
        made = []
        for owed in self._owed.pop(done):
            if owed.life.plan.index not in self._chosen:
                continue
            with self._failing(owed.life.plan, f"tick {done.tick}"):
                made.append((owed.life, owed.life.iterate(owed.tick, owed.stage)))
                self.iterations += owed.stage in owed.life.plan.stages
        return made

    def _tell(self) -> None:
        """Gives the continuous components the marks of a tick."""
        for lives in self._lives.values():
            for life in lives:
                if life.plan.rate_hz is not None:
                    life.tell(life.host.compose(self._now, 0, self._time_us, self._holder))

    def _iterate_on(self, host: int, tick: int, number: int) -> Made:
        """Runs an iteration of a continuous component on the marks of a tick, perhaps one of long ago."""
        made = []
        for life in [*(self._lives.get(host) or self._leaving.get(host, []))]:
            with self._failing(life.plan, f"iteration {number} on tick {tick}"):
                made.append((life, life.iterate_on(tick)))
                self.iterations += 1
        return made

    def _finalize(self, host: int) -> Made:
        made = []
        for life in reversed(self._leaving.pop(host, [])):
            with self._failing(life.plan, "finalize"):
                made.append((life, life.finalize()))
        return made

    @contextmanager
    def _failing(self, component: ComponentPlan, moment: str) -> Iterator[None]:
        """Reports a failure of a component; leaves a component out that reaches outside.

        Raises:
            RecordingError: the component failed, unless its exception left the debugger.
        """
        watching = nullcontext() if reaches_outside(component) is False else self._guard.watching(component.name)
        try:
            with watching:
                yield
        except (BdbQuit, RecordingError):
            raise
        except ReachesOutsideError as error:
            self._leave_out(component, str(error))
        except Exception as error:
            if isinstance(error.__cause__, ReachesOutsideError):
                self._leave_out(component, str(error.__cause__))
                return
            cause = error.__cause__ if isinstance(error, ComponentFailedError) and error.__cause__ else error
            if isinstance(cause, RecordingError):  # a frame is not in the recording
                raise cause from error
            trace = "".join(traceback.format_exception(cause)).rstrip()
            raise RecordingError(f"{self._failure(component, moment)}\n{trace}") from cause

    def _failure(self, component: ComponentPlan, moment: str) -> str:
        """Returns the message that a component failed."""
        return (
            f"{self.recording.path}: {component.name} fails in {moment}, unlike in the run: the recording is "
            "damaged, or the component was changed or depends on something else"
        )

    def _leave_out(self, component: ComponentPlan, reason: str) -> None:
        """Ends a component that a replay must not run; its recorded messages replace it."""
        said = f"{reason}, which would reach the real world; declare 'reaches_outside' in its class"
        self.left_out[component.name] = said
        self._chosen.discard(component.index)
        for lives in (*self._lives.values(), *self._leaving.values()):
            for life in [life for life in lives if life.plan.index == component.index]:
                life.host.close()
                lives.remove(life)

    def _compare(self, host: int, tick: int, step: int, made: Made) -> None:
        """Compares what a host's done published, and makes it visible from the next step on."""
        recorded: dict[str, list[bytes]] = {}
        for channel in self._host_channels[host]:
            data = self._messages.take(channel, tick, step)
            data = self._comparison.with_lost(channel, data, [written for _, written in made])
            if data:
                recorded[channel] = data
                self._publish(channel, data)
        for life, written in made:
            for channel in life.writes:
                ours = [data for name, data in written if name == channel]
                self._comparison.compare(channel, recorded.get(channel, []), ours)

    def _publish(self, channel: str, data: list[bytes]) -> None:
        index = self._indices[channel]
        self._ledger.publish(index, sequence_of(data[-1]))
        self._revealed.append((index, data))

    def _take_in(self) -> None:
        """Makes messages from outside visible, from the beginning of their tick on."""
        for channel, data in self._messages.take_all(self._outside):
            self._publish(channel, data)

    def _reveal(self) -> None:
        """Begins a step of the tick: everything published so far is visible from here on."""
        self._ledger.begin()
        for channel, data in self._revealed:
            self._newest[channel] = data[-1]
            for lives in self._lives.values():
                for life in lives:
                    for each in data:
                        life.see(channel, each)
        self._revealed = []
