"""The console continues in a session of its own with low priority, and ends with its parent."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from tests.harness.runs import pause

PROGRAM = """
import os, signal, sys
from fwk.web import background
from fwk.web.background import continue_in_background, give_way

def told(number, frame):
    os.write(1, signal.Signals(number).name.encode() + b"\\n")
    if "abort" in sys.argv:
        os.abort()
    if number == signal.SIGTERM and "deaf" not in sys.argv:
        os._exit(7)

if "deaf" in sys.argv:
    background._TURNS = 2
continue_in_background()
for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, told)
give_way()
os.write(1, b"%d %d %d %d\\n" % (os.getpid(), os.getsid(0), os.sched_getscheduler(0), os.nice(0)))
while True:
    signal.pause()
"""


class Background:
    """A process that continues in the background."""

    def __init__(self, *words: str) -> None:
        self.parent = subprocess.Popen([sys.executable, "-c", PROGRAM, *words], stdout=subprocess.PIPE, text=True)
        self.pid, self.session, self.policy, self.niceness = map(int, self.line().split())

    def line(self) -> str:
        """Returns the next line of output; empty after the end of all processes."""
        assert self.parent.stdout
        return self.parent.stdout.readline().strip()

    def wait_for_priority(self) -> None:
        """Waits until the session of the child has the usual niceness, and the child the usual policy."""
        autogroup = Path(f"/proc/{self.pid}/autogroup")
        while autogroup.exists() and not autogroup.read_text().endswith("nice 0\n"):
            pause()
        if os.geteuid() == 0:
            assert os.sched_getscheduler(self.pid) == os.SCHED_OTHER


@pytest.fixture
def background(request: pytest.FixtureRequest) -> Iterator[Background]:
    made = Background(*getattr(request, "param", ()))
    yield made
    for pid in (made.parent.pid, made.pid):
        with suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)
    made.parent.wait()
    assert made.parent.stdout
    made.parent.stdout.close()


def test_signals_reach_the_child_and_its_exit_code_is_kept(background: Background) -> None:
    assert background.session == background.pid != background.parent.pid
    assert (background.policy, background.niceness) == (os.SCHED_IDLE, 19)
    assert os.getpriority(os.PRIO_PROCESS, background.parent.pid) == os.getpriority(os.PRIO_PROCESS, 0)
    autogroup = Path(f"/proc/{background.pid}/autogroup")
    assert not autogroup.exists() or autogroup.read_text().endswith("nice 10\n")
    background.parent.send_signal(signal.SIGINT)
    assert background.line() == "SIGINT"
    background.wait_for_priority()
    background.parent.send_signal(signal.SIGTERM)
    assert background.line() == "SIGTERM"
    assert background.parent.wait(120) == 7


@pytest.mark.parametrize("background", [("deaf",)], indirect=True)
def test_a_child_that_does_not_end_is_killed(background: Background) -> None:
    background.parent.send_signal(signal.SIGINT)
    assert background.line() == "SIGINT"
    assert background.parent.wait(120) == 0
    assert background.line() == "", "no process keeps the output open"


@pytest.mark.parametrize("background", [("abort",)], indirect=True)
def test_the_parent_of_a_killed_child_ends_by_its_signal(background: Background) -> None:
    background.parent.send_signal(signal.SIGINT)
    assert background.line() == "SIGINT"
    assert background.parent.wait(120) == -signal.SIGABRT


def test_a_child_ends_with_its_killed_parent(background: Background) -> None:
    background.parent.kill()
    assert background.line() == "SIGTERM", "the kernel ends the child"
    assert background.line() == "", "no process keeps the output open"
