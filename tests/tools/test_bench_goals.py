"""Verdicts on the goals, each with a figure that passes and one that fails."""

from collections.abc import Mapping
from typing import Any

import pytest

from tools.bench.environments import CORE
from tools.bench.figures import Run, Runs
from tools.bench.goals import Verdict, judge
from tools.bench.own import AT_100_HZ, SOAK, SOCCER
from tools.bench.registry import Peer

PEERS = [
    Peer("lcm", "bare LCM", CORE, "", bare=True),
    Peer("zmq", "ZeroMQ", CORE, ""),
    Peer("fwk", "fwk", CORE, ""),
    Peer("fwk_recorded", "fwk, recorded", CORE, ""),
]
SIZES = (20, 160)
GOOD = {
    ("fwk", "N=20"): 1100,
    ("fwk", "N=160"): 9000,
    ("lcm", "N=20"): 1000,
    ("lcm", "N=160"): 8000,
    ("zmq", "N=20"): 2000,
    ("zmq", "N=160"): 9500,
    ("fwk_recorded", "N=20"): 1200,
    ("fwk_recorded", "N=160"): 10000,
    ("fwk", "N=20, loss 1 %"): 1300,
    ("fwk", "N=160, loss 1 %"): 10000,
}
CONTRACT, AHEAD, FLAT, RECORDER, LOSS, START, JITTER, MISSED = range(8)


OWN: dict[str, dict[str, Any]] = {
    AT_100_HZ: {"error_us": [100.0] * 99 + [5000.0]},
    SOAK: {"error_us": [100.0] * 59_900, "missed": 0},
    SOCCER: {"first_tick_s": 2.5, "pss_mb": 900.0},
}


def verdicts(
    ticks_us: Mapping[tuple[str, str], float], own: Mapping[str, dict[str, Any]] | None = None
) -> list[Verdict]:
    runs = [Run(0, peer, scenario, {"tick_us": [tick]}) for (peer, scenario), tick in ticks_us.items()]
    runs += [Run(0, "fwk", scenario, result) for scenario, result in (own or {}).items()]
    return judge(Runs(runs), PEERS, SIZES)


def test_all_goals_are_met() -> None:
    assert [verdict.word for verdict in verdicts(GOOD, OWN)] == ["met"] * 8


@pytest.mark.parametrize(
    ("goal", "change"),
    [
        (CONTRACT, {("lcm", "N=160"): 7100}),
        (AHEAD, {("zmq", "N=160"): 8900}),
        (FLAT, {("fwk", "N=160"): 11500, ("lcm", "N=160"): 11000}),
        (RECORDER, {("fwk_recorded", "N=20"): 1300}),
        (LOSS, {("fwk", "N=20, loss 1 %"): 1330}),
    ],
)
def test_one_figure_misses_one_goal(goal: int, change: dict[tuple[str, str], float]) -> None:
    assert verdicts({**GOOD, **change})[goal].met is False


@pytest.mark.parametrize(
    ("goal", "change"),
    [
        (START, {SOCCER: {"first_tick_s": 3.1, "pss_mb": 900.0}}),
        (START, {SOCCER: {"first_tick_s": 2.5, "pss_mb": 1201.0}}),
        (MISSED, {SOAK: {"error_us": [100.0] * 59_900, "missed": 1}}),
        (MISSED, {SOAK: {"error_us": [100.0] * 10, "missed": 1}}),
        (JITTER, {AT_100_HZ: {"error_us": [100.0] * 98 + [5000.0] * 2}}),
    ],
)
def test_one_figure_of_fwk_alone_misses_one_goal(goal: int, change: dict[str, dict[str, Any]]) -> None:
    assert verdicts(GOOD, {**OWN, **change})[goal].met is False


def test_a_goal_without_a_measurement_is_left_open() -> None:
    assert [verdict.word for verdict in verdicts({("lcm", "N=20"): 1000})] == ["not measured"] * 8


def test_a_short_run_leaves_goals_of_long_runs_open() -> None:
    short = {SOAK: {"error_us": [100.0] * 1000, "missed": 0}}
    assert verdicts(GOOD, {**OWN, **short})[MISSED].word == "not measured"


def test_a_faster_peer_is_named() -> None:
    assert "ZeroMQ N=160" in verdicts({**GOOD, ("zmq", "N=160"): 8900})[AHEAD].figures


def test_bare_transports_are_not_rivals() -> None:
    assert "bare LCM" not in verdicts({**GOOD, ("lcm", "N=20"): 10})[AHEAD].figures
