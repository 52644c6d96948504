"""Lookahead of hosts: which stages they may run without waiting for others."""

from typing import Any

import pytest

from fwk import Blackboard, Component, Reads, VisionMaster, Writes
from fwk.component.images import Image
from fwk.engine.lookahead import Lookahead, lookahead
from fwk.testing.plans import plan_of
from lcmtypes.robot import imu_t
from lcmtypes.soccer import pose_t

ACQUIRE, PREPARE, THINK, ACT = 1, 2, 5, 7


class Sensor(Component):
    stage = "sensor_acquire"
    imu: Writes[imu_t]


class Thinker(Component):
    stage = "think"
    imu: Reads[imu_t]
    pose: Writes[pose_t]


class Actor(Component):
    stage = "act"
    pose: Reads[pose_t]


class Preparing(Thinker):
    stage = "sensor_prepare"


class Steady(Component):
    rate_hz = 10.0
    imu: Reads[imu_t]
    pose: Writes[pose_t]


class Opener(Component):
    stage = "act"
    pose: Reads[pose_t]
    blackboard: Blackboard


class Camera(Component):
    stage = "sensor_acquire"
    image: VisionMaster


class Viewer(Component):
    stage = "act"
    image: Image


def of_first(components: dict[str, type[Component]], group: list[str], **fields: Any) -> Lookahead:
    """Returns the lookahead of the host of a group."""
    return lookahead(plan_of(components, groups=[group], **fields))[0]


def test_whole_robot_runs_to_its_end() -> None:
    robot: dict[str, type[Component]] = {"r/sensor": Sensor, "r/thinker": Thinker, "r/actor": Actor}
    assert of_first(robot, list(robot)) == {ACQUIRE: ACT, THINK: ACT, ACT: ACT}


def test_robot_waits_for_what_others_write_between() -> None:
    robot: dict[str, type[Component]] = {"r/sensor": Sensor, "r/actor": Actor, "r/thinker": Thinker}
    assert of_first(robot, ["r/sensor", "r/actor"]) == {ACQUIRE: ACQUIRE, ACT: ACT}


def test_robot_waits_for_what_others_write_in_the_same_stage() -> None:
    robot: dict[str, type[Component]] = {"r/thinker": Thinker, "r/actor": Actor, "r/sensor": Sensor}
    robot |= {"r/other": Camera}
    assert of_first(robot, ["r/thinker", "r/actor"])[THINK] == ACT
    assert of_first({**robot, "r/thinker": Preparing}, ["r/other", "r/thinker"])[ACQUIRE] == ACQUIRE


def test_writers_of_earlier_stages_do_not_matter() -> None:
    robot: dict[str, type[Component]] = {"r/sensor": Sensor, "r/thinker": Thinker, "r/actor": Actor}
    assert of_first(robot, ["r/thinker", "r/actor"]) == {THINK: ACT, ACT: ACT}


@pytest.mark.parametrize(
    ("components", "group", "fields"),
    [
        pytest.param({"r/a": Sensor, "r/b": Thinker}, ["r/a", "r/b"], {"clock": "wall"}, id="real-time"),
        pytest.param({"r/a": Sensor, "r/b": Opener, "r/c": Thinker}, ["r/a", "r/b"], {}, id="dynamic-channels"),
        pytest.param({"r/a": Sensor, "r/b": Actor, "r/c": Steady}, ["r/a", "r/b"], {}, id="continuous-writer"),
        pytest.param({"r/a": Camera, "r/b": Viewer, "r/c": Viewer}, ["r/a", "r/b"], {}, id="frames-for-others"),
    ],
)
def test_no_lookahead(components: dict[str, type[Component]], group: list[str], fields: dict[str, Any]) -> None:
    ahead = of_first(components, group, **fields)
    assert len(ahead) == 2
    assert all(stage == last for stage, last in ahead.items())


def test_frames_for_the_own_host_do_not_matter() -> None:
    components: dict[str, type[Component]] = {"r/a": Camera, "r/b": Viewer}
    assert of_first(components, ["r/a", "r/b"]) == {ACQUIRE: ACT, ACT: ACT}
