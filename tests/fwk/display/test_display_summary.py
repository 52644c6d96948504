"""The closing lines of a run."""

from dataclasses import replace
from pathlib import Path

import pytest

from fwk.cli.run.run_directory import make_run_dir
from fwk.display.summary import introduction, summary
from fwk.lcm.event_log import LogWriter
from fwk.recording.part_compressor import compress_part
from fwk.supervisor.options import Outcome, RunOptions
from tests.fwk.cli.cli_runs import MATCH, component, game_state, plan, status

RUN_DIR = Path("runs/1")


def lines(**changes: object) -> list[str]:
    last = status(MATCH, 1200, busy_us=500)
    component(last, "cyan2/omni_field").busy_us = 1200 * 4000
    failed = component(last, "cyan3/skiller")
    failed.state, failed.reason = "failed", "ZeroDivisionError: division by zero"
    last.hosts[1].counters.lost = 2
    last.hosts[0].restarts = 3
    outcome = Outcome(0, 1200, 60.0, 30.0, "1200 ticks done", last, {"world/game_state": game_state(3, 2)})
    return summary(plan("tests.fwk.cli.cli_runs:headline"), RunOptions(RUN_DIR, **changes), outcome)  # type: ignore[arg-type]


def test_the_first_lines_name_the_run_and_useful_commands() -> None:
    first, second = introduction(plan())
    assert first == "match: 0 components, 1 channel, 0 processes, 1 stage, 20 ticks/s"
    assert "fwk spy;" in second


def test_only_an_unusual_public_bus_is_named() -> None:
    elsewhere = "udpm://239.255.76.67:7777?ttl=0"
    assert f"fwk spy --url '{elsewhere}';" in introduction(replace(plan(), public_url=elsewhere))[1]
    assert len(introduction(replace(plan(), public_url=""))) == 1


def test_the_result_comes_first() -> None:
    assert lines()[:2] == ["CYAN 3 : 2 MAGENTA", "match: 1200 ticks done"]


def test_pace_and_times_are_given() -> None:
    assert "1200 ticks, 60.00 s of logical time in 30.00 s: 40.0 ticks/s, 2.00 times real time" in lines()


def test_the_slowest_components_are_named() -> None:
    slowest = next(line for line in lines() if line.startswith("slowest: "))
    assert slowest.startswith("slowest: cyan2/omni_field 4.00 ms (worst 1.0), cyan1/agent 0.50 ms")


def test_losses_restarts_and_failures_are_named() -> None:
    assert "messages and ticks: lost 2   late 0   restarts 3" in lines()
    assert "cyan3/skiller failed: ZeroDivisionError: division by zero" in lines()


def test_the_recording_is_named_only_if_there_is_one() -> None:
    assert lines()[-1] == "run directory: runs/1"
    assert "recording: runs/1/log.lcm" in lines(record=RUN_DIR / "log.lcm")
    assert not any(line.startswith("recording") for line in lines())


def test_the_recording_has_the_names_of_its_files(tmp_path: Path) -> None:
    log = tmp_path / "log.lcm"
    with LogWriter(log, pytest.fail) as made:
        made.append("a", b"", 0)
        assert compress_part(made.split() or log)
        assert f"recording: {log}.zst" in lines(record=log)
        made.append("a", b"", 1)
        made.flush()
        assert f"recording: {log}.zst to log.lcm.01, 2 files" in lines(record=log)


def test_gaps_of_the_recording_are_reported() -> None:
    outcome = Outcome(0, 1200, 60.0, 30.0, "1200 ticks done", unrecorded=7)
    said = summary(plan(), RunOptions(RUN_DIR, record=RUN_DIR / "log.lcm"), outcome)
    assert "recording: runs/1/log.lcm; 7 messages are missing in it" in said


def test_a_run_that_never_ticked_has_a_summary_too() -> None:
    outcome = Outcome(1, 0, 0.0, 0.0, "cyan1/base is not ready after 20 s: no battery")
    made = summary(plan(), RunOptions(RUN_DIR), outcome)
    assert made[0] == "match: cyan1/base is not ready after 20 s: no battery"


def test_run_directory_carries_the_name_in_safe_letters(tmp_path: Path) -> None:
    made = make_run_dir("5 v 5/final", tmp_path)
    assert made.is_dir()
    assert made.parent == tmp_path
    assert "-5_v_5_final-" in made.name
