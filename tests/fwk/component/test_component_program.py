"""A component that is a program: requests, answers, settings, and every way in which a program fails."""

import json
import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import psutil
import pytest

from fwk.component import program
from fwk.component.child_process import ANSWER_BYTES_MAX, ChildProcess, ProgramError, find_words, missing_program
from fwk.component.program import Program, ProgramConfig
from fwk.component.program_coding import JsonLines, LcmFrames
from fwk.lcm.messages import encode
from fwk.testing import Bench, program_bench
from lcmtypes.robot import motor_command_t

ECHO = """
import json, sys
for line in sys.stdin:
    asked = json.loads(line)
    moved = [each["x_m"] for each in asked["inputs"].get("odometry", ())]
    print(json.dumps({"motor": {"vx_m_s": sum(moved), "enabled": asked["stage"] == "final"}}), flush=True)
"""


def bench_of(*command: str, **settings: Any) -> Bench:
    return program_bench(command, {"odometry": "robot.odometry_t"}, {"motor": "robot.motor_command_t"}, **settings)


def shell(answer: str) -> tuple[str, ...]:
    """Returns a program that answers the first request with `{}` and then does something else."""
    return "sh", "-c", f"read first; echo '{{}}'; read second; {answer}"


@pytest.fixture(autouse=True)
def no_program_is_left() -> Iterator[None]:
    yield
    assert [each.cmdline() for each in psutil.Process().children() if each.name() in ("sh", "sleep")] == []


def test_program_gets_inputs_and_answers_with_messages() -> None:
    bench = bench_of(sys.executable, "-c", ECHO)
    for x_m in (1.0, 2.0):
        bench.odometry.put(x_m=x_m)
    bench.iterate()
    bench.iterate()
    bench.odometry.put(x_m=4.0)
    bench.iterate()
    bench.finalize()
    sent = [(each.vx_m_s, each.enabled) for each in bench.motor.sent]
    assert sent == [(0, False), (3, False), (0, False), (4, False), (0, True)]
    assert bench.motor.sent[1].header.writer == "robot/component"
    with pytest.raises(ProcessLookupError):
        os.kill(bench.component._child.pid, 0)


def test_first_line_tells_name_ports_and_settings(tmp_path: Path) -> None:
    heard = tmp_path / "heard"
    bench = bench_of("sh", "-c", f"while read line; do echo \"$line\" >> {heard}; echo '{{}}'; done", settings={"a": 1})
    bench.iterate()
    config = bench.component.config.model_dump()
    bench.runner.configure({**config, "settings": {"a": 2}})
    bench.iterate()
    bench.finalize()
    first, tick, changed, last = map(json.loads, heard.read_text().splitlines())
    assert first == {
        "tick": 0, "stage": "init", "time_us": 0, "inputs": {}, "name": "robot/component", "period_s": 0.05,
        "settings": {"a": 1}, "reads": ["odometry"], "writes": ["motor"],
    }  # fmt: skip
    assert tick == {"tick": 1, "stage": "think", "time_us": 50_000, "inputs": {}}
    assert changed["settings"] == {"a": 2}
    assert (last["stage"], "settings" in last) == ("final", False)


def test_period_is_the_time_between_two_iterations(tmp_path: Path) -> None:
    heard = tmp_path / "heard"
    bench = bench_of("sh", "-c", f"while read line; do echo \"$line\" >> {heard}; echo '{{}}'; done", every=4)
    bench.iterate(4)
    bench.finalize()
    first, tick, _ = map(json.loads, heard.read_text().splitlines())
    assert (first["period_s"], tick["tick"]) == (0.2, 4)


@pytest.mark.parametrize(
    ("answer", "reason"),
    [
        ("exit 3", "ended with exit code 3 and without an answer"),
        ("kill -9 $$", "was killed by signal 9"),
        ("exec >&- <&-; sleep 30", "has closed its standard streams without an answer"),
        ("echo hello", "the answer 'hello' is not a JSON object such as {}"),
        ("echo '[1]'", "the answer '[1]' is not a JSON object"),
        ("echo '{\"engine\": {}}'", "the answer has the port 'engine'; the program writes motor"),
        ("echo '{\"motor\": 3}'", "'motor' of the answer is '3'; it should be a message as an object"),
        ('echo \'{"motor": {"vx": 1}}\'', "robot.motor_command_t has no field 'vx'"),
        ('echo \'{"motor": {"vx_m_s": "a"}}\'', "vx_m_s is 'a', not a"),
        ("printf '{}\\n{}\\n'; sleep 30", "answers with more than one answer: b'{}\\n'"),
        ("sleep 30", "gave no answer within 0.2 s"),
        ("head -c 70000000 /dev/zero; sleep 30", f"answers with more than {ANSWER_BYTES_MAX >> 20} MiB"),
    ],
)
def test_failures_are_named_and_leave_no_program(answer: str, reason: str) -> None:
    bench = bench_of(*shell(answer), answer_timeout_s=0.2 if "within" in reason else None)
    with pytest.raises((ProgramError), match=re.escape(reason)):
        bench.iterate()
    assert bench.motor.sent == []
    with pytest.raises(ProcessLookupError):
        os.kill(bench.component._child.pid, 0)


def test_large_requests_and_answers_cross() -> None:
    both = 300_000
    child = ChildProcess(["sh", "-c", f"head -c {both} /dev/zero | tr '\\0' x; read line; echo; read rest"])
    answer = child.exchange(b"y" * both + b"\n", JsonLines().length_of, 30.0)
    assert answer == b"x" * both + b"\n"
    child.close()


