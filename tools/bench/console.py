"""Measures how much the web console slows a run down: python -m tools.bench.console [--pairs 10] [--seconds 3].

One run at the highest speed, and a console with two pages open. In each pair of windows console and browser work in one
window and are stopped (SIGSTOP) in the other, in turns first and second, so that both halves of a pair see the same
match and the same machine. The pairs are measured three times: with no page open; with pages open elsewhere, for which
`tools.bench.distant_browser` stands, a client that takes all that a browser takes and shows nothing; and with the pages
in a headless Chromium on this machine. The processor time of the client is part of each table.
"""

import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Annotated

import typer
from playwright.sync_api import Page, sync_playwright

from fwk.cli import arguments
from fwk.control.address import supervisor_address
from fwk.control.client import Client, ControlError
from fwk.plan.load import load_plan
from fwk.web.background import continue_in_background
from tools.bench import accounting, program
from tools.bench.driver import RunFailedError
from tools.bench.environments import REPOSITORY
from tools.bench.timing import now_us, sleep_s

CHROMIUM = "chromium-headless-shell"
MOST = 1.05
"""Greatest ratio that the console may cost."""
_BUS_PORT = 18_800
_RUN = "bench-console"
_PATIENCE_S = 180.0
_SETTLE_S = 5.0
_OPEN, _DRAWING = "open", "drawing"
"""Words that the distant browser prints for each page and for each drawing."""


Drawings = Callable[[], int]
"""Returns how many drawings the open pages have got so far."""


@dataclass(frozen=True)
class Window:
    """Ticks, wall time and CPU times in a window of time."""

    ticks: int
    wall_us: float
    cpu_us: float
    """Supervisor, gateway and hosts."""
    console_us: float = 0.0
    browser_us: float = 0.0

    @property
    def wall_per_tick_us(self) -> float:
        """Wall time of a tick."""
        return self.wall_us / self.ticks

    @property
    def cpu_per_tick_us(self) -> float:
        """CPU time of the run in a tick."""
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


@dataclass(frozen=True)
class Processes:
    """The processes that are measured."""

    run: int
    """The supervisor."""
    console: int
    """The process that serves."""
    browser: list[int]
    """The processes that have the pages open."""

    def signal(self, number: signal.Signals) -> None:
        """Signals console and browser."""
        for pid in (self.console, *self.browser):
            with suppress(ProcessLookupError):
                os.kill(pid, number)


def _pace(text: str) -> str:
    """Refuses what is not a pace."""
    arguments.speed(text)
    return text


def main(
    pairs: Annotated[int, typer.Option(min=1, help="Number of pairs of windows")] = 10,
    seconds: Annotated[float, typer.Option(min=0.5, max=3600.0, help="Length of a window")] = 3.0,
    launch: Annotated[str, typer.Option(help="Launch file")] = "soccer-percepts.yaml",
    speed: Annotated[str, typer.Option(callback=_pace, help="Logical seconds per wall second, or max")] = "max",
    pages: Annotated[str, typer.Option(help="Pages of the console that are open")] = "/view,/",
) -> None:
    """Prints the ratios; exit code 1 if the CPU time of a tick grows by more than 5 %, or, with no page open here, wall
    time.
    """
    load_plan(launch)  # names the mistakes of the launch file
    continue_in_background()  # in a session of its own, whose niceness the terminal does not inherit
    with (
        TemporaryDirectory(prefix="bench-") as home,
        _run(home, launch, speed) as run,
        _console(home) as (console, url),
    ):
        paths = pages.split(",")
        urls = [f"{url}{path}?run={_RUN}" for path in paths]
        clients: dict[str, Callable[[], AbstractContextManager[Drawings]]] = {
            "no page": lambda: nullcontext(lambda: 0),
            "browser elsewhere": lambda: _distant_browser(home, urls),
            "browser on this machine": lambda: _browser(urls),
        }
        worst = 0.0
        for place, client in clients.items():
            before = {os.getpid(), *accounting.descendants(os.getpid())}
            with client() as drawings:
                sleep_s(_SETTLE_S)
                opened = [pid for pid in accounting.descendants(os.getpid()) if pid not in before]
                processes = Processes(run, console, opened)
                began = drawings()
                made = [_pair(processes, number, seconds) for number in range(pairs)]
                found = _report(place, made, drawings() - began)
                worst = max(worst, found.cpu, 0.0 if place == "browser on this machine" else found.wall)
    raise typer.Exit(int(worst > MOST))


