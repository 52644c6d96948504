"""Processors of hosts: a namespace's processes share one, namespaces take turns."""

import os
from dataclasses import replace

import pytest

from fwk.model.plan import Plan
from fwk.supervisor.processes.cores import core_of, stay_on_core
from fwk.testing import launch_plan


@pytest.fixture(scope="module")
def plan() -> Plan:
    return launch_plan("soccer.yaml")


def test_robots_processes_share_a_processor_robots_take_turns(plan: Plan) -> None:
    cores: dict[str, set[int | None]] = {}
    for index, host in enumerate(plan.hosts):
        namespace = plan.components[host.components[0]].namespace
        cores.setdefault(namespace, set()).add(core_of(plan, index, [2, 5, 7]))
    assert all(len(found) == 1 for found in cores.values())
    given = [next(iter(cores[namespace])) for namespace in cores]
    assert given[:6] == [2, 5, 7, 2, 5, 7]


@pytest.mark.parametrize("other", [{"cores": "any"}, {"clock": "wall"}])
def test_without_the_key_and_in_real_time_the_system_decides(plan: Plan, other: dict[str, str]) -> None:
    assert core_of(replace(plan, **other), 0, [0, 1]) is None  # type: ignore[arg-type]


def test_a_process_is_bound_to_a_processor_that_it_may_use(plan: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    bound: list[set[int]] = []
    monkeypatch.setattr(os, "sched_setaffinity", lambda _, cores: bound.append(cores))
    stay_on_core(core_of(plan, 0, [3]))
    stay_on_core(core_of(replace(plan, cores="any"), 0, [3]))
    assert bound == [{3}]


def test_a_system_that_refuses_lets_the_host_run_anywhere(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[set[int]] = []

    def refuse(_pid: int, cores: set[int]) -> None:
        asked.append(cores)
        raise PermissionError

    monkeypatch.setattr(os, "sched_setaffinity", refuse)
    stay_on_core(3)
    assert asked == [{3}]
