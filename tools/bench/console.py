"""Measures how much the web console slows a run down: python -m tools.bench.console [--pairs 10] [--seconds 3].

One run at the highest speed, and a console with two pages open in a headless Chromium. In each pair of windows the
console works in one and is stopped (SIGSTOP) in the other, in turns first and second, so that both halves of a pair see
the same match and the same machine. The browser runs with the lowest priority, as if it were on another machine: the
ratios are the price of the console, not of drawing on this screen.
"""

import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Annotated

import typer
from playwright.sync_api import Page, sync_playwright

from fwk.control.address import supervisor_address
from fwk.control.client import Client, ControlError
from tools.bench import accounting
from tools.bench.driver import RunFailedError
from tools.bench.environments import REPOSITORY
from tools.bench.timing import now_us, sleep_s

CHROMIUM = "chromium-headless-shell"
MOST = 1.05
"""Greatest ratio that the console may cost."""
_BUS_PORT = 17_400
_RUN = "bench-console"
_PATIENCE_S = 60.0
_SETTLE_S = 5.0
_LOWEST = 19


@dataclass(frozen=True)
class Window:
    """Ticks, wall time and CPU time of the run's processes in a window of time."""

    ticks: int
    wall_us: float
    cpu_us: float

    @property
    def wall_per_tick_us(self) -> float:
        """Wall time of a tick."""
        return self.wall_us / self.ticks

    @property
    def cpu_per_tick_us(self) -> float:
        """CPU time of a tick: supervisor, gateway and hosts."""
        return self.cpu_us / self.ticks


@dataclass(frozen=True)
class Ratios:
    """Cost of a tick with the console, divided by that without; the medians of all pairs."""

    cpu: float
    wall: float

    @classmethod
    def of(cls, pairs: list[tuple[Window, Window]]) -> "Ratios":
        """Makes the ratios of pairs: with, without."""
        return cls(
            median(beside.cpu_per_tick_us / alone.cpu_per_tick_us for beside, alone in pairs),
            median(beside.wall_per_tick_us / alone.wall_per_tick_us for beside, alone in pairs),
        )


def main(
    pairs: Annotated[int, typer.Option(min=1, help="Number of pairs of windows")] = 10,
    seconds: Annotated[float, typer.Option(min=0.5, help="Length of a window")] = 3.0,
    launch: Annotated[str, typer.Option(help="Launch file")] = "soccer-percepts.yaml",
    speed: Annotated[str, typer.Option(help="Logical seconds per wall second, or max")] = "max",
    pages: Annotated[str, typer.Option(help="Pages of the console that are open")] = "/view,/",
) -> None:
    """Prints the ratios; exit code 1 if the CPU time of a tick grows by more than 5 %."""
    with (
        TemporaryDirectory(prefix="bench-") as home,
        _run(home, launch, speed) as run,
        _console(home) as (console, url),
        _browser(url, pages.split(",")) as opened,
    ):
        sleep_s(_SETTLE_S)
        made = [_pair(run, console, number, seconds) for number in range(pairs)]
        frames = opened[0].locator("canvas").get_attribute("data-frames") if "/view" in pages else ""
    for beside, alone in made:
        print(
            f"CPU {beside.cpu_per_tick_us:8.0f} us a tick with, {alone.cpu_per_tick_us:8.0f} without; "
            f"wall {beside.wall_per_tick_us:8.0f} with, {alone.wall_per_tick_us:8.0f} without"
        )
    found = Ratios.of(made)
    print(f"ratio of CPU {found.cpu:.3f}, of wall time {found.wall:.3f} ({pairs} pairs, {frames} drawings shown)")
    raise typer.Exit(int(found.cpu > MOST))


def _pair(run: int, console: int, number: int, seconds: float) -> tuple[Window, Window]:
    """Returns a window with the console and one without."""
    if number % 2:
        alone = _alone(run, console, seconds)
        return _window(run, seconds), alone
    beside = _window(run, seconds)
    return beside, _alone(run, console, seconds)


def _alone(run: int, console: int, seconds: float) -> Window:
    os.kill(console, signal.SIGSTOP)
    try:
        return _window(run, seconds)
    finally:
        os.kill(console, signal.SIGCONT)


def _window(run: int, seconds: float) -> Window:
    pids = [run, *accounting.descendants(run)]
    tick, began_us, used = _tick(), now_us(), accounting.usage(pids)
    sleep_s(seconds)
    ticks, wall_us, cpu_us = _tick() - tick, now_us() - began_us, (accounting.usage(pids) - used).cpu_us
    if ticks <= 0:
        raise RunFailedError(f"no tick in {seconds} s")
    return Window(ticks, wall_us, cpu_us)


def _tick() -> int:
    with Client(supervisor_address(_BUS_PORT)) as run:
        return int(run.ask("speed")["tick"])


@contextmanager
def _run(home: str, launch: str, speed: str) -> Iterator[int]:
    """Starts the run; yields the process id of its supervisor."""
    words = ["fwk-launch", launch, "--run", _RUN, "--bus-port", str(_BUS_PORT), "--speed", speed, "--no-record"]
    with _program(home, [*words, "--plain"]) as (process, output):
        end_us = now_us() + _PATIENCE_S * 1e6
        while True:
            if process.poll() is not None or now_us() > end_us:
                raise RunFailedError(f"the run did not start: {output.read_text(errors='replace')[-800:]}")
            try:
                if _tick() > 0:
                    break
            except ControlError:
                sleep_s(0.1)
        yield process.pid


@contextmanager
def _console(home: str) -> Iterator[tuple[int, str]]:
    """Starts the console; yields its process id and its address."""
    with _program(home, ["fwk", "web", "--run", _RUN, "--port", "0"]) as (process, output):
        end_us = now_us() + _PATIENCE_S * 1e6
        while not (found := re.search(r"http://\S+?(?=/\s)", output.read_text(errors="replace"))):
            if process.poll() is not None or now_us() > end_us:
                raise RunFailedError(f"the console did not start: {output.read_text(errors='replace')}")
            sleep_s(0.1)
        yield process.pid, found[0]


@contextmanager
def _program(home: str, words: list[str]) -> Iterator[tuple[subprocess.Popen[bytes], Path]]:
    output = Path(home) / f"{words[0]}.txt"
    environment = {**os.environ, "HOME": home, "PYTHONUNBUFFERED": "1"}
    with open(output, "wb") as file:
        program = [str(Path(sys.executable).parent / words[0]), *words[1:]]
        process = subprocess.Popen(program, cwd=REPOSITORY, env=environment, stdout=file, stderr=subprocess.STDOUT)
    try:
        yield process, output
    finally:
        process.send_signal(signal.SIGINT)
        try:
            process.wait(_PATIENCE_S)
        except subprocess.TimeoutExpired:
            process.kill()


@contextmanager
def _browser(url: str, paths: list[str]) -> Iterator[list[Page]]:
    program = shutil.which(CHROMIUM)
    if program is None:
        raise RunFailedError(f"needs {CHROMIUM}: apt install {CHROMIUM}")
    os.nice(_LOWEST)  # every thread of the browser inherits it
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        opened = []
        for path in paths:
            page = browser.new_page(viewport={"width": 1280, "height": 800})
            page.goto(f"{url}{path}?run={_RUN}")
            page.wait_for_function("document.querySelector('[data-name=clock]').innerText.startsWith('tick')")
            opened.append(page)
        yield opened
        browser.close()


if __name__ == "__main__":
    typer.run(main)
