"""Restart policies as histories: starts and ends of a process, and the actions that follow."""

from collections.abc import Callable

import pytest

from fwk.model.sections import RestartPolicy, RestartWhen
from fwk.supervisor.host_process import NEXT_STATES, Change, HostProcess, HostState, HostStateError
from lcmtypes.core import component_state_t, host_counters_t


def entry(
    when: RestartWhen = "on-failure", limit: int = 3, window_s: float = 10, backoff_s: float = 0.5
) -> HostProcess:
    return HostProcess(0, "cyan1/base", RestartPolicy(when, backoff_s, limit, window_s), 1_000_000)


@pytest.mark.parametrize(
    ("when", "code", "state"),
    [
        ("never", 0, "failed"),
        ("never", 1, "failed"),
        ("never", -9, "failed"),
        ("on-failure", 0, "waiting"),
        ("on-failure", 1, "waiting"),
        ("on-failure", -11, "waiting"),
        ("always", 0, "waiting"),
        ("always", -9, "waiting"),
    ],
)
def test_actions_after_an_end(when: RestartWhen, code: int, state: str) -> None:
    host = entry(when)
    host.begin_start(0)
    host.ended(code, 1000, stopping=False)
    assert host.state == state


def test_each_start_is_a_new_incarnation_and_waits_twice_as_long() -> None:
    host, waits = entry(), []
    for number in range(3):
        assert host.begin_start(number) == number + 1
        host.ended(-9, number, stopping=False)
        waits.append(host.restart_us - number)
    assert waits == [500_000, 1_000_000, 2_000_000]


def test_too_many_starts_within_the_window_are_the_end() -> None:
    host = entry(limit=3)
    for now in range(4):
        host.begin_start(now)
        host.ended(1, now, stopping=False)
    assert host.state == "failed"
    assert "4 times in 10 s" in host.reason


def test_starts_outside_the_window_are_forgotten() -> None:
    host = entry(limit=3)
    for number in range(20):
        host.begin_start(number * 11_000_000)
        host.ended(1, number * 11_000_000, stopping=False)
    assert host.state == "waiting"
    assert host.restarts == 20


def test_no_process_is_restarted_during_shutdown() -> None:
    host = entry("always")
    host.begin_start(0)
    host.ended(-15, 1, stopping=True)
    assert host.state == "failed"


def test_the_reason_names_the_signal() -> None:
    host = entry("never")
    host.begin_start(0)
    host.ended(-9, 1, stopping=False)
    assert host.reason == "killed by signal 9"


def test_an_unexpected_end_is_described_as_such() -> None:
    host = entry("never")
    host.begin_start(0)
    host.ended(0, 1, stopping=False)
    assert "left by itself" in host.reason


def test_the_reason_names_the_failing_component_of_a_host() -> None:
    host = entry("never")
    host.begin_start(0)
    host.ended(-11, 1, stopping=False, culprit="cyan1/base")
    assert host.reason == "cyan1/base: killed by signal 11"


def running(when: RestartWhen = "on-failure") -> HostProcess:
    host = entry(when)
    host.begin_start(0)
    host.become_ready(5)
    host.pid = 100
    return host


def test_a_stopped_process_ends_and_stays_away() -> None:
    host = running("always")
    host.want_stop(10)
    assert host.must_leave
    assert host.expected  # until the boundary
    host.begin_stop(20)
    assert not host.expected
    host.ended(-15, 30, stopping=False)
    assert host.state == "stopped"
    assert host.settled
    assert not host.must_join


def test_a_restart_is_a_number_that_increases() -> None:
    host = running()
    host.want_restart(10)
    assert (host.desired_run, host.actual_run) == (2, 1)
    assert host.must_leave
    host.begin_stop(20)
    assert host.expected  # the main loop waits for it
    host.ended(0, 30, stopping=False)
    assert host.state == "waiting"
    assert host.restart_us == 30
    assert host.must_join
    assert host.begin_start(40) == 2
    host.become_ready(50)
    assert host.settled


