"""A replay that goes on live: the components read each other's outputs, and the main loop decides itself."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from fwk.clock import US_PER_S
from fwk.gateway.connections import Sink
from fwk.lcm.messages import sequence_of
from fwk.model.plan import ComponentPlan
from fwk.model.tick_events import (
    ChannelsChanged,
    FinalDone,
    HostLost,
    HostStarted,
    HostStopped,
    IterationDone,
    MainLoopGiven,
    OutsideTaken,
    StageBegun,
    StageDone,
    TickEvent,
    TickTold,
    events_message,
)
from fwk.recording.replay.decisions import Decisions
from fwk.recording.replay.recording import RecordedTick, Recording
from fwk.recording.replay.replay import Made, Replay
from fwk.recording.versions import RECORD
from lcmtypes.core import protocol_t, settings_change_t, tick_record_t, value_t

STAGES = StageBegun, TickTold
"""Events with which the stages of a tick begin."""


class LiveReplay(Replay):
    """A replay whose components can go on with their own outputs, in lockstep and with a recording of its own.

    What the outside did in the run, it does here: messages from outside, settings, starts and stops of hosts.

    Args:
        recording: the recording.
        changed: components with another class: what they write before it goes live is not compared.

    Raises:
        RecordingError: as of `Replay`.
    """

    def __init__(self, recording: Recording, changed: Mapping[str, str] | None = None) -> None:
        super().__init__(recording)
        self.absent: dict[str, str] = {}
        """Components and channels that are silent after the branch, each with the reason."""
        self.decisions = Decisions(recording.plan, self._ledger, self._is_busy)
        self._changed = changed or {}
        self._set_components: set[int] = set()  # with settings of the branch
        self._live = False
        self._log: Sink | None = None
        self._marks: dict[int, int] = {}  # moved in the running tick
        self._iterations: dict[int, tuple[int, int]] = {}  # by continuous component: newest number and its time
        self._later: list[TickEvent] = []  # recorded events of hosts within a tick, for the next boundary

    def _is_busy(self, host: int) -> bool:
        """Returns whether a host is late or has not finalized yet."""
        return host in self._lives.leaving or any(done.host == host for done in self._owed)

    def _decide_tick(self, settings: Sequence[tuple[int, list[value_t]]], recorded: RecordedTick | None) -> None:
        """Runs a tick with decisions of its own, and records it."""
        self._begin_tick(self._now + 1, self.decisions.advance(self._time_us), ())
        record = tick_record_t()
        record.version, record.tick, record.time_us = protocol_t.VERSION, self._now, self._time_us
        asked = [*settings, *self._recorded_settings(recorded)]
        record.settings = [self._settings_change(component, values) for component, values in asked]
        for made in record.settings:
            self._set(made, self._now)
        events = self._taken(self._boundary(recorded))
        events += self._taken(self._stages())
        record.channels, record.events = list(self._changes.values()), events_message(events)
        record.n_settings, record.n_channels = len(record.settings), len(record.channels)
        self._write(record)

    def _taken(self, events: Iterable[TickEvent]) -> list[TickEvent]:
        """Carries out events; returns them."""
        made = []
        for event in events:
            made.append(event)
            self._take_event(event)
        return made

    def _recorded_settings(self, recorded: RecordedTick | None) -> Iterator[tuple[int, list[value_t]]]:
        """Yields the settings that the outside gave components in the run, but not to those with `--set`."""
        for change in recorded.record.settings if recorded else ():
            if change.component in self._set_components:
                name = self._run_plan.components[change.component].name
                self.absent[f"settings of {name}"] = "those of the run after the tick; it has other ones here"
            else:
                yield change.component, change.values

    def _boundary(self, recorded: RecordedTick | None) -> Iterator[TickEvent]:
        """Yields the decisions before the first stage; at first those about what was late at the branch."""
        here, self._later = [*self._later, *_of_hosts(recorded, True)], [*_of_hosts(recorded, False)]
        turnover = self.decisions.participants.decide(here)
        yield from list(self._owed)
        yield from map(HostStopped, turnover.stopped)
        leaving = list(self._lives.leaving)
        yield from [FinalDone(host, self._now - 1) for host in leaving]
        yield from map(HostLost, dict.fromkeys([*leaving, *turnover.lost]))
        schedule = self.decisions.schedule
        if schedule.asked and schedule.decide():
            yield MainLoopGiven(schedule.holder)
        if change := self.decisions.decide_channels():
            self._open([change])
            yield ChannelsChanged(change.number)
        for host, incarnation in turnover.coming:
            yield HostStarted(host, incarnation, self.decisions.newest_change)
        if self._messages.has_any(self._outside):
            yield OutsideTaken()

    def _stages(self) -> Iterator[TickEvent]:
        """Yields the stages of a tick with the dones of their hosts, and the iterations of continuous components."""
        continuous = [life for life in self._lives.all_running() if life.plan.rate_hz is not None]
        if continuous:
            yield TickTold()
        for step, stage in self.decisions.schedule.steps:
            yield StageBegun(stage, step)
            for host, lives in sorted(self._lives.running.items()):
                if any(stage in life.plan.stages for life in lives):
                    yield StageDone(host, self._now, step)
        for life in continuous:
            number, time_us = self._iterations.get(life.plan.index, (0, -US_PER_S))
            if self._time_us >= time_us + US_PER_S / (life.plan.rate_hz or US_PER_S):
                yield IterationDone(self._run_plan.components[life.plan.index].host, self._now, number + 1)

    def _write(self, record: tick_record_t) -> None:
        """Records the end of a tick."""
        assert self._log
        record.channel, record.sequence = list(self._marks), list(self._marks.values())
        record.n_marks, self._marks = len(record.channel), {}
        self._log.message(RECORD, record.encode(), self._time_us)
        self._log.tick()

    def _settings_change(self, component: int, values: list[value_t]) -> settings_change_t:
        made = settings_change_t()
        self.decisions.newest_change += 1
        made.number, made.component, made.values = self.decisions.newest_change, component, values
        return made

    def _take_event(self, event: TickEvent) -> None:
        if isinstance(event, HostStarted):
            self.decisions.came(event.host, event.incarnation)
            for index in self._run_plan.hosts[event.host].components:
                if index in self._lives.chosen:
                    self.absent.pop(self._run_plan.components[index].name, None)
        elif isinstance(event, HostLost | HostStopped):
            self.decisions.left(event.host)
            if isinstance(event, HostStopped):
                self.decisions.crosses()
        elif isinstance(event, IterationDone):
            for index in self._run_plan.hosts[event.host].components:
                self._iterations[index] = event.iteration, self._time_us
        super()._take_event(event)
        if isinstance(event, (HostStarted, ChannelsChanged, *STAGES)):
            self.decisions.crossed()

    def _set(self, change: settings_change_t, tick: int) -> None:
        self.decisions.newest_change = max(change.number, self.decisions.newest_change)
        super()._set(change, tick)

    def _compare(self, host: int, tick: int, step: int, made: Made) -> None:
        """Compares what a host's done published up to the branch; afterwards publishes and records it."""
        for life, _ in made:
            if life.done:
                self.decisions.heed(life.done)
        if not self._live:
            super()._compare(host, tick, step, [each for each in made if each[0].plan.name not in self._changed])
            return
        for _, written in made:
            by_channel: dict[str, list[bytes]] = {}
            for channel, data in written:
                by_channel.setdefault(channel, []).append(data)
            for channel, messages in by_channel.items():
                self._record(channel, messages)

    def _take_in(self) -> None:
        """Makes messages from outside visible; after the branch it also records them."""
        if not self._live:
            super()._take_in()
            return
        for channel, messages in self._messages.take_all(self._outside):
            self._record(channel, messages)

    def _record(self, channel: str, messages: list[bytes]) -> None:
        """Publishes messages and records them."""
        assert self._log
        for data in messages:
            self._log.message(channel, data, self._time_us)
        self._publish(channel, messages)
        self._marks[self._indices[channel]] = sequence_of(messages[-1])

    def _failure(self, component: ComponentPlan, moment: str) -> str:
        return (
            f"{component.name} fails in {moment} of the branch" if self._live else super()._failure(component, moment)
        )


def _of_hosts(tick: RecordedTick | None, at_boundary: bool) -> list[TickEvent]:
    """Returns the recorded starts and ends of hosts at the boundary of a tick, or within the tick."""
    found: list[TickEvent] = []
    is_boundary = True
    for event in tick.events if tick else ():
        is_boundary = is_boundary and not isinstance(event, STAGES)
        if isinstance(event, HostStarted | HostStopped | HostLost) and is_boundary is at_boundary:
            found.append(event)
    return found
