"""Branch: a replay that goes on live after a tick, as a run of its own with its own recording."""

from collections.abc import Callable, Mapping, Sequence
from typing import cast

from fwk.component.images import Frame
from fwk.control.requests import RequestError
from fwk.control.settings import NewSettings, RunSettings
from fwk.gateway.connections import Sink
from fwk.lcm import envelope
from fwk.model.channel_table import facts_in
from fwk.model.names import LINES
from fwk.model.plain_values import value_messages
from fwk.model.plan import NOBODY
from fwk.model.tick_events import (
    ChannelsChanged,
    HostLost,
    MainLoopGiven,
    StageBegun,
    TickEvent,
    events_message,
)
from fwk.plan.what_ran import changed_modules
from fwk.recording.replay.frames import FrameSource, RingFrames
from fwk.recording.replay.live_replay import STAGES, LiveReplay
from fwk.recording.replay.recording import RecordedTick, Recording, RecordingError
from lcmtypes.core import channels_change_t, protocol_t


class Branch(LiveReplay):
    """Runs the components of a recording on its inputs up to a tick, and from there on their own outputs.

    Up to the tick the recorded messages count, whatever the components write, and the differences are named as in
    any replay. Afterwards the components go on with their own outputs. If nothing was changed, the main loop decides as
    recorded, so the messages are those of the run. Otherwise, and after the end of the recording, the main loop is in
    lockstep and decides itself; what the outside did in the run, it does in the branch: messages from outside,
    settings, starts and stops of hosts. Devices and programs are absent.

    Args:
        recording: the recording, perhaps with other classes of components (`with_classes`).
        changed: components with another class: what they write up to the tick is not compared.

    Raises:
        RecordingError: the recording cannot be branched.
    """

    def __init__(self, recording: Recording, changed: Mapping[str, str] | None = None) -> None:
        super().__init__(recording, changed)
        if recording.version != protocol_t.VERSION:
            raise RecordingError(
                f"{recording.path}: made by an earlier version of fwk (protocol {recording.version}); it can be "
                "replayed, and a run of today can be branched"
            )
        self._follows = True  # the decisions of the recording
        self._in_envelopes: set[str] = set()
        self._reads_lines = any(channel.name == LINES and channel.readers for channel in recording.plan.channels)
        self._frames_after = {
            channel: _Frames(self._lives.frames[channel], RingFrames(ring))
            for channel, ring in self._lives.rings.items()
            if channel in self._lives.recorded
        }
        self._lives.frames.update(self._frames_after)

    @property
    def in_envelopes(self) -> set[str]:
        """Dynamic channels whose messages are in envelopes."""
        return self._in_envelopes

    @property
    def cameras_again(self) -> list[str]:
        """Cameras whose frames are recorded, and which run again: their frames come from them after the branch."""
        writers = {channel.name: channel.writer for channel in self._run_plan.channels}
        return [channel for channel in self._frames_after if writers[channel] in self._lives.chosen]

    def check(self, sets: Sequence[str], to_tick: int) -> list[NewSettings]:
        """Returns the components' new settings after this tick, from `NAME.SETTING=VALUE`, without a replay.

        Raises:
            RecordingError: a setting does not exist, or a value does not fit.
        """
        settings = RunSettings(self._run_plan)
        for component, values in self.recording.settings_at(to_tick).items() if sets else ():
            settings.take(NewSettings(component, values, {}), "the recording")
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
        """Runs live up to a tick, after a replay up to the branch and `check_state`.

        Args:
            to_tick: the last tick.
            log: gets the messages and tick records after the branch.
            settings: new settings of components, from the first live tick on.
            begins: called with each tick before it begins.

        Raises:
            RecordingError: a component fails.
        """
        self._live, self._log = True, log
        is_changed = self._changed or settings or self.left_out or self.differences
        self._follows = not is_changed and not changed_modules(self._run_plan)
        self._set_components = {new.component for new in settings}
        for frames in self._frames_after.values():
            frames.go_live()
        for life in [life for host in range(len(self._run_plan.hosts)) for life in self._lives.living(host)]:
            for channel, writer in life.host.runners[life.plan.name].writers.items():
                writer.sequence = self._ledger.latest(self._indices[channel])
        changes = [(new.component, value_messages(new.values)) for new in settings]
        while self._now < to_tick:
            begins(self._now + 1)
            recorded = self._recorded_tick()
            if self._follows and recorded:
                self._follow(recorded)
            else:
                self._follows = False
                self._decide_tick(changes, recorded)
                if self._reads_lines:
                    self.absent[LINES] = f"no component reads log lines from tick {self._now} on"
            changes = []

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
        running = {life.plan.index for life in self._lives.all_running()}
        for component in plan.components:
            if component.name in self.left_out:
                self.absent[component.name] = self.left_out[component.name]
            elif component.index not in running:
                self.absent[component.name] = f"it did not run in tick {tick}"

    def _recorded_tick(self) -> RecordedTick | None:
        """Returns the next tick of the recording; None after its end."""
        try:
            tick = next(self._ticks, None)
        except RecordingError as error:
            tick = None
            self.absent["the rest of the recording"] = str(error)
        if tick is None:
            self._ticks = iter(())
            self.absent |= dict.fromkeys(self._run_plan.outside, "messages from outside end with the recording")
            return None
        outside = self._outside if self._follows else self._outside - {LINES}  # the lines are those of the run
        self._messages.hide({key: data for key, data in tick.messages.items() if key[0] in outside})
        return tick

    def _follow(self, tick: RecordedTick) -> None:
        """Runs a tick with the recorded decisions of the main loop, and records it.

        If the schedule is another one here, the components have changed: the branch decides itself from then on.
        """
        record, schedule = tick.record, self.decisions.schedule
        self._begin_tick(record.tick, record.time_us, record.channels)
        for settings in record.settings:
            self._set(settings, record.tick)
        before, holder, after, stages = self._boundary_of(tick.events)
        events = self._taken(before)
        if schedule.asked:
            schedule.decide()
        begun = [(event.step, event.stage) for event in stages if isinstance(event, StageBegun)]
        is_holder = schedule.holder == (self._holder if holder is None else holder)
        self._follows = is_holder and [*schedule.steps[: len(begun)]] == begun
        if schedule.holder != self._holder:
            events += self._taken([MainLoopGiven(schedule.holder)])
        events += self._taken(after)
        if self.decisions.wrong:
            raise RecordingError(f"{self.recording.path}: cannot go on as in the run: {self.decisions.wrong}")
        events += self._taken(stages if self._follows else self._stages())
        record.events = events_message(events)
        self._write(record)

    def _take_events(self, events: Sequence[TickEvent]) -> None:
        """Takes the events of a recorded tick before the branch."""
        before, holder, after, stages = self._boundary_of(events)
        self._taken(before)
        self.decisions.check_holder(self._holder if holder is None else holder, self._now)
        if holder is not None:
            self._taken([MainLoopGiven(holder)])
        self._taken([*after, *stages])

    def _boundary_of(
        self, events: Sequence[TickEvent]
    ) -> tuple[Sequence[TickEvent], int | None, Sequence[TickEvent], Sequence[TickEvent]]:
        """Divides the events of a tick at the decision about the main loop.

        Returns:
            Events before the decision, the new holder (None: the holder stayed), those after it, and those from the
            first stage on. A holder that stays although its host ended had been confirmed before.
        """
        end = next((at for at, event in enumerate(events) if isinstance(event, STAGES)), len(events))
        boundary = events[:end]
        given = next((at for at, event in enumerate(boundary) if isinstance(event, MainLoopGiven)), None)
        if given is not None:
            holder = cast(MainLoopGiven, boundary[given]).component
            return boundary[:given], holder, boundary[given + 1 :], events[end:]
        lost = HostLost(self._run_plan.components[self._holder].host if self._holder != NOBODY else NOBODY)
        at = boundary.index(lost) if lost in boundary else end
        return boundary[:at], None, boundary[at:], events[end:]

    def _take_event(self, event: TickEvent) -> None:
        if isinstance(event, ChannelsChanged):
            change = self._changes[event.change]
            if self._follows:
                self._end_killed(change)
                self.decisions.check_channels(change)
            opened = [fact.channel for fact in facts_in(change) if fact.channel]
            self._in_envelopes |= {each.name for each in opened if envelope.is_plain(each.type_name)}
        super()._take_event(event)

    def _end_killed(self, change: channels_change_t) -> None:
        """Ends hosts that ended in the run without finalizing: their channels are closed, although they still leave."""
        gone = [self._run_plan.components[fact.component].host for fact in facts_in(change) if fact.kind == "go"]
        for host in dict.fromkeys(gone):
            if host in self._lives.leaving:
                super()._take_event(HostLost(host))

    def _begin_tick(self, tick: int, time_us: int, channels: Sequence[channels_change_t]) -> None:
        if self._follows:
            self.decisions.advance(time_us)  # the recorded time counts
            self.decisions.participants.forget()
        super()._begin_tick(tick, time_us, channels)


class _Frames:
    """Frames of a camera: recorded ones up to the branch, then its own."""

    def __init__(self, before: FrameSource, after: FrameSource) -> None:
        self._source, self._after = before, after

    def go_live(self) -> None:
        """Takes the camera's own frames from now on."""
        self._source = self._after

    def take(self, number: int, size: int) -> Callable[[], Frame | None]:
        return self._source.take(number, size)
