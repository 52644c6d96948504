"""Branch: a replay that goes on live after a tick, as a run of its own with its own recording."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from importlib import import_module

from fwk.clock import US_PER_S
from fwk.component.component import Component
from fwk.component.declaration import declaration
from fwk.component.images import Frame
from fwk.component.port import DeclarationError
from fwk.control.requests import RequestError
from fwk.control.settings import NewSettings, RunSettings
from fwk.gateway.connections import Sink
from fwk.lcm import envelope
from fwk.lcm.messages import sequence_of
from fwk.model.channel_table import facts_in
from fwk.model.names import LINES
from fwk.model.plain_values import value_messages, value_of
from fwk.model.plan import ComponentPlan
from fwk.model.tick_events import (
    ChannelsChanged,
    FinalDone,
    HostLost,
    HostStarted,
    HostStopped,
    IterationDone,
    MainLoopGiven,
    StageBegun,
    StageDone,
    TickEvent,
    TickTold,
    events_message,
)
from fwk.recording.replay.decisions import Decisions
from fwk.recording.replay.frames import FrameSource, RingFrames
from fwk.recording.replay.recording import Recording, RecordingError
from fwk.recording.replay.replay import Made, Replay
from fwk.recording.versions import RECORD
from lcmtypes.core import channels_change_t, protocol_t, settings_change_t, tick_record_t


class Branch(Replay):
    """Runs the components of a recording on its inputs up to a tick, and from there on their own outputs.

    Up to the tick the recorded messages count, whatever the components write, and the differences are named as in
    any replay. Afterwards the components go on in lockstep, by the decisions of the run's main loop. Devices and
    programs outside are absent then. If nothing was changed, the messages are those of the run.

    Args:
        recording: the recording, perhaps with other classes of components (`with_classes`).
        changed: components with another class: what they write up to the tick is not compared.

    Raises:
        RecordingError: the recording cannot be branched.
    """

    def __init__(self, recording: Recording, changed: Mapping[str, str] | None = None) -> None:
        super().__init__(recording)
        if recording.version != protocol_t.VERSION:
            raise RecordingError(
                f"{recording.path}: made by an earlier version of fwk (protocol {recording.version}); it can be "
                "replayed, and a run of today can be branched"
            )
        self.absent: dict[str, str] = {}
        """Components and channels that are silent after the branch, each with the reason."""
        self.decisions = Decisions(recording.plan, self._ledger)
        self._changed = changed or {}
        self._live = False
        self._log: Sink | None = None
        self._marks: dict[int, int] = {}  # moved in the running tick
        self._iterations: dict[int, tuple[int, int]] = {}  # by continuous component: newest number and its time
        self._in_envelopes: set[str] = set()
        self._frames_after = {
            channel: _Frames(self._frames[channel], RingFrames(ring))
            for channel, ring in self._rings.items()
            if channel in self._recorded
        }
        self._frames.update(self._frames_after)

    @property
    def in_envelopes(self) -> set[str]:
        """Dynamic channels whose messages are in envelopes."""
        return self._in_envelopes

    @property
    def cameras_again(self) -> list[str]:
        """Cameras whose frames are recorded, and which run again: their frames come from them after the branch."""
        writers = {channel.name: channel.writer for channel in self._plan.channels}
        return [channel for channel in self._frames_after if writers[channel] in self._chosen]

    def check(self, sets: Sequence[str]) -> list[NewSettings]:
        """Returns the components' new settings after the branch, from `NAME.SETTING=VALUE`.

        Raises:
            RecordingError: a setting does not exist, or a value does not fit.
        """
        settings = RunSettings(self._run_plan)
        for component, changes in self._settings.items():
            settings.take(NewSettings(component, value_of(changes[-1].values), {}), "the recording")
        try:
            return settings.check(sets)
        except RequestError as error:
            raise RecordingError(f"--set: {error}") from error

    def go_on(
        self,
        to_tick: int,
        log: Sink,
        settings: Sequence[NewSettings] = (),
        begins: Callable[[int], None] = lambda _: None,
    ) -> None:
        """Runs live up to a tick, after a replay up to the branch.

        Args:
            to_tick: the last tick.
            log: gets the messages and tick records after the branch.
            settings: new settings of components, from the first live tick on.
            begins: called with each tick before it begins.

        Raises:
            RecordingError: a component fails.
        """
        self._live, self._log = True, log
        for frames in self._frames_after.values():
            frames.go_live()
        for lives in (*self._lives.values(), *self._leaving.values()):
            for life in lives:
                for channel, writer in life.host.runners[life.plan.name].writers.items():
                    writer.sequence = self._ledger.latest(self._indices[channel])
        first = True
        while self._now < to_tick:
            begins(self._now + 1)
            self._live_tick(settings if first else ())
            first = False

    def check_state(self) -> None:
        """Checks that the state of the main loop is that of the run, and notes what is absent from now on.

        Raises:
            RecordingError: it cannot be rebuilt.
        """
        plan, tick = self._run_plan, self._now
        wrong = self.decisions.wrong
        if self.decisions.schedule.holder != self._holder and not wrong:
            wrong = f"{plan.components[self._holder].name} has the main loop in tick {tick} and did not request it here"
        if wrong:
            raise RecordingError(f"{self.recording.path}: cannot go on live after tick {tick}: {wrong}")
        running = {life.plan.index for lives in self._lives.values() for life in lives}
        for component in plan.components:
            if component.name in self.left_out:
                self.absent[component.name] = self.left_out[component.name]
            elif component.index not in running:
                self.absent[component.name] = f"it did not run in tick {tick}"
        self.absent |= dict.fromkeys(plan.outside, "messages from outside end")
        if any(channel.name == LINES and channel.readers for channel in plan.channels):
            self.absent[LINES] = "no component reads log lines after the branch"

    def _live_tick(self, settings: Sequence[NewSettings]) -> None:
        """Runs a tick as the main loop does, and records it."""
        changed = self.decisions.schedule.decide() if self.decisions.schedule.asked else False
        change = self.decisions.decide_channels()
        self._begin_tick(self._now + 1, self.decisions.advance(self._time_us), [change] if change else [])
        record = tick_record_t()
        record.version, record.tick, record.time_us = protocol_t.VERSION, self._now, self._time_us
        record.channels = [change] if change else []
        record.settings = [self._settings_change(new) for new in settings]
        for made in record.settings:
            self._set(made, self._now)
        events: list[TickEvent] = []
        for event in self._boundary(MainLoopGiven(self.decisions.schedule.holder) if changed else None):
            events.append(event)
            self._take_event(event)
        for event in self._stages():
            events.append(event)
            self._take_event(event)
        record.events = events_message(events)
        record.channel, record.sequence = list(self._marks), list(self._marks.values())
        record.n_marks, self._marks = len(record.channel), {}
        assert self._log
        record.n_settings, record.n_channels = len(record.settings), len(record.channels)
        self._log.message(RECORD, record.encode(), self._time_us)
        self._log.tick()

    def _boundary(self, given: MainLoopGiven | None) -> list[TickEvent]:
        """Returns the decisions before the first stage; at first those about what was late at the branch."""
        events: list[TickEvent] = [given] if given else []
        events += [ChannelsChanged(number) for number in self._changes]
        events += list(self._owed)
        events += [FinalDone(host, self._now - 1) for host in self._leaving]
        return events

    def _stages(self) -> list[TickEvent]:
        """Returns the stages of a tick with the dones of their hosts, and the iterations of continuous components."""
        continuous = [life for lives in self._lives.values() for life in lives if life.plan.rate_hz is not None]
        events: list[TickEvent] = [TickTold()] if continuous else []
        for step, stage in self.decisions.schedule.steps:
            events.append(StageBegun(stage, step))
            events += [
                StageDone(host, self._now, step)
                for host, lives in sorted(self._lives.items())
                if any(stage in life.plan.stages for life in lives)
            ]
        for life in continuous:
            number, time_us = self._iterations.get(life.plan.index, (0, -US_PER_S))
            if self._time_us >= time_us + US_PER_S / (life.plan.rate_hz or US_PER_S):
                events.append(IterationDone(self._run_plan.components[life.plan.index].host, self._now, number + 1))
        return events

    def _settings_change(self, new: NewSettings) -> settings_change_t:
        made = settings_change_t()
        self.decisions.newest_change += 1
        made.number, made.component = self.decisions.newest_change, new.component
        made.values = value_messages(new.values)
        return made

    def _take_event(self, event: TickEvent) -> None:
        components = self._run_plan.hosts
        if isinstance(event, MainLoopGiven) and not self._live:
            self.decisions.check_holder(event.component, self._now)
        elif isinstance(event, StageBegun) and not self._live and self._stage < 0:  # the boundary has ended
            self.decisions.check_holder(self._holder, self._now)
        elif isinstance(event, ChannelsChanged):
            change = self._changes[event.change]
            if not self._live:
                self.decisions.check_channels(change)
            opened = [fact.channel for fact in facts_in(change) if fact.channel]
            self._in_envelopes |= {each.name for each in opened if envelope.is_plain(each.type_name)}
        elif isinstance(event, HostStarted):
            self.decisions.came(components[event.host].components, event.incarnation)
        elif isinstance(event, HostLost | HostStopped):
            self.decisions.left(components[event.host].components)
        elif isinstance(event, IterationDone):
            for index in components[event.host].components:
                self._iterations[index] = event.iteration, self._time_us
        super()._take_event(event)

    def _begin_tick(self, tick: int, time_us: int, channels: Sequence[channels_change_t]) -> None:
        if not self._live:
            self.decisions.advance(time_us)  # the recorded time counts
        super()._begin_tick(tick, time_us, channels)

    def _set(self, change: settings_change_t, tick: int) -> None:
        self.decisions.newest_change = max(change.number, self.decisions.newest_change)
        super()._set(change, tick)

    def _compare(self, host: int, tick: int, step: int, made: Made) -> None:
        """Compares what a host's done published up to the branch; afterwards publishes and records it."""
        for life, _ in made:
            if life.done:
                self.decisions.heed(life.done, self._live)
        if not self._live:
            super()._compare(host, tick, step, [each for each in made if each[0].plan.name not in self._changed])
            return
        assert self._log
        for _, written in made:
            by_channel: dict[str, list[bytes]] = {}
            for channel, data in written:
                by_channel.setdefault(channel, []).append(data)
                self._log.message(channel, data, self._time_us)
            for channel, messages in by_channel.items():
                self._publish(channel, messages)
                self._marks[self._indices[channel]] = sequence_of(messages[-1])

    def _failure(self, component: ComponentPlan, moment: str) -> str:
        return (
            f"{component.name} fails in {moment} of the branch" if self._live else super()._failure(component, moment)
        )


