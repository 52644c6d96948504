"""Real processes that log and print too much, at other levels, to other targets, and that fail in unusual places."""

import json
import re
import socket
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from fwk.logs.reader import read_lines
from tests.harness.components import sources
from tests.harness.logs import Recording
from tests.harness.runs import Launched, PortBlock, write_files
from tests.programs.control_system import Steered

pytestmark = pytest.mark.system

LAUNCH = """
public_url: {url}
speed: max
log: {log}
components:
  a/talker: {{use: "talker:Talker", restart: {{when: never}}, config: {config}}}
  b/talker: {{use: "talker:Talker"}}
"""


@pytest.fixture
def talk(tmp_path: Path, ports: PortBlock, launch: Callable[..., Launched]) -> Callable[..., Launched]:
    def start(*arguments: str, log: dict[str, Any] | None = None, **config: Any) -> Launched:
        text = LAUNCH.format(url=ports.public_url, log=json.dumps(log or {}), config=json.dumps(config))
        write_files(tmp_path, {**sources("talker.py"), **sources("thinking.py"), "talk.yaml": text})
        return launch("talk.yaml", *arguments)

    return start


def lines_of(run: Launched, component: str = "a/talker") -> list[dict[str, Any]]:
    return [line for line in read_lines(run.run_dir / "fwk.log.jsonl") if line["component"] == component]


def test_a_flood_of_lines_is_cut_off_and_no_error_is_lost(talk: Callable[..., Launched]) -> None:
    run = talk("--ticks", "200", lines=20_000, log={"lines_per_s": 50})
    assert run.wait() == 0, run.text
    lines = lines_of(run)
    errors = [line["text"] for line in lines if line["level"] == "error"]
    assert errors == [f"error {number}" for number in range(0, 20_000, 100)]
    told = [line for line in lines if "lines dropped in the last second" in line["text"]]
    dropped = sum(int(line["text"].split()[0]) for line in told)
    chatter = sum(line["text"].startswith("chatter") for line in lines)
    assert chatter + dropped == 20_000
    assert dropped > 10_000
    assert {line["file"] for line in told} == {"talker.py"}


def test_printing_too_much_is_counted_and_delays_no_component(talk: Callable[..., Launched]) -> None:
    run = talk("--ticks", "50", printed=100_000, log={"lines_per_s": 50})
    assert run.wait() == 0, run.text
    printed = [line for line in lines_of(run) if line["file"] == "stdout"]
    dropped = [int(line["text"].split()[0]) for line in printed if "lines dropped" in line["text"]]
    shown = [line for line in printed if line["text"].startswith("printed")]
    assert len(shown) + sum(dropped) == 100_000
    assert [line["line"] for line in shown] == [int(line["text"].split()[1]) + 1 for line in shown]
    errors = [line["text"] for line in lines_of(run) if line["file"] == "stderr"]
    assert errors == ["to the other stream", "\\xfe no text"]


def test_a_line_without_an_end_is_logged_during_the_run(talk: Callable[..., Launched]) -> None:
    run = talk("--speed", "1", asks=True)
    run.until("a/talker: how much?  (stdout:1)")


def test_long_lines_keep_their_ends(talk: Callable[..., Launched]) -> None:
    run = talk("--ticks", "5", long=300_000)
    assert run.wait() == 0, run.text
    (line,) = [line for line in lines_of(run) if line["level"] == "warning"]
    assert "284000 characters left out" in line["text"]


def test_exceptions_have_traceback_component_and_tick(talk: Callable[..., Launched]) -> None:
    run = talk("--ticks", "50", thread=True, fails_at=7)
    assert run.wait() == 1, run.text
    thread, failure = [line for line in lines_of(run) if line["level"] == "error"]
    assert (thread["tick"], thread["file"]) == (3, "talker.py")
    assert thread["text"].startswith("thread aside ends with an uncaught exception\nTraceback")
    assert thread["text"].endswith("ZeroDivisionError: division by zero")
    assert (failure["tick"], failure["file"]) == (7, "talker.py")
    assert re.match("failed in loop, tick 7\nTraceback (.|\n)*RuntimeError: not this tick$", failure["text"])


