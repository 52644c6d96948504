"""The live picture: all important figures fit the terminal."""

from dataclasses import replace
from io import StringIO

import pytest
from rich.console import Console

from fwk.display.screen import screen
from fwk.display.view import View
from fwk.model.plan import HostPlan
from lcmtypes.core import log_t, status_t
from tests.fwk.cli.cli_runs import MATCH, TRACKER, component, game_state, host_of, log, packet, plan, status

DRAWING = "tests.fwk.cli.cli_drawing:headline"
SCOREBOARD = "tests.fwk.cli.cli_runs:headline"


def drawn(*statuses: status_t, rows: int = 40, columns: int = 120, lines: int = 0, scoreboard: str = "") -> list[str]:
    view = View(plan(scoreboard))
    view.take(packet("world/game_state", game_state(2, 1)))
    for each in statuses:
        view.take(packet("fwk/status", each))
    for number in range(lines):
        view.take(packet("fwk/log", log(f"line {number} " + "long " * 50, log_t.WARNING)))
    console = Console(width=columns, height=rows, file=StringIO(), color_system=None)
    with console.capture() as captured:
        console.print(screen(view, rows, columns))
    return captured.get().splitlines()


def row(picture: list[str], word: str) -> str:
    return next(line for line in picture if line.split()[:1] == [word])


@pytest.mark.parametrize(("rows", "columns"), [(40, 120), (24, 80)])
def test_a_match_fits_the_terminal(rows: int, columns: int) -> None:
    picture = drawn(status(MATCH, 100), rows=rows, columns=columns, lines=60)
    assert len(picture) < rows
    assert all(len(line) <= columns for line in picture)
    for robot in ("cyan1", "cyan5", "magenta1", "magenta5", "world", "team_cyan"):
        assert "running" in row(picture, robot)
    assert any("line 59" in line for line in picture[-6:])  # it wraps


def test_few_components_have_a_row_each() -> None:
    picture = drawn(status(TRACKER, 100, busy_us=1500))
    assert row(picture, "cyan1/tracker").split() == ["cyan1/tracker", "running", "1.50", "3.0", "0"]


def test_the_scoreboard_is_the_headline() -> None:
    assert "CYAN 2 : 1 MAGENTA" in drawn(status(TRACKER, 1), scoreboard=SCOREBOARD)[1]


def test_a_broken_scoreboard_is_named_and_stops_nothing() -> None:
    picture = drawn(status(TRACKER, 1), scoreboard="tests.fwk.cli.cli_runs:missing")
    assert "missing" in picture[1]
    assert "running" in row(picture, "cyan1/tracker")


def test_failed_component_among_many_is_named_with_its_reason() -> None:
    broken = status(MATCH, 100)
    failed = component(broken, "cyan3/skiller")
    failed.state, failed.reason = "failed", "ZeroDivisionError: division by zero (skiller.py:40)"
    picture = drawn(broken)
    assert "1 failed, 9 running" in row(picture, "cyan3")
    assert row(picture, "cyan3/skiller").split(maxsplit=1)[1] == f"failed: {failed.reason}"


def test_loop_times_are_those_of_the_last_statuses() -> None:
    before, now = status(TRACKER, 100, busy_us=100), status(TRACKER, 200, busy_us=100)
    component(now, "cyan1/tracker").busy_us = component(before, "cyan1/tracker").busy_us + 100 * 900
    assert row(drawn(before, now), "cyan1/tracker").split()[2] == "0.90"


def test_the_slowest_of_a_robot_is_named() -> None:
    slow = status(MATCH, 100, busy_us=100)
    component(slow, "cyan2/omni_field").busy_us = 100 * 4000
    assert "omni_field 4.00" in row(drawn(slow), "cyan2")


def test_losses_are_counted_in_the_sum_and_in_the_row() -> None:
    lossy = status(MATCH, 100, late=3)
    host_of(lossy, "magenta4/agent").counters.lost = 7
    picture = drawn(lossy)
    assert "lost 7   late 3" in row(picture, "tick")
    assert row(picture, "magenta4").split()[-2:] == ["7", "0"]


def test_before_the_first_status_it_shows_the_start() -> None:
    assert "starting ..." in drawn()


@pytest.mark.parametrize(("rows", "columns"), [(24, 80), (40, 120), (50, 200)])
def test_the_drawing_stands_beside_the_table(rows: int, columns: int) -> None:
    picture = drawn(status(MATCH, 100), rows=rows, columns=columns, lines=60, scoreboard=DRAWING)
    assert len(picture) < rows
    assert all(len(line) <= columns for line in picture)
    assert sum("#" in line for line in picture) >= 9
    assert "running" in row(picture, "magenta5")


