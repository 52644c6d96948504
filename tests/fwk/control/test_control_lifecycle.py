"""Requests for components become requests for processes, or are refused with the components that prevent them."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fwk import Component, Image, VisionMaster, Writes
from fwk.control.requests import Action, RequestError
from fwk.plan.files.source_files import Sources
from fwk.supervisor.host_process import HostProcess, host_processes
from fwk.supervisor.lifecycle import Lifecycle
from fwk.testing.plans import plan_of
from lcmtypes.robot import imu_t


class Camera(Component):
    stage = "sensor_acquire"
    image: VisionMaster

    def loop(self) -> None:
        self.image.publish(np.zeros((2, 2), np.uint8))


class Finder(Component):
    stage = "sensor_prepare"
    image: Image


class Base(Component):
    stage = "act"
    imu: Writes[imu_t]


@pytest.fixture
def table() -> list[HostProcess]:
    return []


@pytest.fixture
def steering(table: list[HostProcess]) -> Lifecycle[HostProcess]:
    components = {"r/camera": Camera, "r/finder": Finder, "r/base": Base, "s/base": Base}
    plan = plan_of(components, groups=[["r/base", "s/base"]])
    planned = list(plan.components)
    planned[1] = replace(planned[1], needs=(0, 2))  # the finder needs r/base too
    plan = replace(plan, components=tuple(planned))
    table += host_processes(plan)
    for entry in table:
        entry.begin_start(0)
        entry.become_ready(0)
    return Lifecycle(plan, table)


def state(table: list[HostProcess], name: str, *, running: bool) -> None:
    entry = next(entry for entry in table if entry.name == name)
    if running:
        entry.wait_for_start(0)
        entry.begin_start(0)
        entry.become_ready(0)
    else:
        entry.begin_stop(0)
        entry.wanted = False
        entry.ended(0, 0, stopping=False)
    entry.wanted = running


def names(entries: list[HostProcess]) -> list[str]:
    return [entry.name for entry in entries]


@pytest.mark.parametrize(
    ("action", "patterns", "error"),
    [
        ("stop", ["r/camra"], "no component 'r/camra'; did you mean 'r/camera'?"),
        ("stop", [], "stop: no components given"),
        (
            "unload",
            ["r/camera"],
            "r/camera is needed by r/finder; unload them too: fwk unload r/camera r/finder, "
            "or fwk unload --force r/camera",
        ),
        ("unload", ["*/base"], "r/base is needed by r/finder"),
        ("restart", ["s/base"], "the process 'r/base+s/base' holds r/base as well; restart all of them"),
    ],
)
def test_impossible_requests_are_refused(
    steering: Lifecycle[HostProcess], action: Action, patterns: list[str], error: str
) -> None:
    with pytest.raises(RequestError, match=re.escape(error)):
        steering.hosts(action, patterns)


def test_refusal_names_a_few_of_many_components() -> None:
    names = [f"r{number}/base" for number in range(9)]
    many = plan_of(dict.fromkeys(names, Base), groups=[names])
    reason = "holds r1/base, r2/base, r3/base, r4/base, r5/base and 3 more as well; stop all of them"
    with pytest.raises(RequestError, match=re.escape(reason)):
        Lifecycle(many, host_processes(many)).hosts("stop", ["r0/base"])


def test_a_user_does_not_start_without_its_vision_master(
    steering: Lifecycle[HostProcess], table: list[HostProcess]
) -> None:
    for name in ("r/camera", "r/finder"):
        state(table, name, running=False)
    for action in ("start", "restart", "reload"):
        with pytest.raises(RequestError, match=r"r/finder needs r/camera, which does not run; 'fwk load r/finder'"):
            steering.hosts(action, ["r/finder"])
    assert names(steering.hosts("start", ["r/finder", "r/camera"])) == ["r/camera", "r/finder"]


def test_load_includes_needs_and_does_not_run(steering: Lifecycle[HostProcess], table: list[HostProcess]) -> None:
    for name in ("r/camera", "r/finder"):
        state(table, name, running=False)
    assert names(steering.hosts("load", ["r/finder"])) == ["r/camera", "r/finder"]


def test_a_master_is_unloaded_once_it_has_no_users(steering: Lifecycle[HostProcess], table: list[HostProcess]) -> None:
    state(table, "r/finder", running=False)
    assert names(steering.hosts("unload", ["r/camera"])) == ["r/camera"]
    state(table, "r/finder", running=True)
    assert names(steering.hosts("unload", ["r/camera", "r/finder"])) == ["r/camera", "r/finder"]
    for action in ("stop", "unload"):
        assert names(steering.hosts(action, ["r/camera"], force=True)) == ["r/camera", "r/finder"]
    assert names(steering.hosts("stop", ["r/camera"])) == ["r/camera"]


def test_readers_that_lose_their_writer_are_named(steering: Lifecycle[HostProcess], table: list[HostProcess]) -> None:
    (camera,) = steering.hosts("stop", ["r/camera"])
    assert steering.left_without([camera]) == [{"channel": "r/image", "readers": ["r/finder"]}]
    state(table, "r/finder", running=False)
    assert steering.left_without([camera]) == []


def test_a_namespace_means_all_in_it(steering: Lifecycle[HostProcess]) -> None:
    assert names(steering.hosts("restart", ["r", "s"])) == ["r/camera", "r/finder", "r/base+s/base"]


def test_reload_checks_the_code_first(
    steering: Lifecycle[HostProcess], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    broken = tmp_path / "broken.py"
    broken.write_text("x = 1\ndef (:\n")
    monkeypatch.setattr(Sources, "files", lambda *_: {broken})
    with pytest.raises(RequestError, match=r"broken\.py:2: .*; not reloaded, so the old code continues: r/camera"):
        steering.hosts("reload", ["r/camera"])