class _Frames:
    """Frames of a camera: recorded ones up to the branch, then its own."""

    def __init__(self, before: FrameSource, after: FrameSource) -> None:
        self._source, self._after = before, after

    def go_live(self) -> None:
        """Takes the camera's own frames from now on."""
        self._source = self._after

    def take(self, number: int, size: int) -> Callable[[], Frame | None]:
        return self._source.take(number, size)


def with_classes(recording: Recording, classes: Mapping[str, str]) -> None:
    """Gives components of a recorded plan other classes, as `module:Class` by component.

    Raises:
        RecordingError: no such component or class, or the class has other ports.
    """
    plan = recording.plan
    names = {component.name: component for component in plan.components}
    changed = list(plan.components)
    for name, word in classes.items():
        if name not in names:
            raise RecordingError(f"--with {name}: no such component in this run; there are: {', '.join(names)}")
        component = names[name]
        module, _, class_name = word.partition(":")
        try:
            kind = getattr(import_module(module), class_name)
            ports = {port.attribute for port in declaration(kind).ports}
        except (ImportError, AttributeError, ValueError, TypeError, DeclarationError) as error:
            raise RecordingError(f"--with {name}={word}: {type(error).__name__}: {error}") from error
        if not issubclass(kind, Component) or ports != set(component.channels):
            raise RecordingError(
                f"--with {name}={word}: its ports are {', '.join(sorted(ports)) or 'none'}, those of the run "
                f"{', '.join(sorted(component.channels)) or 'none'}; they have to be the same"
            )
        changed[component.index] = replace(component, module=module, class_name=class_name)
    recording.plan = replace(plan, components=tuple(changed))
