"""Commands and requests: their order, their answers, and execution at most once."""

import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from fwk import Component, Each, Serves, channel
from fwk.component.services import QUEUE_MAX, ServiceError
from fwk.lcm.type_registry import use_types_of
from fwk.testing import Bench, MemorySystem
from lcmtypes.core import acknowledgement_t, answer_t
from tests.harness.runs import write_files
from tests.programs.command_system import command_system


@pytest.fixture(scope="module")
def parts(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """The module of the lifting system."""
    folder = tmp_path_factory.mktemp("lift")
    write_files(folder, command_system(""))
    use_types_of(folder)
    yield import_module("lift_parts")
    sys.path.remove(str(folder))
    del sys.modules["lift_parts"], sys.modules["weather"]


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def lifting(parts: Any, **settings: Any) -> MemorySystem:
    """The whole system; the arguments are settings of the lifter."""
    names = {"r/lifter": parts.Lifter, "r/adder": parts.Adder, "one/worker": parts.Worker, "two/worker": parts.Worker}
    return MemorySystem(names, settings={"r/lifter": settings})


def answers(bench: Bench, attribute: str = "lift") -> list[tuple[int, int, str]]:
    """Returns a component's answers: sequence number, state, reason."""
    return [(sent.answer.sequence, sent.answer.state, sent.answer.reason) for sent in bench.port(attribute).sent]


def test_a_command_is_accepted_and_done(parts: Any) -> None:
    bench = Bench(parts.Lifter)
    bench.port("lift").put(height_m=1.5)
    bench.iterate()
    assert answers(bench) == [(1, answer_t.ACCEPTED, "")]
    assert [(sent.sender, sent.height_m) for sent in bench.port("lifted").sent] == [("test/sender", 1.5)]
    bench.iterate(2)
    assert answers(bench)[1:] == [(1, answer_t.DONE, "")]
    assert bench.component.lift.open == []


def test_impossible_commands_are_rejected_or_fail_with_a_reason(parts: Any) -> None:
    bench = Bench(parts.Lifter)
    bench.port("lift").put(height_m=101.0)
    bench.port("lift").put(height_m=-1.0)
    bench.iterate()
    assert answers(bench) == [(1, answer_t.REJECTED, "too high"), (2, answer_t.FAILED, "there is a floor")]


def test_a_command_that_is_not_taken_waits_and_expires(parts: Any) -> None:
    bench = Bench(parts.Lifter, at_once=1, ticks=3)
    bench.port("lift").put(height_m=1.0)
    bench.port("lift").put(height_m=2.0, expires_s=0.15)  # until tick 3; tick 4 has room for it
    bench.port("lift").put(height_m=3.0, expires_s=0.2)
    bench.iterate(3)
    assert len(bench.component.lift) == 2
    bench.iterate()
    assert [sent.height_m for sent in bench.port("lifted").sent] == [1.0, 3.0]
    assert (2, answer_t.EXPIRED, "it was not begun in time") in answers(bench)
    assert bench.component.lift.expired == 1


def test_waiting_command_can_be_rejected(parts: Any) -> None:
    bench = Bench(parts.Lifter, at_once=1, ticks=9)
    for height_m in (1.0, 2.0, 3.0):
        bench.port("lift").put(height_m=height_m)
    bench.iterate()
    lift = bench.component.lift
    assert [request.value.height_m for request in lift.waiting] == [2.0, 3.0]
    lift.waiting[0].reject("never")
    bench.iterate()
    assert (2, answer_t.REJECTED, "never") in answers(bench)
    assert [request.value.height_m for request in lift.waiting] == [3.0]


def test_a_command_is_answered_once(parts: Any) -> None:
    bench = Bench(parts.Lifter)
    bench.port("lift").put(height_m=1.0)
    bench.iterate()
    (command,) = bench.component.lift.open
    with pytest.raises(ServiceError, match="request 1 of test/sender is already accepted and cannot be accepted"):
        command.accept()
    command.done()
    with pytest.raises(ServiceError, match="robot/lift: request 1 of test/sender is already done and cannot be failed"):
        command.fail("too late")


def test_a_flood_is_rejected_and_nothing_grows(parts: Any) -> None:
    bench = Bench(parts.Lifter, ticks=1000)
    for _ in range(3):
        for _ in range(1000):
            bench.port("lift").put(height_m=1.0)
        bench.iterate()
    lift = bench.component.lift
    assert len(lift) + len(lift.open) == QUEUE_MAX
    assert lift.refused == 3000 - QUEUE_MAX
    full = f"queue full: {QUEUE_MAX} commands of test/sender are not finished"
    assert answers(bench).count((3000, answer_t.REJECTED, full)) == 1


def test_receiver_started_later_ignores_earlier_commands(parts: Any) -> None:
    bench = Bench(parts.Lifter)
    bench.tick = 10
    for _ in range(3):
        bench.port("lift").put(height_m=1.0)
    bench.iterate()
    reason = "robot/component was started after it had been sent"
    assert answers(bench) == [(3, answer_t.FORGOTTEN, reason)]
    assert bench.port("lifted").sent == []
    bench.port("lift").put(height_m=2.0)
    bench.iterate()
    assert [sent.height_m for sent in bench.port("lifted").sent] == [2.0]


@pytest.mark.parametrize(("before", "state"), [(0, answer_t.ACCEPTED), (10, answer_t.FORGOTTEN)])
def test_a_first_iteration_after_tick_1_is_no_later_start(parts: Any, before: int, state: int) -> None:
    """A component that iterates in each third tick takes part from the first one, unless it is started later."""
    bench = Bench(parts.Lifter, every=3)
    bench.tick = before
    bench.port("lift").put(height_m=1.0)
    bench.iterate(3)
    assert [(number, said) for number, said, _ in answers(bench)] == [(1, state)]


def test_the_sender_of_a_lost_command_is_informed(parts: Any) -> None:
    bench = Bench(parts.Lifter)
    lift = bench.port("lift")
    lift.put(height_m=1.0)
    bench.iterate()
    lift.put()
    lift.put()
    lift.waiting = []
    lift.put(height_m=2.0)
    bench.iterate()
    reason = "it did not reach robot/component"
    assert answers(bench)[1:] == [
        (2, answer_t.FAILED, reason),
        (3, answer_t.FAILED, reason),
        (4, answer_t.ACCEPTED, ""),
    ]


def test_a_stopped_component_fails_its_unfinished_commands(parts: Any) -> None:
    bench = Bench(parts.Lifter, at_once=1)
    bench.port("lift").put(height_m=1.0)
    bench.port("lift").put(height_m=2.0)
    bench.iterate()
    bench.finalize()
    stopped = "robot/component was stopped"
    assert answers(bench)[1:] == [(1, answer_t.FAILED, stopped), (2, answer_t.FAILED, stopped)]
    assert bench.component.lift.open == []


def sender(parts: Any, **settings: Any) -> tuple[Bench, Any]:
    """Returns a worker that has sent one command, and the future of that command."""
    bench = Bench(parts.Worker, name="s/worker", flood=1, **settings)
    bench.iterate()
    future = next(each for each in bench.component.futures if isinstance(each.reply, acknowledgement_t))
    assert (future.state, future.finished, future.done) == ("sent", False, False)
    return bench, future


def test_a_future_follows_its_command(parts: Any) -> None:
    bench, future = sender(parts)
    bench.owner_of("lift").answer(answer_t.ACCEPTED)
    assert future.state == "sent"  # nothing changes before the next iteration
    bench.iterate()
    assert (future.state, future.finished) == ("accepted", False)
    bench.owner_of("lift").answer(answer_t.FAILED, "stuck", sequence=1)
    bench.iterate()
    assert (future.state, future.reason, future.finished, future.done) == ("failed", "stuck", True, False)
    bench.owner_of("lift").answer(answer_t.DONE, sequence=1)
    bench.iterate()
    assert future.state == "failed"  # no answer follows the last one


@pytest.mark.parametrize("seconds", [float("nan"), float("inf"), -1.0, 1e300])
@pytest.mark.parametrize("name", ["timeout_s", "expires_s"])
def test_an_impossible_time_is_refused(parts: Any, name: str, seconds: float) -> None:
    bench = Bench(parts.Worker, flood=1)
    bench.iterate()
    before = len(bench.port("lift").sent)
    with pytest.raises(ServiceError, match=f"lift: {name} is {seconds}".replace("+", "[+]")):
        bench.component.lift.call(**{name: seconds})
    bench.iterate()
    assert len(bench.port("lift").sent) == before + 1


def test_no_command_is_sent_in_init(parts: Any) -> None:
    class Eager(parts.Worker):  # type: ignore[misc]
        def init(self) -> None:
            self.lift.call()

    with pytest.raises(ServiceError, match=r"lift: robot/component has no time yet in init\(\); call in loop\(\)"):
        Bench(Eager)


def test_answers_to_others_are_not_heard(parts: Any) -> None:
    bench, future = sender(parts)
    owner = bench.owner_of("lift")
    owner._sender = "t/worker"
    owner.answer(sequence=future.sequence)
    bench.iterate()
    assert future.state == "sent"


def test_a_future_ends_in_time(parts: Any) -> None:
    bench, future = sender(parts, timeout_s=0.1)
    assert bench.port("lift").sent[0].command.expires_us == bench.time_us + 100_000  # nor does it begin any more
    bench.iterate(2)
    assert future.state == "sent"
    bench.iterate()
    assert (future.state, future.reason) == ("timed out", "s/lift: was not answered in time")
    bench.owner_of("lift").answer(sequence=future.sequence)
    bench.iterate()
    assert future.state == "timed out"


def test_restart_of_the_owner_fails_all_earlier_commands(parts: Any) -> None:
    bench, first = sender(parts)
    bench.owner_of("lift").answer(answer_t.ACCEPTED)
    bench.iterate()
    second = bench.component.lift.pending[-1]
    bench.iterate()
    third = bench.component.lift.pending[-1]
    bench.owner_of("lift").answer(answer_t.FORGOTTEN, "r/lifter was started", sequence=second.sequence)
    bench.iterate()
    assert [each.state for each in (first, second, third)] == ["failed", "failed", "sent"]
    assert second.reason == "r/lifter was started"


def test_a_flooding_sender_is_held_back(parts: Any) -> None:
    bench = Bench(parts.Worker, flood=QUEUE_MAX + 10)
    bench.iterate(2)
    assert len(bench.port("lift").sent) == QUEUE_MAX
    future = bench.component.futures[-1 if not hasattr(bench.component.futures[-1], "reply") else -2]
    assert (future.state, future.done) == ("rejected", False)
    assert future.reason == f"queue full: {QUEUE_MAX} commands to robot/lift are not finished"


def test_a_request_is_answered_with_a_reply(parts: Any) -> None:
    bench = Bench(parts.Adder)
    bench.port("sum").put(n=2, numbers=[3, 4])
    bench.port("sum").put()
    bench.iterate()
    assert [sent.sum for sent in bench.port("sum").sent] == [7, 0]
    assert answers(bench, "sum") == [(1, answer_t.DONE, ""), (2, answer_t.REJECTED, "nothing to add up")]


def test_a_call_has_its_reply(parts: Any) -> None:
    bench = Bench(parts.Worker)
    while not bench.component.sum.pending:
        bench.iterate()
    (call,) = bench.component.sum.pending
    assert call.reply.sum == 0
    bench.owner_of("sum").answer(sum=12)
    bench.iterate()
    assert call.done
    assert call.reply.sum == 12


def test_one_component_serves_many_and_answers_each(parts: Any) -> None:
    class Crane(Component):
        stage = "act"
        lifts: Each[Serves[parts.lift_t]] = channel("*/lift")
        sums: Each[Serves[parts.sum_request_t, parts.sum_t]] = channel("*/sum")

        def loop(self) -> None:
            for robot, lifts in self.lifts.items():
                for command in lifts:
                    command.reject(f"{robot} is too heavy")
            for number, sums in enumerate(self.sums.values()):
                for request in sums:
                    request.reply.sum = number
                    request.done()

    bench = Bench(Crane, namespaces=("one", "two"))
    bench.port("lifts", "two").put(height_m=1.0)
    bench.port("sums", "two").put()
    bench.iterate()
    assert bench.port("lifts", "one").sent == []
    assert [sent.answer.reason for sent in bench.port("lifts", "two").sent] == ["two is too heavy"]
    assert [sent.sum for sent in bench.port("sums", "two").sent] == [1]


def test_all_commands_run_once_and_in_order(parts: Any) -> None:
    system = lifting(parts, at_once=3, ticks=1)
    system.tick(200)
    begun, wanted = [], {}
    for name in ("one/worker", "two/worker"):
        for data in system.sent[f"r/lift@{name}"]:
            message = parts.lift_t.decode(data)
            wanted[name, message.header.sequence] = message
    for data in system.sent["r/lifted"]:
        message = parts.lifted_t.decode(data)
        begun.append((message.sender, message.sequence))
        assert wanted[begun[-1]].height_m == message.height_m
    assert len(begun) == len(set(begun)) > 100
    order = [(wanted[each].header.tick, each[0], each[1]) for each in begun]
    assert order == sorted(order)
    for name in ("one", "two"):
        tally = system.newest(f"{name}/tally")
        assert tally.sent > tally.ended > tally.done > 100
        assert tally.sum > 0
        assert {reason.partition(":")[0] for reason in tally.reasons} <= {"failed", "rejected", "timed out", "expired"}
        assert "rejected: nothing to add up" in tally.reasons
        assert "failed: there is a floor" in tally.reasons