def test_a_narrow_terminal_has_no_drawing() -> None:
    assert not any("#" in line for line in drawn(status(MATCH, 100), rows=24, columns=50, scoreboard=DRAWING))


def test_a_broken_drawing_is_named() -> None:
    picture = drawn(status(TRACKER, 1), scoreboard="tests.fwk.cli.cli_broken:headline")
    assert any("drawing: ZeroDivisionError" in line for line in picture)


def test_long_log_lines_wrap_and_lose_nothing() -> None:
    view = View(plan())
    text = " ".join(f"word{number}" for number in range(60))
    view.take(packet("fwk/log", log(text)))
    console = Console(width=80, height=40, file=StringIO(), color_system=None)
    with console.capture() as captured:
        console.print(screen(view, 40, 80))
    shown = [word for word in captured.get().split() if word.startswith("word")]
    assert shown == [f"word{number}" for number in range(60)]


def test_a_run_that_waits_names_the_component(monkeypatch: pytest.MonkeyPatch) -> None:
    now_us = [0]
    monkeypatch.setattr("fwk.display.view.monotonic_us", lambda: now_us[0])
    view = View(plan())
    view.take(packet("fwk/status", status(TRACKER, 5)))
    view.waits_for = ["cyan1/tracker"]
    assert view.waiting == ""
    now_us[0] = 4_000_000
    assert view.waiting == "waits for cyan1/tracker, 4 s"
    view.take(packet("fwk/status", status(TRACKER, 6)))
    assert view.waiting == ""


@pytest.mark.parametrize(
    ("cores", "busy_us", "cause"),
    [
        (2, 1000, "3 processes share 2 cores: start it with --hosting robot"),
        (1, 1000, "3 processes share 1 core: start it with --hosting robot"),
        (4, 1000, "'fwk top' shows where the time goes"),
        (2, 70_000, "cyan1/camera takes 70 ms, but a tick has only 50 ms"),
    ],
)
def test_a_run_below_the_desired_speed_names_the_cause(
    cores: int, busy_us: int, cause: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("os.sched_getaffinity", lambda _: set(range(cores)))
    hosts = tuple(HostPlan(index, f"cyan1/c{index}", (index,)) for index in range(3))
    view = View(replace(plan(), hosts=hosts))
    for count in range(9):
        assert (view.slowness == "") == (count < 8)
        view.take(packet("fwk/status", status(TRACKER, 1, speed=0.3, busy_us=busy_us)))
    assert view.slowness == f"slower than asked; {cause}"
    drawing = drawn(*[status(TRACKER, 1, speed=0.3, busy_us=70_000)] * 9, columns=80)
    assert row(drawing, "slower").endswith("cyan1/camera takes 70 ms, but a tick has only 50 ms")


@pytest.mark.parametrize("columns", [40, 60, 80, 120])
def test_the_line_of_figures_is_never_cut(columns: int) -> None:
    busy = status(MATCH, 100, late=3, repeated=12345)
    figures = row(drawn(busy, columns=columns), "tick")
    assert "…" not in figures
    assert figures.startswith(" tick 100   5.00 s")


def test_cpu_of_a_process_is_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    now_us, used = [5_000_000], {4711: 1.0}
    monkeypatch.setattr("fwk.display.cpu.monotonic_us", lambda: now_us[0])
    monkeypatch.setattr("fwk.display.cpu.cpu_s", used.get)
    view, busy = View(plan()), status(TRACKER, 5)
    busy.hosts[1].pid = 4711
    view.take(packet("fwk/status", busy))
    now_us[0], used[4711] = 7_000_000, 2.5
    view.take(packet("fwk/status", busy))
    console = Console(width=100, height=40, file=StringIO(), color_system=None)
    with console.capture() as captured:
        console.print(screen(view, 40, 100))
    assert row(captured.get().splitlines(), "cyan1/tracker").split()[:3] == ["cyan1/tracker", "running", "75"]


@pytest.mark.parametrize("columns", [50, 80, 120])
def test_the_line_of_keys_is_never_cut(columns: int) -> None:
    view = View(plan())
    view.take(packet("fwk/status", status(TRACKER, 5)))
    view.selected, view.level = "cyan1/tracker", 1
    console = Console(width=columns, height=30, file=StringIO(), color_system=None)
    with console.capture() as captured:
        console.print(screen(view, 30, columns, keys=True))
    keys = captured.get().splitlines()[-1]
    assert keys.startswith(" [lines of cyan1/tracker")
    assert keys.endswith("q quit")