def test_each_byte_of_an_answer_is_searched_once() -> None:
    child, asked = ChildProcess(["sh", "-c", "head -c 300000 /dev/zero; echo; read rest"]), []

    def length_of(begun: bytearray, searched: int) -> int:
        asked.append((searched, len(begun)))
        return JsonLines().length_of(begun, searched)

    child.exchange(b"", length_of, 30.0)
    child.close()
    assert [searched for searched, _ in asked] == [0, *(length for _, length in asked[:-1])]
    assert JsonLines().length_of(bytearray(b"a\nb"), 2) == 0


def test_programs_that_cannot_start_are_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ProgramError, match="'no-such-program -x' cannot be started: there is no such program"):
        bench_of("no-such-program", "-x")
    (tmp_path / "tool").write_text("")
    assert find_words(["./tool", "tool", "./other"], [str(tmp_path)]) == [str(tmp_path / "tool"), "tool", "./other"]
    assert missing_program(["./tool"], [str(tmp_path)]) == f"'./tool' is not executable; type: chmod +x {tmp_path}/tool"
    assert missing_program(["./other"], []).startswith("no program './other' beside the launch file")
    assert missing_program(["sh", "./other"], []) == ""
    (tmp_path / "native").mkdir()
    (tmp_path / "native" / "Makefile").touch()
    monkeypatch.chdir(tmp_path)
    assert missing_program(["native/build/tool"], []).endswith("; it may have to be built: make -C native")


WITH_FILES = """
total=$(cat total 2>/dev/null || echo 0)
x=$(sed -n 's/.*"x_m": \\([0-9]*\\).*/\\1/p' input.json)
total=$((total + ${x:-0}))
echo $total > total
echo "{\\"motor\\": {\\"vx_m_s\\": $total}}" > output.json
"""


def test_a_program_with_files_is_started_for_each_iteration() -> None:
    bench = bench_of("sh", "-c", WITH_FILES, coding="files", settings={"a": 1})
    folder = bench.component._child._folder
    for x_m in (1.0, 20.0):
        bench.odometry.put(x_m=x_m)
        bench.iterate()
    asked = json.loads((folder / "input.json").read_text())
    assert (asked["tick"], asked["stage"], asked["settings"], asked["writes"]) == (2, "think", {"a": 1}, ["motor"])
    bench.iterate()
    bench.finalize()
    assert [each.vx_m_s for each in bench.motor.sent] == [1.0, 21.0, 21.0]
    assert not folder.exists()


@pytest.mark.parametrize(
    ("script", "reason"),
    [
        ("exit 3", "ended with exit code 3"),
        ("true", "ended without a file output.json; {} in it writes no message"),
        ("sleep 30", "gave no answer within 0.2 s"),
        ("echo hello > output.json", "the answer 'hello' is not a JSON object"),
        ("head -c 70000000 /dev/zero > output.json", f"answers with more than {ANSWER_BYTES_MAX >> 20} MiB"),
    ],
)
def test_failures_of_programs_with_files_are_named(script: str, reason: str) -> None:
    bench = bench_of("sh", "-c", script, coding="files", answer_timeout_s=0.2 if "within" in reason else None)
    with pytest.raises(ProgramError, match=re.escape(reason)):
        bench.iterate()
    assert not bench.component._child._folder.exists()


def test_replay_runs_only_programs_called_repeatable() -> None:
    assert Program.unrepeatable(ProgramConfig(command=["a", "b"])) == "it runs the program 'a b'"
    assert Program.unrepeatable(ProgramConfig(command=["a"], repeatable=True)) == ""


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("Other", "has no attribute 'Other'"),
        ("Program(a)", "'a' is not a port"),
        ("Program(a: Reads[no.type_t])", "a: no LCM type 'no.type_t'"),
    ],
)
def test_names_of_classes_that_cannot_be_made(name: str, reason: str) -> None:
    with pytest.raises(AttributeError, match=re.escape(reason)):
        getattr(program, name)
    assert getattr(program, "Program()").__name__ == "Program()"


def test_binary_answers_are_read_and_checked() -> None:
    coding = LcmFrames()
    bench = bench_of("sh", "-c", "while read line; do echo '{}'; done")
    writers = {"motor": bench.component.motor}
    message = motor_command_t(vx_m_s=2.0)
    data = encode(message, "motor")
    part = (0).to_bytes(4, "big") + len(data).to_bytes(4, "big") + data
    whole = (4 + len(part)).to_bytes(4, "big") + (1).to_bytes(4, "big") + part
    assert coding.length_of(bytearray(whole[:7]), 0) == 0
    assert coding.length_of(bytearray(whole[:8]), 7) == len(whole)
    ((port, read),) = coding.answer(whole, writers)
    assert (port, read.vx_m_s) == ("motor", 2.0)
    for broken, reason in (
        (whole[:4] + (2).to_bytes(4, "big") + part, "not of the form"),
        (whole + b"x", "has 1 bytes more"),
        (
            whole.replace((0).to_bytes(4, "big") + len(data).to_bytes(4, "big"), b"\0\0\0\7" + b"\0\0\0\1"),
            "not of the form",
        ),
        (whole[:16] + b"garbage!" + whole[24:], "motor"),
    ):
        with pytest.raises(ProgramError, match=reason):
            coding.answer(broken, writers)
    bench.finalize()
