"""Resource use of a component seen from outside: profile, crashes, memory."""

import json
import re
import resource
import signal
from pathlib import Path

import pytest

from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording, difference
from tests.harness.runs import Launched, PortBlock, write_files

pytestmark = pytest.mark.system

LAUNCH = """
name: parts
public_url: {url}
components:
  r/worker: {{use: "glutton:Worker"}}
  r/glutton: {{use: "glutton:Glutton", restart: {{backoff_s: 0.01}}, memory_limit_mb: 60}}
"""


@pytest.fixture
def parts(tmp_path: Path, ports: PortBlock, launch: Launch) -> Launch:
    write_files(tmp_path, {**sources("glutton.py"), "parts.yaml": LAUNCH.format(url=ports.public_url)})

    def started(*arguments: str) -> Launched:
        return launch("parts.yaml", "--speed", "max", "--ticks", "200", *arguments)

    return started


def settings(**values: int) -> list[str]:
    return [word for key, value in values.items() for word in ("--set", f"r/glutton.{key}={value}")]


def log_of(run: Launched) -> str:
    return (run.run_dir / "fwk.log").read_text()


def test_a_profile_names_functions_and_changes_no_message(parts: Launch, tmp_path: Path) -> None:
    few = ("--ticks", "50")
    assert parts("--record", "free.log", *few).wait() == 0
    for hosting in ("process", "robot"):
        run = parts("--record", "profiled.log", "--profile", "r/worker", "--hosting", hosting, *few)
        assert run.wait() == 0, run.text
        assert difference(tmp_path / "free.log", tmp_path / "profiled.log") == ""
        check_profile(run)


def check_profile(run: Launched) -> None:
    text = (run.run_dir / "profile-r-worker.txt").read_text()
    assert f"profile: {run.run_dir / 'profile-r-worker.txt'}" in run.text
    assert "iterations of r/worker" in text
    assert "long_sum" in text
    assert "Glutton" not in text
    page = (run.run_dir / "profile-r-worker.html").read_text()
    assert "<html" in page
    assert "long_sum" in page
    frames = json.loads((run.run_dir / "profile-r-worker.speedscope.json").read_text())["shared"]["frames"]
    assert {"long_sum", "loop"} <= {frame["name"] for frame in frames}


def test_a_profile_of_an_unknown_component_is_refused(parts: Launch) -> None:
    run = parts("--profile", "r/wroker")
    assert run.wait() == 2
    assert "did you mean 'r/worker'?" in " ".join(run.text.replace("│", " ").split())


def test_a_segmentation_fault_leaves_traceback_and_core_dump(parts: Launch, tmp_path: Path) -> None:
    run = parts("--record", "log.lcm", *settings(crash_tick=20))
    assert run.wait() == 0, run.text
    log = log_of(run)
    assert re.search(r"r/glutton stderr:\d+: Fatal Python error: Segmentation fault", log)
    assert "glutton.py" in log.partition("Fatal Python error")[2]
    _, hard = resource.getrlimit(resource.RLIMIT_CORE)
    pattern = Path("/proc/sys/kernel/core_pattern").read_text().strip()
    dumped = ", core dumped" if hard and pattern else ""
    assert f"r/glutton ended: killed by signal {signal.SIGSEGV.value}{dumped}; restart in" in log
    if dumped and pattern == "core":
        assert list(tmp_path.glob("core*"))
    ticks = [header.tick for header in Recording(tmp_path / "log.lcm").headers("r/pose")]
    assert ticks == list(range(1, 201))


@pytest.mark.parametrize("takes", [{"array_mb": 5}, {"objects": 30_000}])
def test_a_component_beyond_its_memory_limit_is_restarted(parts: Launch, tmp_path: Path, takes: dict[str, int]) -> None:
    run = parts("--record", "log.lcm", "--ticks", "60", *settings(**takes))
    assert run.wait() == 0, run.text
    log = log_of(run)
    assert "r/glutton ended: MemoryError: more memory than its memory_limit_mb of 60 (" in log
    said = log.partition("r/glutton ended: MemoryError")[2].splitlines()[0]
    assert "in loop, tick" in said or "in its process" in said, said  # memory may also run out while messages are sent
    assert "; restart in " in log
    assert "r/worker ended" not in log
    ticks = [header.tick for header in Recording(tmp_path / "log.lcm").headers("r/pose")]
    assert ticks == list(range(1, 61))


def test_the_limit_of_a_process_is_the_sum_of_its_components(parts: Launch) -> None:
    run = parts("--ticks", "60", "--hosting", "robot", *settings(array_mb=5))
    assert run.wait() == 0, run.text
    assert "MemoryError" not in log_of(run)  # r/worker has no limit, so their process has none
