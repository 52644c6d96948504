"""A public bus for one test, with LCM's own programs on it."""

import signal
import subprocess
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import lcm

from fwk.clock import monotonic_us, sleep_s
from fwk.lcm.event_log import LogReader
from fwk.lcm.typegen import lcm_gen

PROBE = "fwk/probe"
_DEADLINE_S = 60.0  # generous for a busy machine; no test waits that long in normal operation


def program(name: str) -> str:
    """Path of the program itself: the wheel's Python wrapper would leave it behind when killed."""
    return str(lcm_gen().with_name(name))


class Bus:
    """Publishes and listens on a public bus."""

    def __init__(self, url: str) -> None:
        self.url = url
        self._lcm = lcm.LCM(url)

    def play(self, log: Path, *options: str) -> None:
        """Publishes a log with lcm-logplayer, slower than recorded: a receiver that pauses loses nothing for 0.8 s."""
        command = [program("lcm-logplayer"), f"--lcm-url={self.url}", "--speed=0.25", *options, str(log)]
        subprocess.run(command, check=True, capture_output=True, timeout=_DEADLINE_S)

    def publish_until(self, heard: Callable[[], bool], data: bytes = b"probe", channel: str = PROBE) -> None:
        """Publishes messages repeatedly until they take effect, that is, until the other side listens."""

        def asked() -> bool:
            self._lcm.publish(channel, data)
            return heard()

        wait_until(asked, f"no program reacts to '{channel}'")

    @contextmanager
    def logger(self, log: Path) -> Iterator[None]:
        """Runs lcm-logger: it listens inside the block; after the block the file holds everything published in it."""
        with process([program("lcm-logger"), "--flush-interval=20", f"--lcm-url={self.url}", str(log)]):
            self.publish_until(log.exists)
            self.publish_until(lambda: b"probe" in _probes(log))
            yield
            self.publish_until(lambda: b"end" in _probes(log), b"end")


def _probes(log: Path) -> set[bytes]:
    return {event.data for event in LogReader(log) if event.channel == PROBE}


@contextmanager
def process(command: Sequence[str], environment: dict[str, str] | None = None) -> Iterator[subprocess.Popen[str]]:
    """Runs a program for the duration of the block."""
    started = subprocess.Popen(
        command, text=True, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL
    )
    try:
        yield started
    finally:
        started.send_signal(signal.SIGTERM)
        try:
            started.communicate(timeout=10)
        except subprocess.TimeoutExpired:
            started.kill()
            started.communicate()


def wait_until(condition: Callable[[], bool], failure: str) -> None:
    """Waits until another process has made `condition` true."""
    deadline_us = monotonic_us() + round(_DEADLINE_S * 1e6)
    while not condition():
        assert monotonic_us() < deadline_us, failure
        sleep_s(0.05)
