"""The main loop without processes: what it is told in which order, and what it says then."""

from collections.abc import Callable
from contextlib import suppress
from types import SimpleNamespace
from typing import Any, cast

from fwk import Component, Reads, Writes
from fwk.bus import sync
from fwk.clock import Clock
from fwk.component.log import Logger
from fwk.engine.visibility import Ledger
from fwk.supervisor.event_loop import EventLoop
from fwk.supervisor.loop import MainLoop
from fwk.supervisor.processes.host_process import HostEntry, host_table
from fwk.supervisor.run_clock import Pace
from fwk.testing.plans import plan_of
from lcmtypes.core import done_t, log_t, tick_t
from lcmtypes.robot import imu_t

RUN = 4711
LEFT, RIGHT = 0, 1


class Left(Component):
    stage = "think"
    left: Writes[imu_t]
    right: Reads[imu_t]


class Right(Component):
    stage = "think"
    right: Writes[imu_t]
    left: Reads[imu_t]


class Played:
    """A main loop of two hosts in one stage; each pump of the mailbox plays the next step of the script."""

    def __init__(self, clock: str = "simulated") -> None:
        plan = plan_of({"r/left": Left, "r/right": Right}, clock=clock, period_s=0.001, loop_time_warnings=False)
        self.table = host_table(plan)
        self.ledger = Ledger(plan)
        self.script: list[Callable[[], None]] = []
        self.sent: list[tuple[bytes, bytes]] = []
        self.logged: list[log_t] = []
        self._receiver = cast(Any, SimpleNamespace())
        self._now_us = 0
        network = SimpleNamespace(now_us=self._look_at_the_clock, watch=lambda _: None)
        self._hosts = cast(Any, SimpleNamespace(table=self.table, unsettled=False, leaving=set()))
        self._hosts.maintain = self._hosts.steer = lambda: None
        socket = SimpleNamespace(fileno=lambda: 0)
        sender = SimpleNamespace(socket=socket, publish=lambda channel, data, _: self.sent.append((channel, data)))
        self.loop = MainLoop(
            plan,
            RUN,
            self._hosts,
            self.ledger,
            EventLoop(cast(Any, network)),
            self._receiver,
            cast(Any, sender),
            Pace(plan, 0.0),
            Logger("supervisor", Clock(), self.logged.append),
            lambda: not self.script,
        )
        for entry in self.table:
            entry.starting(0)
            entry.state = "running"

    @property
    def ticks(self) -> list[tick_t]:
        return [sync.decode_tick(data) for channel, data in self.sent if channel == sync.TICK]

    def done(self, host: int, sequence: int, tick: int = 1, incarnation: int = 1) -> None:
        made = done_t()
        made.run, made.host, made.incarnation, made.tick, made.step = RUN, host, incarnation, tick, 5
        made.next_time_us = -1
        made.n_marks, made.channel, made.sequence = 1, [host], [sequence]
        self._receiver.on_done(made)

    def dones(self, *answers: tuple[int, int, int]) -> None:
        for host, sequence, tick in answers:
            self.done(host, sequence, tick)

    def die(self, entry: HostEntry) -> None:
        entry.ended(-9, 0, stopping=False)
        self.ledger.void(entry.index, entry.incarnation + 1, self.loop.tick)
        self._hosts.on_lost(entry)

    def return_(self, entry: HostEntry) -> None:
        entry.starting(0)
        entry.state = "running"
        self._hosts.on_started(entry)

    def play(self, *script: Callable[[], None]) -> None:
        """Runs one tick with this script; the loop is interrupted where the script ends."""
        self.script = [*script]
        steps = self.loop.run_tick()
        with suppress(StopIteration):
            next(steps)
            while True:
                self._pump()
                steps.send([])

    def _look_at_the_clock(self) -> int:
        self._now_us += 10
        return self._now_us

    def _pump(self) -> None:
        if self.loop._outstanding and self.script:
            self.script.pop(0)()


def test_a_stage_ends_when_all_have_answered_and_marks_move_with_the_next() -> None:
    played = Played()
    played.play(lambda: played.done(LEFT, 1), lambda: played.done(RIGHT, 1), lambda: None)
    assert played.ledger.marks == [0, 0]
    played.ledger.begin()
    assert played.ledger.marks == [1, 1]


def test_a_repeated_tick_does_not_tell_what_peers_did_meanwhile() -> None:
    played = Played()
    right = played.table[RIGHT]
    played.play(
        lambda: played.done(LEFT, 1), lambda: played.die(right), lambda: played.return_(right), *[lambda: None] * 3
    )
    first, again = played.ticks[0], played.ticks[-1]
    assert len(played.ticks) == 2
    assert (first.n_marks, again.n_marks) == (0, 0)

    assert [list(tick.absent) for tick in (first, again)] == [[], [LEFT]]


def test_a_done_that_comes_after_the_news_of_death_does_not_count() -> None:
    played = Played()
    right = played.table[RIGHT]
    played.play(lambda: played.done(LEFT, 1), lambda: played.die(right), lambda: played.done(RIGHT, 1), lambda: None)
    played.ledger.begin()
    assert played.ledger.marks == [1, 0]
    assert [(void.channel, void.above_sequence) for void in played.ledger.voids] == [(RIGHT, 0)]


def test_answers_of_other_ticks_and_incarnations_do_not_count() -> None:
    played = Played()
    played.play(
        lambda: played.done(LEFT, 1, tick=9), lambda: played.done(LEFT, 1, incarnation=2), lambda: None, lambda: None
    )
    played.ledger.begin()
    assert played.ledger.marks == [0, 0]


def test_in_real_time_the_late_one_is_named_left_out_and_reminded_until_it_answers() -> None:
    played = Played("wall")
    idle = [lambda: None] * 100_000  # the stage's time is a millisecond
    played.play(lambda: played.done(LEFT, 1), *idle)
    assert [line.text.partition(":")[0] for line in played.logged] == ["r/right is late"]
    assert played.loop.late == 1
    played.sent.clear()
    played.play(lambda: played.done(LEFT, 2, tick=2), *idle)
    reminder, second = played.ticks
    assert (reminder.tick, list(reminder.absent)) == (1, [LEFT])  # nor may a new process take it for its first
    assert (second.tick, list(second.absent)) == (2, [RIGHT])
    played.sent.clear()
    played.play(lambda: played.dones((RIGHT, 1, 1), (LEFT, 3, 3)), *idle)
    assert [line.text.partition(";")[0] for line in played.logged[1:]] == ["r/right is on time again"]
    played.sent.clear()
    played.play(lambda: played.dones((LEFT, 4, 4), (RIGHT, 2, 4)), *idle)
    assert [(tick.tick, list(tick.absent)) for tick in played.ticks] == [(4, [])]
    assert dict(zip(played.ticks[0].channel, played.ticks[0].sequence, strict=True)) == {LEFT: 3, RIGHT: 1}


def test_while_paused_no_tick_runs_but_what_is_asked_between_ticks_happens() -> None:
    played = Played()
    boundaries: list[int] = []
    played.loop.on_boundary = boundaries.append
    played.loop.pace.pause()
    for _ in range(3):
        played.play(lambda: None)
    assert (played.loop.tick, played.loop.stands, played.ticks) == (0, True, [])
    assert boundaries == [1, 1, 1]
    played.loop.pace.step(1)
    played.play(lambda: played.dones((LEFT, 1, 1), (RIGHT, 1, 1)), lambda: None)
    played.play(lambda: None)
    assert (played.loop.tick, played.loop.stands, len(played.ticks)) == (1, True, 1)
