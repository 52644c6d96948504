"""Components that use the former names of annotations run unchanged."""

from typing import Any

from lcmtypes.simulation import order_t, question_t, reply_t

from fwk import (
    Call,
    Calls,
    CallsEach,
    Commands,
    CommandsEach,
    Component,
    Each,
    Future,
    Image,
    ImagesEach,
    Reads,
    ReadsEach,
    Sends,
    SendsEach,
    Serves,
    ServesEach,
    Writes,
    WritesEach,
    channel,
)
from fwk.component.declaration import declaration
from fwk.testing import Bench
from lcmtypes.robot import odometry_t


class Now(Component):
    stage = "think"
    commands: Serves[order_t]
    sends: Calls[order_t] = channel("lift")
    images: Each[Image]
    reads: Each[Reads[odometry_t]]
    writes: Each[Writes[odometry_t]]
    commands_each: Each[Serves[order_t]]
    sends_each: Each[Calls[order_t]]
    serves_each: Each[Serves[question_t, reply_t]]
    calls_each: Each[Calls[question_t, reply_t]]


class Before(Component):
    stage = "think"
    commands: Commands[order_t]
    sends: Sends[order_t] = channel("lift")
    images: ImagesEach
    reads: ReadsEach[odometry_t]
    writes: WritesEach[odometry_t]
    commands_each: CommandsEach[order_t]
    sends_each: SendsEach[order_t]
    serves_each: ServesEach[question_t, reply_t]
    calls_each: CallsEach[question_t, reply_t]


class Sender(Component):
    stage = "think"
    lift: Sends[order_t]

    def init(self) -> None:
        self.future: Future[Any] | None = None

    def loop(self) -> None:
        self.future = self.future or self.lift.send()


def test_former_names_declare_the_same_ports() -> None:
    assert declaration(Before).ports == declaration(Now).ports


def test_a_command_is_sent_by_its_former_method() -> None:
    bench = Bench(Sender)
    bench.iterate(2)
    bench.owner_of("lift").answer()
    bench.iterate()
    assert isinstance(bench.component.future, Call)
    assert bench.component.future.done
    assert len(bench.lift.sent) == 1