def test_a_failed_host_starts_again_on_request() -> None:
    host = entry("never")
    host.begin_start(0)
    host.ended(1, 10, stopping=False)
    assert host.state == "failed"
    host.want_start(20)
    assert host.must_join
    host.begin_start(30)
    assert host.alive
    assert not host.must_leave


@pytest.mark.parametrize("asks", [HostProcess.want_start, HostProcess.want_restart])
def test_a_request_cuts_the_wait_for_a_restart_short(asks: Callable[[HostProcess, int], None]) -> None:
    host = running("always")
    host.ended(1, 20, stopping=False)
    assert host.restart_us > 20
    asks(host, 30)
    assert host.restart_us == 30
    host.begin_start(40)
    host.become_ready(50)
    assert host.settled


def test_nothing_waits_for_a_stopped_host_that_has_no_process() -> None:
    host = running("always")
    host.ended(1, 20, stopping=False)
    assert (host.expected, host.coming) == (True, True)
    host.want_stop(30)
    assert (host.expected, host.coming) == (False, False)
    host.want_restart(40)
    assert (host.expected, host.coming) == (True, True)


def test_start_leaves_running_processes_alone() -> None:
    host = running()
    host.want_start(10)
    assert not host.must_leave
    assert host.settled


def test_requested_restarts_reset_the_failure_count() -> None:
    host = entry(limit=1)
    for moment in (0, 10):
        host.begin_start(moment)
        host.ended(1, moment + 5, stopping=False)
    assert host.state == "failed"
    host.want_restart(20)
    host.begin_start(30)
    host.ended(1, 40, stopping=False)
    assert host.state == "waiting"


def test_a_process_that_dies_before_its_stop_is_not_restarted() -> None:
    host = running("always")
    host.want_stop(10)
    host.ended(-9, 20, stopping=False)
    assert host.state == "stopped"


def test_settings_are_kept_until_their_tick_is_answered() -> None:
    host = running()
    host.changes = [Change(0, 1, "{}", step=5), Change(0, 2, "{}", step=8)]
    host.answered_step = 5
    host.drop_told_changes()
    assert [change.number for change in host.changes] == [2]
    host.want_restart(10)
    host.begin_stop(20)
    assert host.changes == []  # the new process starts with them


def test_lost_messages_stay_lost_across_restarts() -> None:
    host = entry()
    for lost in (2, 3):
        host.begin_start(0)
        for sofar in range(lost + 1):  # the host reports it repeatedly
            said = component_state_t()
            said.name, said.lost_frames, said.iterations = "cyan1/base", sofar, 100
            counters = host_counters_t()
            counters.lost, counters.fetched, counters.foreign = sofar, 10 * sofar, 100 * sofar
            host.report([said], [], counters)
        host.ended(-9, 0, stopping=False)
    host.begin_start(0)  # and this incarnation has not reported anything
    host.ended(-9, 0, stopping=False)
    host.begin_start(0)
    (component,) = host.components
    assert (component.lost_frames, component.iterations) == (5, 100)
    assert (host.counters.lost, host.counters.fetched, host.counters.foreign) == (5, 50, 500)


def test_every_state_has_its_successors() -> None:
    assert set(NEXT_STATES) == set(HostState)
    host = entry()
    with pytest.raises(HostStateError, match="cyan1/base is loaded and cannot become running"):
        host.become_ready(0)
    with pytest.raises(HostStateError, match="cannot become stopping"):
        host.begin_stop(0)


def test_timeouts_apply_only_where_they_are_requested() -> None:
    host = HostProcess(0, "a", RestartPolicy())
    host.begin_start(0)
    assert not host.not_ready_in_time(10**12)
    host.ready_timeout_us = 1000
    assert host.not_ready_in_time(1001)
    host.held = True
    assert not host.not_ready_in_time(1001)
    host.become_ready(2000)
    host.begin_stop(3000)
    assert not host.not_stopped_in_time(10**12)
    host.stop_timeout_us = 1000
    assert host.not_stopped_in_time(4001)
