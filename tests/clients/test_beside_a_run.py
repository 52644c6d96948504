"""Programs with LCM's default settings hear every message of a run that makes hundreds visible at once."""

import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import pytest

from fwk.lcm.event_log import LogReader
from tests.clients.bus import Bus, process, wait_until
from tests.clients.lcm_spy import Table, lcm_spy, read_table, screen
from tests.harness.components import sources
from tests.harness.runs import Launched, PortBlock, write_files

pytestmark = pytest.mark.system

LAUNCH = """
name: burst
period_s: 0.05
public_url: {url}
components:
  a/burst: {{use: "burst:Burst"}}
"""
TICKS = 60
MESSAGES = 200 * TICKS
SPEEDS = ("1", "max")
ATTEMPTS = 3
SUBSCRIBER = Path(__file__).parent / "subscriber.py"


def burst(folder: Path, ports: PortBlock, speed: str) -> bool:
    """Runs to its end a component that writes 200 messages in each tick; returns whether the listener kept up.

    A listener that gets no processor for seconds may lack messages, and the run says so.
    """
    write_files(folder, {**sources("burst.py"), "burst.yaml": LAUNCH.format(url=ports.public_url)})
    options = ("burst.yaml", "--ticks", str(TICKS), "--speed", speed, "--record", "log.lcm")
    run = Launched(folder, ports, options, {})
    try:
        assert run.wait() == 0, run.text
    finally:
        run.end()
    return "does not keep up" not in run.text


def attempts(folder: Path) -> Iterator[Path]:
    """Yields a folder for each attempt; a machine on which no listener keeps up fails the test."""
    for attempt in range(ATTEMPTS):
        (folder / str(attempt)).mkdir()
        yield folder / str(attempt)
    pytest.fail(f"the listener did not keep up in {ATTEMPTS} runs")


def default_bus(ports: PortBlock) -> Bus:
    """The public bus as a program with default settings opens it: with the system's small receive buffer."""
    return Bus(ports.public_url.replace("&recv_buf_size=4194304", ""))


@pytest.mark.parametrize("speed", SPEEDS)
def test_lcm_logger_hears_every_message(tmp_path: Path, ports: PortBlock, speed: str) -> None:
    for folder in attempts(tmp_path):
        with default_bus(ports).logger(folder / "heard"):
            kept_up = burst(folder, ports, speed)
        recorded, heard = (_notes(folder / name) for name in ("log.lcm", "heard"))
        if kept_up:
            break
    assert len(recorded) == MESSAGES
    assert heard == recorded


@pytest.mark.parametrize("speed", SPEEDS)
def test_python_subscriber_hears_every_message(tmp_path: Path, ports: PortBlock, speed: str) -> None:
    bus = default_bus(ports)
    for folder in attempts(tmp_path):
        answer, texts = folder / "answer", [""]
        with process([sys.executable, str(SUBSCRIBER), bus.url, str(answer)]):
            bus.publish_until(answer.exists)
            kept_up = burst(folder, ports, speed)
            bus.publish_until(partial(_heard_end, answer, texts), b"end")
        if kept_up:
            break
    assert texts[-1] == f"end {MESSAGES}"


def test_lcm_spy_hears_every_message(tmp_path: Path, needs: Callable[..., None], ports: PortBlock) -> None:
    needs("java", "javac", "Xvfb")
    bus = default_bus(ports)
    with screen() as display:
        for folder in attempts(tmp_path):
            with lcm_spy(bus, display, folder) as seen:
                for runs, speed in enumerate(SPEEDS, 1):
                    if not burst(folder, ports, speed):
                        break
                    wait_until(partial(_counted, seen, runs * MESSAGES), f"lcm-spy lacks messages at speed {speed}")
                else:
                    return


def _counted(seen: Path, messages: int) -> bool:
    return count(read_table(seen)) == str(messages)


def count(table: Table) -> str:
    """Returns how many messages of the burst lcm-spy has counted."""
    return table.get("a/note", {}).get("Num Msgs", "0")


def _notes(log: Path) -> list[bytes]:
    return [event.data for event in LogReader(log) if event.channel == "a/note"]


def _heard_end(file: Path, texts: list[str]) -> bool:
    texts.append(file.read_text())
    return texts[-1].startswith("end ")