def _report(place: str, made: list[tuple[Window, Window]], drawings: int) -> Ratios:
    print(f"{place}:")
    for beside, alone in made:
        print(
            f"  run: CPU {beside.cpu_per_tick_us:6.0f} us a tick with, {alone.cpu_per_tick_us:6.0f} without; "
            f"wall {beside.wall_per_tick_us:6.0f} with, {alone.wall_per_tick_us:6.0f} without"
        )
    found = Ratios.of(made)
    wall_us = sum(beside.wall_us for beside, _ in made)
    shares = (
        f"{name} {sum(getattr(beside, field) for beside, _ in made) / wall_us:.0%}"
        for name, field in (("run", "cpu_us"), ("console", "console_us"), ("pages", "browser_us"))
    )
    print(f"  processor time, of one processor: {', '.join(shares)}; {drawings * 1e6 / wall_us:.1f} drawings a second")
    print(f"  ratio of CPU {found.cpu:.3f}, of wall time {found.wall:.3f} ({len(made)} pairs)")
    return found


def _pair(processes: Processes, number: int, seconds: float) -> tuple[Window, Window]:
    """Returns a window with the console and one without."""
    if number % 2:
        alone = _alone(processes, seconds)
        return _window(processes, seconds), alone
    beside = _window(processes, seconds)
    return beside, _alone(processes, seconds)


def _alone(processes: Processes, seconds: float) -> Window:
    processes.signal(signal.SIGSTOP)
    try:
        return _window(processes, seconds)
    finally:
        processes.signal(signal.SIGCONT)


def _window(processes: Processes, seconds: float) -> Window:
    groups = [processes.run, *accounting.descendants(processes.run)], [processes.console], processes.browser
    tick, began_us, used = _tick(), now_us(), [accounting.usage(pids) for pids in groups]
    sleep_s(seconds)
    ticks, wall_us = _tick() - tick, now_us() - began_us
    cpu_us = [(accounting.usage(pids) - before).cpu_us for pids, before in zip(groups, used, strict=True)]
    if ticks <= 0:
        raise RunFailedError(f"no tick in {seconds} s")
    return Window(ticks, wall_us, *cpu_us)


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
        with Client(supervisor_address(_BUS_PORT)) as run:
            yield int(run.ask("run")["pid"])


@contextmanager
def _console(home: str) -> Iterator[tuple[int, str]]:
    """Starts the console; yields the id of its serving process and its address."""
    with _program(home, ["fwk", "web", "--run", _RUN, "--port", "0"]) as (process, output):
        end_us = now_us() + _PATIENCE_S * 1e6
        while not (found := re.search(r"http://\S+?(?=/\s)", output.read_text(errors="replace"))):
            if process.poll() is not None or now_us() > end_us:
                raise RunFailedError(f"the console did not start: {output.read_text(errors='replace')}")
            sleep_s(0.1)
        while not (serving := accounting.descendants(process.pid)):
            sleep_s(0.1)
        yield serving[0], found[0]


@contextmanager
def _program(home: str, words: list[str]) -> Iterator[tuple[subprocess.Popen[bytes], Path]]:
    output = Path(home) / f"{words[0]}.txt"
    environment = {**os.environ, "HOME": home, "PYTHONUNBUFFERED": "1"}
    with open(output, "wb") as file:
        program = [str(Path(sys.executable).parent / words[0]), *words[1:]]
        process = subprocess.Popen(
            program, cwd=REPOSITORY, env=environment, stdout=file, stderr=subprocess.STDOUT, start_new_session=True
        )
    try:
        yield process, output
    finally:
        process.send_signal(signal.SIGINT)
        try:
            process.wait(_PATIENCE_S)
        except subprocess.TimeoutExpired:
            process.kill()


@contextmanager
def _distant_browser(home: str, urls: list[str]) -> Iterator[Drawings]:
    """Opens the pages in a client that shows nothing."""
    output = Path(home) / "distant.txt"
    with open(output, "wb") as file:
        words = [sys.executable, "-m", "tools.bench.distant_browser", *urls]
        process = subprocess.Popen(words, cwd=REPOSITORY, stdout=file, start_new_session=True)
    try:
        end_us = now_us() + _PATIENCE_S * 1e6
        while output.read_text().count(_OPEN) < len(urls) and now_us() < end_us and process.poll() is None:
            sleep_s(0.1)
        yield lambda: output.read_text().count(_DRAWING)
        if process.poll() is not None:
            raise RunFailedError(f"the distant browser has ended with code {process.returncode}")
    finally:
        process.kill()
        process.wait()


@contextmanager
def _browser(urls: list[str]) -> Iterator[Drawings]:
    """Opens the pages in Chromium."""
    program = shutil.which(CHROMIUM)
    if program is None:
        raise RunFailedError(f"needs {CHROMIUM}: apt install {CHROMIUM}")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        opened = []
        for url in urls:
            page = browser.new_page(viewport={"width": 1280, "height": 800})
            page.set_default_timeout(1000 * _PATIENCE_S)
            page.goto(url)
            page.wait_for_function("document.querySelector('[data-name=clock]').innerText.startsWith('tick')")
            opened.append(page)
        yield lambda: sum(map(_drawings, opened))
        browser.close()


def _drawings(page: Page) -> int:
    canvas = page.locator("canvas")
    return int(canvas.get_attribute("data-frames") or 0) if canvas.count() else 0


if __name__ == "__main__":
    program.run(main)
