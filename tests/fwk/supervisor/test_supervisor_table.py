"""Restart policies as histories: when a process starts and ends, and what happens then."""

import pytest

from fwk.plan.model import RestartPolicy, RestartWhen
from fwk.supervisor.table import HostEntry


def entry(when: RestartWhen = "on-failure", limit: int = 3, window_s: float = 10, backoff_s: float = 0.5) -> HostEntry:
    return HostEntry(0, "cyan1/base", RestartPolicy(when, backoff_s, limit, window_s), 1_000_000)


@pytest.mark.parametrize(
    ("when", "code", "state"),
    [
        ("never", 0, "stopped"),
        ("never", 1, "failed"),
        ("never", -9, "failed"),
        ("on-failure", 0, "stopped"),
        ("on-failure", 1, "waiting"),
        ("on-failure", -11, "waiting"),
        ("always", 0, "waiting"),
        ("always", -9, "waiting"),
    ],
)
def test_what_follows_an_end(when: RestartWhen, code: int, state: str) -> None:
    host = entry(when)
    host.starting(0)
    host.ended(code, 1000, stopping=False)
    assert host.state == state


def test_each_start_is_a_new_incarnation_and_waits_twice_as_long() -> None:
    host, waits = entry(), []
    for number in range(3):
        assert host.starting(number) == number + 1
        host.ended(-9, number, stopping=False)
        waits.append(host.restart_us - number)
    assert waits == [500_000, 1_000_000, 2_000_000]


def test_too_many_starts_within_the_window_are_the_end() -> None:
    host = entry(limit=3)
    for now in range(4):
        host.starting(now)
        host.ended(1, now, stopping=False)
    assert host.state == "failed"
    assert "4 times in 10 s" in host.reason


def test_starts_outside_the_window_are_forgotten() -> None:
    host = entry(limit=3)
    for number in range(20):
        host.starting(number * 11_000_000)
        host.ended(1, number * 11_000_000, stopping=False)
    assert host.state == "waiting"
    assert host.restarts == 20


def test_nothing_is_started_again_while_everything_stops() -> None:
    host = entry("always")
    host.starting(0)
    host.ended(-15, 1, stopping=True)
    assert host.state == "failed"


def test_the_reason_names_the_signal() -> None:
    host = entry("never")
    host.starting(0)
    host.ended(-9, 1, stopping=False)
    assert host.reason == "killed by signal 9"
