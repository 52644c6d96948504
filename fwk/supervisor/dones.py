"""Decides which dones count and takes their contents."""

from collections.abc import Callable

from fwk.bus import sync
from fwk.engine.boundary import BoundaryRequests
from fwk.lcm.messages import MessageError
from fwk.model.requests import has_requests
from fwk.model.tick_events import FinalDone, FrameLost, IterationDone, MessageLost, OutsideTaken, StageDone
from fwk.supervisor.barrier import Barrier
from fwk.supervisor.continuous import ContinuousHosts
from fwk.supervisor.core import Core
from fwk.supervisor.done_check import DoneCheck
from fwk.supervisor.host_process import HostProcess
from fwk.supervisor.loop_times import LoopTimes
from fwk.supervisor.tick_log import TickLog
from lcmtypes.core import done_t, recorded_t, taken_t

# Kinds of dones; the member of a class takes longer to find, and a done asks for it five times.
_STAGE, _ITERATION, _FINAL = done_t.STAGE, done_t.ITERATION, done_t.FINAL


class Dones:
    """Takes each done that answers a tick of its host; refuses, counts and names impossible dones."""

    def __init__(
        self,
        core: Core,
        barrier: Barrier,
        continuous: ContinuousHosts,
        requests: BoundaryRequests,
        tick_log: TickLog,
        times: LoopTimes,
        complain: Callable[[str, str], None],
    ) -> None:
        self._core = core
        self._barrier = barrier
        self._continuous = continuous
        self._requests = requests
        self._tick_log = tick_log
        self._times = times
        self._complain = complain
        self._check = DoneCheck(core)
        self._from_outside: dict[int, int] = {}  # marks of messages from outside, visible from the next tick on
        core.events.subscribe(done_t, self._receive)
        core.events.subscribe(recorded_t, self._receive_recorded)

    def take_in(self) -> None:
        """At the beginning of a tick, makes messages from outside visible to all its stages."""
        if not self._from_outside:
            return
        arrived, self._from_outside = self._from_outside, {}
        moved = {channel: number for channel, number in arrived.items() if self._core.ledger.publish(channel, number)}
        if moved:
            for channel, number in moved.items():
                self._tick_log.mark(channel, number)
            self._tick_log.event(OutsideTaken())

    def _receive(self, done: done_t) -> None:
        host = self._core.hosts[done.host]
        try:
            if self._counts(host, done):
                self._take(host, done)
            else:
                self._barrier.keep_early(host, done)
                self._barrier.answered_again(done)
        except MessageError as error:
            self._complain("fwk/done", f"{error}; refused")

    def _receive_recorded(self, recorded: recorded_t) -> None:
        try:
            self._check.check_recorded(recorded)
        except MessageError as error:
            self._complain("fwk/recorded", f"{error}; refused")
            return
        self._tick_log.acknowledge(recorded)
        for channel, sequence in zip(recorded.channel, recorded.sequence, strict=True):
            self._from_outside[channel] = max(sequence, self._from_outside.get(channel, 0))

    def _counts(self, host: HostProcess, done: done_t) -> bool:
        """Returns whether a done is of the host's present incarnation and of an unanswered iteration."""
        if done.incarnation != host.incarnation:  # messages of an ended process are void already
            return False
        if done.kind == _FINAL:
            return self._counts_as_final(host, done)
        if host.continuous:
            return self._continuous.counts(host, done)
        if done.kind != _STAGE:
            return False
        answered = (done.tick, done.step)
        if answered == host.late_with:
            return host.alive or host.stopping
        return answered == self._barrier.place and host.alive and host.index in self._barrier.outstanding

    def _counts_as_final(self, host: HostProcess, done: done_t) -> bool:
        """Returns whether a final done is new; the last iteration of a late host is taken first, if it ran."""
        if host.late_with and host.late_with[0] <= done.tick:
            return False
        if not host.finalizing:
            self._tell_taken(done)
        return host.finalizing

    def _tell_taken(self, done: done_t) -> None:
        """Confirms to the host that its done was taken."""
        port = self._core.ports.host(done.host)
        self._core.sender.send(sync.TAKEN, sync.taken(done, taken_t.SUPERVISOR), port)

    def _take(self, host: HostProcess, done: done_t) -> None:
        """Makes the messages of a done visible with the next stage."""
        asks = has_requests(done)
        self._check.check(done, asks)
        self._note_answer(host, done)
        if host.changes:
            host.drop_told_changes()
        for channel, sequence in zip(done.channel, done.sequence, strict=True):
            self._core.ledger.publish(channel, sequence)
            self._tick_log.mark(channel, sequence)
        if done.next_time_us >= 0:
            self._core.clock.source(done.next_time_us)
        if asks:
            self._record_losses(done)
            self._collect(done)
        self._tick_log.event(_event_of(done))

    def _record_losses(self, done: done_t) -> None:
        """Records the host's losses before the done: a replay withholds the same messages from the components."""
        for message in done.lost:
            self._tick_log.event(MessageLost(done.host, message.channel, message.sequence))
        for frame in done.lost_frames:
            self._tick_log.event(FrameLost(frame.component, frame.channel, frame.frame))

    def _collect(self, done: done_t) -> None:
        """Collects the boundary requests of a done."""
        for kind, asked in (("main_loop", done.main_loop), ("channels", done.channels), ("plugins", done.plugins)):
            for request in asked:
                name = self._core.plan.components[request.component].name
                self._requests.ask(done.tick, sync.place_of(done), name, kind, request)

    def _note_answer(self, host: HostProcess, done: done_t) -> None:
        if done.kind == _FINAL:
            host.finalizing = False
            self._tell_taken(done)
        elif host.late_with == (done.tick, done.step) and not host.continuous:
            host.late_with = None
            self._times.on_time_again(host, done.tick, done.busy_us)
        elif host.continuous:
            self._continuous.take(host, done)
        else:
            self._barrier.answered(host)
            self._times.answered(host.index, self._barrier.turn.stage, done.busy_us, done.tick)


def _event_of(done: done_t) -> FinalDone | IterationDone | StageDone:
    """Returns the event of a done that is taken."""
    if done.kind == _FINAL:
        return FinalDone(done.host, done.tick)
    if done.kind == _ITERATION:
        return IterationDone(done.host, done.tick, done.iteration)
    return StageDone(done.host, done.tick, done.step)
