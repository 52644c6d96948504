"""The host participant of a continuous component: iterates at its own rate on the newest marks."""

import math
from collections.abc import Sequence

from fwk.bus import sync
from fwk.bus.network import Network, Steps
from fwk.bus.retransmission import Backoff
from fwk.clock import US_PER_S
from fwk.engine.assignment import Assignment
from fwk.engine.catch_up import CatchUp
from fwk.engine.channel_buffer import ChannelBuffer
from fwk.host.dynamic_channels import DynamicChannels
from fwk.host.hooks import ProcessHooks
from fwk.host.host import Host
from fwk.lcm.messages import MessageError
from lcmtypes.core import channels_change_t, done_t, header_t, protocol_t, settings_change_t, tick_t

REPEAT_US = 2_000
"""First wait before a done that was not taken is sent again; it doubles up to `REPEAT_LONGEST_US`."""
REPEAT_LONGEST_US = 100_000
TAKEN_TIMEOUT_US = US_PER_S
"""Longest wait of a stopped host until its last iteration was taken."""
_MOST = header_t.FINAL - 1  # iterations on the same marks; larger numbers have another meaning


class ContinuousHost(Host):
    """Runs one continuous component.

    In simulated time it runs no more iterations on the marks of a tick than its rate gives in the time of one, so it
    stands still when time does.
    """

    def __init__(self, assignment: Assignment, network: Network, hooks: ProcessHooks) -> None:
        super().__init__(assignment, network, hooks)
        own = self.group.plans[0]
        rate_hz = own.rate_hz or 0.0
        self._period_us = round(US_PER_S / rate_hz) if rate_hz else 0
        a_tick = max(1, math.ceil(rate_hz * self._plan.period_us / US_PER_S))
        self._most = _MOST if self._plan.clock == "wall" and rate_hz else a_tick
        self._names = (own.name,)
        self._catch_up = CatchUp(assignment.start.incarnation, continuous=True)
        self._told: list[tick_t] = []  # ticks that were not taken over yet
        self._tick: tick_t | None = None  # the newest tick that was taken over
        self._marks: dict[int, int] = {}  # marks of all ticks since the last iteration, by channel
        self._moved: dict[int, ChannelBuffer] = {}  # buffers with messages that became visible since the last iteration
        self._settings: dict[int, settings_change_t] = {}  # changes for the next iteration, by number
        self._channels: dict[int, channels_change_t] = {}
        self._runs = 0  # iterations on the marks of `_tick`
        self._due_us = 0  # wall time of the next iteration; a late one is made up for by one period at most
        self._repeats = Backoff(0, REPEAT_US, REPEAT_LONGEST_US)
        self._taken = True  # whether the supervisor has the last done

    def _work(self) -> Steps[None]:
        while not self._stopping():
            self._handle_own()
            self._take_over()
            if self._ready and self._now_us() >= self._due_us:
                yield from self._run()
            else:
                yield self._idle_until_us
            self._repeat_if_due()
            self._sender.send_due()
            if self._now_us() >= self._report_us:
                self._report()

    def _finalize(self) -> Steps[None]:
        yield from self._wait_until_taken()
        yield from super()._finalize()

    @property
    def _ready(self) -> bool:
        return self._tick is not None and self._taken and self._runs < self._most

    @property
    def _idle_until_us(self) -> int:
        """Wall time until which the host idles unless a message arrives."""
        until_us = min(self._report_us, self._sender.due_us)
        if self._ready:
            until_us = min(until_us, self._due_us)
        if not self._taken:
            until_us = min(until_us, self._repeats.due_us)
        return until_us

    def _handle_message(self, channel: bytes, data: bytes) -> None:
        if channel == sync.TICK:
            tick: tick_t = sync.decode_tick(data)
            if tick.version != protocol_t.VERSION:
                raise MessageError(f"protocol version {tick.version}, this host has {protocol_t.VERSION}")
            if tick.run == self._assignment.run:
                self._told.append(tick)
        elif channel == sync.TAKEN:
            taken = sync.decode_taken(data)
            is_last = taken.kind == done_t.ITERATION and (taken.tick, taken.iteration) == self._answered
            self._taken = self._taken or is_last
            if self._shutdown:
                self._shutdown.answered(taken)
        else:
            super()._handle_message(channel, data)

    def _serve_in_background(self) -> int:
        """Answers fetches and collects the next inputs while an iteration runs; returns when it wants to be called."""
        self._handle_own()
        self._take_over()
        self._sender.send_due()
        return self._sender.due_us

    def _take_over(self) -> None:
        """Takes over the marks and changes of ticks that arrived, in their order."""
        told, self._told = self._told, []
        for tick in told:
            if self._tick and tick.tick <= self._tick.tick:
                continue
            self._marks.update(zip(tick.channel, tick.sequence, strict=True))
            for buffer in self.inputs.advance(tick.channel, tick.sequence, tick.voids):
                self._moved[buffer.plan.index] = buffer
            if self._catch_up.applies(tick.tick):
                self.inputs.keep_newest()
            for buffer in self._moved.values():
                buffer.collect()
            # Changes are repeated until an iteration has applied them.
            self._settings |= {change.number: change for change in tick.settings}
            self._channels |= {change.number: change for change in tick.channels}
            self._tick, self._runs = tick, 0

    def _run(self) -> Steps[None]:
        tick = self._tick
        assert tick
        settings = [self._settings[number] for number in sorted(self._settings)]
        channels = [self._channels[number] for number in sorted(self._channels)]
        self._settings, self._channels = {}, {}
        if self._dynamic and channels:
            self._open(self._dynamic, channels, tick)
        self._marks.clear()
        moved = list(self._moved.values())
        lacking = self.inputs.collect(moved)
        if lacking and not (yield from self._fetch(lacking)):
            return
        if self._answered[0] == 0:
            self.inputs.forget_predecessor()
        self._moved = {}
        self.group.deliver(moved)
        if settings or channels:
            self.group.configure(settings, channels)
        self.group.set_holder(tick.main_loop)
        self._clock.tick, self._clock.now_us = tick.tick, tick.time_us
        self._catch_up.took_part(tick.tick)
        self._runs += 1
        number = self._runs  # a tick that arrives during the iteration counts again
        self._due_us = self._period_us + max(self._due_us, self._now_us() - self._period_us)
        with self._hooks.background(self._own, self._serve_in_background):
            ran = self.group.run(self._names, "", tick, number)
        self._answered, self._taken = (tick.tick, number), False
        done = self._message
        done.kind, done.tick, done.step, done.iteration = done_t.ITERATION, tick.tick, -1, number
        self._repeats = Backoff(self._now_us(), REPEAT_US, REPEAT_LONGEST_US)
        self._finish(self._names, ran)
        self._sender.publish(sync.DONE, self._done, self._sync_port)

    def _open(self, dynamic: DynamicChannels, changes: Sequence[channels_change_t], tick: tick_t) -> None:
        """Applies decisions on dynamic channels before an iteration; the catch-up rule holds for newly read ones.

        The mark of a newly read channel may have come with any tick since the last iteration.
        """
        new = dynamic.take_over(changes)
        self.inputs.advance(list(self._marks), list(self._marks.values()), tick.voids)
        for buffer in new:
            buffer.keep_newest()
        moved = {**self._moved, **{buffer.plan.index: buffer for buffer in new if buffer.mark}}
        self._moved = {index: buffer for index, buffer in moved.items() if index in self.inputs}

    def _wait_until_taken(self) -> Steps[None]:
        """Waits for the done before the last one: without it, its messages would be visible but not its iteration."""
        until_us = self._now_us() + TAKEN_TIMEOUT_US
        while not self._taken and self._now_us() < until_us:
            yield min(until_us, self._repeats.due_us, self._sender.due_us)
            self._handle_own()
            self._repeat_if_due()
            self._sender.send_due()

    def _repeat_if_due(self) -> None:
        if self._taken or self._now_us() < self._repeats.due_us:
            return
        self._sender.publish(sync.DONE, self._done, self._sync_port)
        self._repeats.repeated(self._now_us())


def host_of(assignment: Assignment, network: Network, hooks: ProcessHooks) -> Host:
    """Returns the participant that suits the components of an assignment."""
    plan = assignment.plan
    components = [plan.components[index] for index in plan.hosts[assignment.host].components]
    kind = Host if components[0].rate_hz is None else ContinuousHost
    return kind(assignment, network, hooks)