def test_lines_carry_the_tick_in_which_they_were_written(
    talk: Callable[..., Launched],
) -> None:
    run = talk("--ticks", "50", "--set", "b/talker.leaves_at=7")
    assert run.wait() == 0, run.text
    assert [line["tick"] for line in lines_of(run, "b/talker") if line["text"] == "begins"] == [0, 7]
    times = {line["text"]: (line["tick"], line["time_us"]) for line in lines_of(run, "supervisor")}
    assert times["b/talker ended: exit code 3; restart in 0.1 s"] == (7, 350_000)
    assert times["b/talker runs again, incarnation 2"] == (7, 350_000)


@pytest.mark.parametrize("hosting", ["process", "single"])
def test_lines_of_plain_modules_belong_to_the_calling_component(talk: Callable[..., Launched], hosting: str) -> None:
    run = talk(
        "--ticks", "5", "--hosting", hosting, "--set", "b/*.thinks=true", "--set", "b/*.log_level=debug", thinks=True
    )
    assert run.wait() == 0, run.text

    def said(component: str) -> list[tuple[str, int, int, str]]:
        ours = [line for line in lines_of(run, component) if line["file"] == "thinking.py"]
        return [(line["level"], line["tick"], line["line"], line["text"].partition("\n")[0]) for line in ours]

    a = [("warning", 3, 10, "tick 3 is odd"), ("error", 3, 15, "cannot divide")]
    assert said("a/talker") == a
    assert said("b/talker") == [("debug", 3, 9, "nothing much"), *a]
    assert any(line["text"].endswith("ZeroDivisionError: division by zero") for line in lines_of(run))


def test_log_levels_and_targets_change_no_message(talk: Callable[..., Launched], tmp_path: Path) -> None:
    targets = {"console": "error", "file": "off", "recording": "warning", "file_mb": 0.05, "files": 2, "lines_per_s": 0}
    run = talk("--ticks", "500", "--set", "b/*.log_level=debug", "--record", "loud.log", log=targets)
    assert run.wait() == 0, run.text
    assert "in tick" not in run.text
    assert not list(run.run_dir.glob("fwk.log"))
    kept = sorted(path.name for path in run.run_dir.glob("fwk.log*"))
    assert kept == ["fwk.log.jsonl", "fwk.log.jsonl.1"]
    assert [line["tick"] for line in lines_of(run, "b/talker")][-100:] == list(range(401, 501))
    assert not lines_of(run, "a/talker")
    quiet = talk("--ticks", "500", "--record", "quiet.log")
    assert quiet.wait() == 0, quiet.text
    loud_heading, quiet_heading = (
        [imu.heading_rad for imu in Recording(tmp_path / name).decoded("b/imu")] for name in ("loud.log", "quiet.log")
    )
    assert loud_heading == quiet_heading
    assert len(loud_heading) == 500


def test_syslog_gets_logged_and_printed_lines(tmp_path: Path, talk: Callable[..., Launched]) -> None:
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as daemon:
        daemon.bind(str(tmp_path / "log"))
        daemon.setblocking(False)
        run = talk("--ticks", "5", lines=1, printed=1, log={"syslog": "info", "syslog_to": str(tmp_path / "log")})
        assert run.wait() == 0
        heard = []
        with suppress(BlockingIOError):
            while True:
                heard.append(daemon.recv(9000).decode())
    for text in ("a/talker tick 3: chatter 0", "printed 0", "to the other stream"):
        assert any(text in each for each in heard), text


def test_a_log_level_changes_during_the_run(talk: Callable[..., Launched], ports: PortBlock) -> None:
    steered = Steered(talk("--speed", "1"), ports)
    said = steered.json("config", "set", "b/talker.log_level=debug")
    steered.ticks_pass()
    (first, *_) = steered.fwk("log", "--component", "b/talker", "--json").splitlines()
    assert json.loads(first)["tick"] == said["tick"]
    assert json.loads(first)["level"] == "debug"
    assert "it should be 'debug', 'info', 'warning' or 'error'" in steered.fwk(
        "config", "set", "b/talker.log_level=loud", code=2
    )
    recorded = steered.end()
    assert "equal: " in steered.fwk("replay", "--verify", str(recorded.parent))
