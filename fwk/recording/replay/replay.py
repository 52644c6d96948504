"""Replays a recording tick by tick and compares what the components write with what they wrote."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any

from fwk.engine.component_group import Written
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
from fwk.recording.replay.guard import Guard
from fwk.recording.replay.life import Life, Owed
from fwk.recording.replay.lives import Lives, opened_in
from fwk.recording.replay.recorded_messages import RecordedMessages
from fwk.recording.replay.recording import RecordedTick, Recording, RecordingError
from fwk.recording.replay.selection import choose, first_bytes, unrepeatable
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
        from_tick: messages are compared from this tick on.

    Raises:
        RecordingError: no component has such a name, or none of them can be run again. While it runs: the log is
            damaged, or a component fails.
    """

    def __init__(self, recording: Recording, only: Sequence[str] = (), from_tick: int = 0) -> None:
        plan = recording.plan
        self.recording = recording
        self.iterations = 0
        self._comparison = OutputComparison(from_tick)
        self._messages = RecordedMessages(recording.path, self._comparison.lost)
        self._run_plan = plan
        self._guard = Guard()
        choice = choose(recording, only, self._guard)
        self._lives = Lives(recording, choice, self._guard, self._failure)
        self._ledger = self._lives.ledger
        self._host_channels = [
            [channel.name for channel in plan.channels if channel.writer in host.components] for host in plan.hosts
        ]
        self._table = ChannelTable(plan)
        self._names = {channel.index: channel.name for channel in plan.channels}  # with dynamic channels
        self._indices = {channel.name: channel.index for channel in plan.channels}  # of the messages written now
        self._outside = {channel.name for channel in plan.channels if channel.writer == NOBODY}
        self._owed: dict[StageDone, list[Owed]] = {}
        self._incarnations: dict[int, int] = {}  # of each host, the newest
        self._holder = NOBODY  # component that has the main loop
        self._now = self._time_us = 0  # the running tick and its logical time
        self._stage = self._step = -1  # of the running tick
        self._changes: dict[int, channels_change_t] = {}  # of channels that the tick begins with, by number
        self._revealed: list[tuple[int, list[bytes]]] = []  # messages that the next step of the tick makes visible
        self._ticks: Iterator[RecordedTick] = iter(())  # that have not been replayed

    @property
    def left_out(self) -> dict[str, str]:
        """Components that are not run, with the reason."""
        return self._lives.left_out

    @property
    def newest_tick(self) -> int:
        """The newest tick that was replayed; 0: none."""
        return self._now

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
        self._ticks = self.recording.ticks(first_bytes(self.recording, self._lives.chosen))
        for tick in self._ticks:
            begins(tick.record.tick)
            self._tick(tick)
            if to_tick is not None and tick.record.tick >= to_tick:
                break
        for component in self._run_plan.components:
            if component.name in self._guard.refused and component.index in self._lives.chosen:  # one of its threads
                self._lives.leave_out(component, self._guard.refused[component.name])

    def _tick(self, tick: RecordedTick) -> None:
        for picture in tick.frames:
            if picture.camera in self._lives.recorded:
                self._lives.recorded[picture.camera].add(picture)
        record = tick.record
        self._begin_tick(record.tick, record.time_us, record.channels)
        self._messages.add(tick, self._names)
        self._take_changes(tick)
        for index, mark in zip(record.channel, record.sequence, strict=True):
            self._ledger.publish(index, mark)  # includes messages that the recording lost

    def _take_changes(self, tick: RecordedTick) -> None:
        """Takes the settings and the events of a recorded tick."""
        for settings in tick.record.settings:
            self._set(settings, tick.record.tick)
        self._take_events(tick.events)

    def _take_events(self, events: Sequence[TickEvent]) -> None:
        """Takes the events of a recorded tick, in their order."""
        for event in events:
            self._take_event(event)

    def _begin_tick(self, tick: int, time_us: int, channels: Sequence[channels_change_t]) -> None:
        self._now, self._time_us, self._stage, self._step = tick, time_us, -1, -1
        self._changes = {}
        self._open(channels)

    def _open(self, channels: Sequence[channels_change_t]) -> None:
        """Takes changes of channels that events of the tick name by number."""
        for change in channels:
            self._changes[change.number] = change
            self._names |= opened_in(change)

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
            for life in self._lives.of(event.host):
                life.hold_newest_frames(self._lives.newest)
            self._owe(StageDone(event.host, self._now, self._step))
        elif isinstance(event, MainLoopGiven):
            self._holder = event.component
        else:
            self._take_change(event)

    def _take_change(self, event: TickEvent) -> None:
        """Handles an event that changes the participants, or the missing messages."""
        if isinstance(event, HostStarted):
            self._forget(event.host)
            self._incarnations[event.host] = event.incarnation
            self._lives.start(event.host, event.incarnation, event.change)
        elif isinstance(event, HostStopped):
            self._lives.stop(event.host)
        elif isinstance(event, HostLost):
            self._forget(event.host)
            self._lives.end(event.host)
        elif isinstance(event, MessageLost):
            for life in self._lives.living(event.host):
                life.host.lose(event.channel, event.sequence)
        elif isinstance(event, FrameLost):
            component = self._run_plan.components[event.component]
            for life in self._lives.living(component.host):
                if life.plan.index == component.index:
                    life.miss_frame(self._run_plan.channels[event.channel].name, event.frame)

    def _set(self, change: settings_change_t, tick: int) -> None:
        """Takes new settings of a component."""
        self._check_repeatable(change.component, value_of(change.values), tick)
        self._lives.set(change)

    def _decide(self, change: channels_change_t) -> None:
        """Takes decisions about channels."""
        facts = facts_in(change)
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
        self._lives.decide(change)

    def _check_repeatable(self, component: int, settings: Any, tick: int) -> None:
        plan = self._run_plan.components[component]
        if component in self._lives.chosen and (reason := unrepeatable(plan, settings)):
            raise RecordingError(
                f"{self.recording.path}: {plan.name} cannot be replayed with the settings of tick {tick}: {reason}; "
                f"replay the ticks before it with --to-tick {tick - 1}, or others with --only"
            )

    def _forget(self, host: int) -> None:
        """Drops the unanswered ticks of a host."""
        self._owed = {done: owed for done, owed in self._owed.items() if done.host != host}

    def _owe(self, done: StageDone) -> None:
        """Sends a tick with the present marks to a host.

        Its components run when its done comes: a late host may die during its iteration, or leave without it.
        """
        self._owed[done] = [
            Owed(life, life.host.compose(done.tick, done.step, self._time_us, self._holder), self._stage)
            for life in self._lives.of(done.host)
            if life.hears(done.tick, self._stage)
        ]

    def _iterate(self, done: StageDone) -> Made:
        made = []
        for owed in self._owed.pop(done):
            if owed.life.plan.index not in self._lives.chosen:
                continue
            with self._lives.failing(owed.life.plan, f"tick {done.tick}"):
                made.append((owed.life, owed.life.iterate(owed.tick, owed.stage)))
                self.iterations += owed.stage in owed.life.plan.stages and owed.life.plan.due(done.tick)
        return made

    def _tell(self) -> None:
        """Gives the continuous components the marks of a tick."""
        for life in self._lives.all_running():
            if life.plan.rate_hz is not None:
                life.tell(life.host.compose(self._now, 0, self._time_us, self._holder))

    def _iterate_on(self, host: int, tick: int, number: int) -> Made:
        """Runs an iteration of a continuous component on the marks of a tick, perhaps one of long ago."""
        made = []
        for life in [*(self._lives.of(host) or self._lives.living(host))]:
            with self._lives.failing(life.plan, f"iteration {number} on tick {tick}"):
                made.append((life, life.iterate_on(tick)))
                self.iterations += 1
        return made

    def _finalize(self, host: int) -> Made:
        self._forget(host)
        made = []
        for life in reversed(self._lives.leaving.pop(host, [])):
            with self._lives.failing(life.plan, "finalize"):
                made.append((life, life.finalize()))
        return made

    def _failure(self, component: ComponentPlan, moment: str) -> str:
        """Returns the message that a component failed."""
        return (
            f"{self.recording.path}: {component.name} fails in {moment}, unlike in the run: the recording is "
            "damaged, or the component was changed or depends on something else"
        )

    def _compare(self, host: int, tick: int, step: int, made: Made) -> None:
        """Compares what a host's done published, and makes it visible from the next step on."""
        recorded: dict[str, list[bytes]] = {}
        for channel in self._host_channels[host]:
            if step == header_t.FINAL:
                data = self._messages.take_final(channel, self._incarnations.get(host, 1))
            else:
                data = self._messages.take(channel, tick, step)
            data = self._comparison.with_lost(channel, tick, data, [written for _, written in made])
            if data:
                recorded[channel] = data
                self._publish(channel, data)
        for life, written in made:
            for channel in life.writes:
                ours = [data for name, data in written if name == channel]
                self._comparison.compare(channel, tick, recorded.get(channel, []), ours)

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
            self._lives.see(channel, data)
        self._revealed = []
