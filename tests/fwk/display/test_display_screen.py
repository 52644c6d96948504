"""The live picture: everything that matters fits the terminal."""

from io import StringIO

import pytest
from rich.console import Console

from fwk.display.screen import screen
from fwk.display.view import View
from lcmtypes.core import log_t, status_t
from tests.fwk.cli.cli_runs import MATCH, TRACKER, component, game_state, log, packet, plan, status

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
        console.print(screen(view, rows))
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
    assert "line 59" in picture[-1]


def test_few_components_have_a_row_each() -> None:
    picture = drawn(status(TRACKER, 100, busy_us=1500))
    assert row(picture, "cyan1/tracker").split() == ["cyan1/tracker", "running", "1.50", "3.0", "0"]


def test_the_scoreboard_is_the_headline() -> None:
    assert "CYAN 2 : 1 MAGENTA" in drawn(status(TRACKER, 1), scoreboard=SCOREBOARD)[1]


def test_a_broken_scoreboard_is_named_and_stops_nothing() -> None:
    picture = drawn(status(TRACKER, 1), scoreboard="tests.fwk.cli.cli_runs:missing")
    assert "missing" in picture[1]
    assert "running" in row(picture, "cyan1/tracker")


def test_a_failed_component_is_named_with_its_reason_however_many_run_well() -> None:
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
    component(lossy, "magenta4/agent").lost = 7
    picture = drawn(lossy)
    assert "lost 7   late 3" in row(picture, "tick")
    assert row(picture, "magenta4").split()[-2:] == ["7", "0"]


def test_before_the_first_status_it_says_that_it_starts() -> None:
    assert "starting ..." in drawn()
