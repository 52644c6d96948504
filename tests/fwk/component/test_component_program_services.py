"""Services of a program: requests and answers by number, in JSON and as LCM messages."""

import json
import re
import sys
from typing import Any

import pytest

from fwk.component.child_process import ProgramError
from fwk.lcm.type_registry import use_types_of
from fwk.testing import Bench, program_bench
from lcmtypes.core import answer_t
from tests.harness.components import sources
from tests.harness.runs import write_files

TYPES = ("walk.ask_t", "walk.told_t")
SCRIPT = """
import json, sys
answers = iter({answers!r})
for line in sys.stdin:
    sys.stderr.write(line)
    stage = json.loads(line)["stage"]
    print(json.dumps(next(answers, {{}}) if stage == "think" else {{}}), flush=True)
"""


@pytest.fixture(autouse=True)
def _types(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path_factory.mktemp("walk")
    write_files(folder, sources("lcmtypes/walk.lcm"))
    monkeypatch.setattr(sys, "path", [*sys.path])
    use_types_of(folder)
    monkeypatch.setenv("PYTHONPATH", str(folder))


def bench_of(*answers: dict[str, Any]) -> Bench:
    """A program that offers `ask` and uses `other`, and gives these answers one after the other."""
    command = [sys.executable, "-c", SCRIPT.format(answers=answers)]
    return program_bench(command, serves={"ask": TYPES}, calls={"other": TYPES})


def lines(text: str) -> list[dict[str, Any]]:
    """Returns the inputs of the iterations."""
    asked = [json.loads(line) for line in text.splitlines()]
    return [each["inputs"] for each in asked if each["stage"] == "think"]


def told(bench: Bench) -> list[tuple[int, int, str, float]]:
    return [(each.answer.sequence, each.answer.state, each.answer.reason, each.x) for each in bench.ask.sent]


def test_a_program_answers_requests(capfd: pytest.CaptureFixture[str]) -> None:
    bench = bench_of(
        {"ask": [{"id": 2, "reply": {"x": 2.5}}, {"id": 1, "state": "accepted"}]},
        {"ask": {"id": 1, "state": "failed", "reason": "too far"}},
    )
    bench.ask.put(x=1.0)
    bench.ask.put(x=2.0)
    bench.iterate()
    bench.ask.put(x=3.0)
    bench.iterate()
    bench.finalize()
    assert told(bench) == [
        (2, answer_t.DONE, "", 2.5),
        (1, answer_t.ACCEPTED, "", 0.0),
        (1, answer_t.FAILED, "too far", 0.0),
        (3, answer_t.FAILED, "robot/component was stopped", 0.0),
    ]
    first, second = lines(capfd.readouterr().err)
    assert [(each["id"], each["sender"], each["request"]["x"]) for each in first["ask"]] == [
        (1, "test/sender", 1.0),
        (2, "test/sender", 2.0),
    ]
    assert [each["id"] for each in second["ask"]] == [3]


def test_a_program_calls_and_follows_its_calls(capfd: pytest.CaptureFixture[str]) -> None:
    bench = bench_of({"other": [{"x": 1.0}, {"x": 2.0}]}, {}, {})
    bench.iterate()
    assert [each.x for each in bench.other.sent] == [1.0, 2.0]
    owner = bench.owner_of("other")
    owner.answer(answer_t.REJECTED, "busy", sequence=1)
    owner.answer(answer_t.ACCEPTED, sequence=2)
    bench.iterate()
    owner.answer(answer_t.DONE, sequence=2, x=7.0)
    bench.iterate()
    bench.iterate()
    bench.finalize()
    _, second, third, fourth = lines(capfd.readouterr().err)
    assert second["other"] == [
        {"id": 1, "state": "rejected", "reason": "busy"},
        {"id": 2, "state": "accepted", "reason": ""},
    ]
    assert [(each["id"], each["state"], each["reply"]["x"]) for each in third["other"]] == [(2, "done", 7.0)]
    assert fourth == {}


@pytest.mark.parametrize(
    ("answer", "reason"),
    [
        ({"ask": {"id": 7}}, "'ask' of the answer: no open request 7; open are: 1"),
        ({"ask": {"id": 1, "state": "late"}}, "an answer to a request is {"),
        ({"ask": {"id": "1"}}, "an answer to a request is {"),
        ({"ask": {"id": 1, "x": 2}}, "'x' is not id, state, reason or reply"),
        ({"ask": {"id": 1, "reply": {"y": 2}}}, "walk.told_t has no field 'y'"),
        ({"ask": {"id": 1, "reply": 3}}, "the reply in 'ask' is '3'; it should be an object"),
        ({"ask": [{"id": 1, "state": "accepted"}] * 2}, "request 1 of test/sender is already accepted"),
        ({"other": {"y": 1}}, "walk.ask_t has no field 'y'"),
        ({"other": 1}, "it should be a message as an object"),
    ],
)
def test_wrong_answers_are_named(answer: dict[str, Any], reason: str) -> None:
    bench = bench_of(answer)
    bench.ask.put(x=1.0)
    with pytest.raises(ProgramError, match=re.escape(reason)):
        bench.iterate()


def test_services_of_a_program_in_c_are_messages() -> None:
    bench = program_bench([sys.executable, "-c", NATIVE], serves={"ask": TYPES}, calls={"other": TYPES}, coding="lcm")
    bench.ask.put(x=4.0)
    bench.iterate()
    bench.owner_of("other").answer(answer_t.DONE, x=0.5)
    bench.iterate()
    bench.iterate()
    bench.finalize()
    assert told(bench) == [(1, answer_t.DONE, "", 8.0)]
    assert [each.x for each in bench.other.sent] == [3.0, 0.5]


NATIVE = """
import struct, sys
from lcmtypes.core import answer_t
from tests.harness.components import sources
from tests.harness.runs import write_files
from lcmtypes.walk import ask_t, told_t
i, o = sys.stdin.buffer, sys.stdout.buffer
while head := i.read(36):
    length, kind, tick, time_us, period_us, count = struct.unpack(">IIqqqI", head)
    made = []
    for _ in range(count):
        number, size = struct.unpack(">II", i.read(8))
        data = i.read(size)
        if kind == 1 and number == 0:
            asked, reply = ask_t.decode(data), told_t()
            reply.x, reply.answer.state, reply.answer.sequence = 2 * asked.x, answer_t.DONE, asked.header.sequence
            made.append((0, reply.encode()))
        elif kind == 1:
            again = ask_t()
            again.x = told_t.decode(data).x
            made.append((1, again.encode()))
    if tick == 1 and kind == 1:
        call = ask_t()
        call.x = 3.0
        made.append((1, call.encode()))
    body = b"".join(struct.pack(">II", number, len(data)) + data for number, data in made)
    o.write(struct.pack(">II", 4 + len(body), len(made)) + body)
    o.flush()
"""
