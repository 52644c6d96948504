"""The ledger of marks, without processes."""

import pytest

from fwk import Component, Reads, Writes
from fwk.engine.visibility import Visibility, Void
from fwk.testing.plans import plan_of
from lcmtypes.robot import imu_t
from lcmtypes.soccer import pose_t


class Senses(Component):
    stage = "sensor_acquire"
    imu: Writes[imu_t]


class Locates(Component):
    stage = "worldstate"
    imu: Reads[imu_t]
    pose: Writes[pose_t]


class Thinks(Component):
    stage = "think"
    pose: Reads[pose_t]
    imu: Reads[imu_t]


ACQUIRE, WORLDSTATE, THINK = 1, 4, 5
IMU, POSE = 0, 1


@pytest.fixture
def ledger() -> Visibility:
    return Visibility(plan_of({"r/senses": Senses, "r/locates": Locates, "r/thinks": Thinks}))


def test_mark_goes_only_to_stages_that_read_the_channel(ledger: Visibility) -> None:
    ledger.begin()
    ledger.publish(POSE, 1)
    ledger.begin()
    assert ledger.news(THINK, 0) == ([POSE], [1])
    assert ledger.news(WORLDSTATE, 0) == ([], [])


def test_messages_of_a_running_stage_stay_hidden_when_repeated(
    ledger: Visibility,
) -> None:
    ledger.begin()
    ledger.publish(POSE, 1)
    assert ledger.news(THINK, 0) == ([], [])
    ledger.begin()
    ledger.publish(POSE, 2)
    assert ledger.news(THINK, 0) == ([POSE], [1])


def test_host_keeps_marks_for_its_components_of_later_stages() -> None:
    parts = {"r/senses": Senses, "r/locates": Locates, "r/thinks": Thinks}
    ledger = Visibility(plan_of(parts, groups=[["r/senses", "r/thinks"]]))
    ledger.begin()
    ledger.publish(POSE, 1)
    seen = ledger.begin()
    assert ledger.news(ACQUIRE, 0) == ([POSE], [1])
    ledger.begin()
    assert ledger.news(THINK, seen) == ([], [])


def test_only_changes_since_the_last_time_are_sent_again(ledger: Visibility) -> None:
    ledger.publish(IMU, 1)
    seen = ledger.begin()
    assert ledger.news(THINK, 0) == ([IMU], [1])
    ledger.publish(POSE, 1)
    ledger.begin()
    assert ledger.news(THINK, seen) == ([POSE], [1])


def test_stage_sees_its_own_messages_in_its_next_run(ledger: Visibility) -> None:
    seen = ledger.begin()
    ledger.publish(IMU, 5)
    ledger.begin()
    assert ledger.news(WORLDSTATE, seen) == ([IMU], [5])


def test_a_newcomer_gets_all_marks(ledger: Visibility) -> None:
    ledger.publish(IMU, 7)
    for _ in range(100):
        ledger.begin()
    ledger.publish(POSE, 3)
    ledger.begin()
    assert ledger.news(THINK, 0) == ([IMU, POSE], [7, 3])


def test_an_old_mark_does_not_lower_a_newer_one(ledger: Visibility) -> None:
    ledger.publish(IMU, 7)
    ledger.publish(IMU, 6)
    ledger.begin()
    assert ledger.marks[IMU] == 7


def test_channels_of_a_dead_writer_are_void_beyond_its_marks(ledger: Visibility) -> None:
    step = ledger.begin()
    ledger.publish(IMU, 9)
    ledger.void(host=0, incarnation=2, tick=3)
    assert ledger.voids_since(step) == [Void(IMU, 9, 3, 2, step)]
    ledger.begin()
    assert ledger.voids_since(ledger.begin()) == []
    assert ledger.sequences(0) == {"r/imu": 9}
