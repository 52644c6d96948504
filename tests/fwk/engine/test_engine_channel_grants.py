"""Requests to the blackboard and the grants, without processes."""

from typing import Any

import pytest

from fwk import Blackboard, Component, Reads, VisionMaster, Writes
from fwk.engine.channel_grants import ChannelGrants
from fwk.lcm.messages import fingerprint, type_name
from fwk.model.channel_table import BlackboardEvent, ChannelTable, Fact, facts_of, text_of
from fwk.model.plan import Plan
from fwk.testing.plans import plan_of
from lcmtypes.core import frame_t
from lcmtypes.robot import imu_t, odometry_t

A, B, READER = 0, 1, 2
IMU = (type_name(imu_t), fingerprint(imu_t).hex())
ODOMETRY = (type_name(odometry_t), fingerprint(odometry_t).hex())
FRAME = (type_name(frame_t), fingerprint(frame_t).hex())


class Opener(Component):
    stage = "think"
    blackboard: Blackboard
    imu: Writes[imu_t]


class Camera(Component):
    stage = "act"
    image: VisionMaster


class Reader(Component):
    stage = "act"
    imu: Reads[imu_t]


def plan(spare_channels: int = 8) -> Plan:
    return plan_of({"a/opener": Opener, "b/opener": Opener, "a/reader": Reader}, spare_channels=spare_channels)


def begun(spare_channels: int = 8) -> ChannelGrants:
    """Returns grants with all components present."""
    made = ChannelGrants(plan(spare_channels))
    for component in (A, B, READER):
        made.came(component, 1)
    made.decide()
    return made


def decided(grants: ChannelGrants) -> list[tuple[str, int, str]]:
    """Returns kind, component, and channel or reason."""
    facts, _ = grants.decide()
    return [(fact.kind, fact.component, fact.channel.name if fact.channel else fact.reason) for fact in facts]


def happened(grants: ChannelGrants) -> list[tuple[str, str, str]]:
    _, events = grants.decide()
    return [(event.kind, event.channel, event.component) for event in events]


def test_a_starting_component_writes_and_reads_what_it_declares() -> None:
    grants = ChannelGrants(plan())
    grants.came(READER, 1)
    grants.came(A, 1)
    assert grants.asked
    assert happened(grants) == [("writer_added", "a/imu", "a/opener"), ("reader_added", "a/imu", "a/reader")]
    assert not grants.asked
    imu = grants.table.find("a/imu")
    assert imu
    assert (grants.table.writer(imu), grants.table.readers(imu)) == ("a/opener", ("a/reader",))
    grants.left(A)
    assert happened(grants) == [("writer_removed", "a/imu", "a/opener")]
    assert grants.table.writer(imu) == ""


def test_first_open_creates_and_last_close_destroys_a_channel() -> None:
    grants = begun()
    grants.ask(1, 0, "a/opener", [["read", 1, "x/spot", *IMU]])
    assert happened(grants) == [
        ("instance_created", "x/spot", "a/opener"),
        ("reader_added", "x/spot", "a/opener"),
    ]
    grants.ask(2, 0, "b/opener", [["write", 1, "x/spot", *IMU]])
    assert happened(grants) == [("writer_added", "x/spot", "b/opener")]
    grants.ask(3, 0, "a/opener", [["close", 1]])
    assert happened(grants) == [("reader_removed", "x/spot", "a/opener")]
    grants.ask(4, 0, "b/opener", [["close", 1]])
    assert happened(grants) == [
        ("writer_removed", "x/spot", "b/opener"),
        ("instance_destroyed", "x/spot", "b/opener"),
    ]


def test_requests_are_granted_by_tick_step_sender_and_number() -> None:
    grants = begun()
    grants.ask(2, 0, "a/opener", [["write", 2, "x/late", *IMU]])
    grants.ask(1, 1, "a/opener", [["write", 1, "x/spot", *IMU]])
    grants.ask(1, 0, "b/opener", [["write", 1, "x/spot", *IMU], ["read", 2, "x/late", *IMU]])
    assert [(component, name) for _, component, name in decided(grants)] == [
        (B, "x/spot"),
        (B, "x/late"),
        (A, "x/spot: b/opener is its writer; a/opener has to wait"),
        (A, "x/late"),
    ]


@pytest.mark.parametrize(
    ("wish", "reason"),
    [
        (["write", 1, "b/imu", *IMU], "b/opener is its writer by the plan; a/opener can only read it"),
        (["write", 1, "out/joy", *IMU], "programs outside write it by the plan; a/opener can only read it"),
        (["write", 1, "b/spot", *IMU], "b/opener is its writer; a/opener has to wait"),
        (
            ["read", 1, "b/imu", *ODOMETRY],
            f"a/opener wants it as robot.odometry_t ({ODOMETRY[1]}), but it is robot.imu_t ({IMU[1]}) to b/opener",
        ),
        (
            ["read", 1, "out/joy", *ODOMETRY],
            f"a/opener wants it as robot.odometry_t ({ODOMETRY[1]}), but it is robot.imu_t ({IMU[1]})",
        ),
        (
            ["write", 1, "x/read", *ODOMETRY],
            f"a/opener wants it as robot.odometry_t ({ODOMETRY[1]}), but it is robot.imu_t ({IMU[1]}) to b/opener",
        ),
        (["read", 1, "c/image", *FRAME], "its frames are in shared memory; annotate with Image instead"),
        (["write", 1, "c/image", *FRAME], "its frames are in shared memory; annotate with Image instead"),
        (
            ["read", 1, "x/more", *IMU],
            "all 2 spare channels are in use; set 'spare_channels: N' in the launch file for more",
        ),
    ],
)
def test_a_refusal_names_both_sides(wish: list[Any], reason: str) -> None:
    components: dict[str, type[Component]] = {"a/opener": Opener, "b/opener": Opener, "c/camera": Camera}
    grants = ChannelGrants(plan_of(components, outside={"out/joy": "robot.imu_t"}, spare_channels=2))
    for component in range(len(components)):
        grants.came(component, 1)
    grants.ask(1, 0, "b/opener", [["write", 1, "b/spot", *IMU], ["read", 2, "x/read", *IMU]])
    grants.decide()
    grants.ask(2, 0, "a/opener", [wish])
    assert decided(grants) == [("refuse", A, f"{wish[2]}: {reason}")]


def test_there_are_as_many_channels_as_the_plan_has_spare() -> None:
    grants = begun(spare_channels=1)
    grants.ask(1, 0, "a/opener", [["write", 1, "x/one", *IMU], ["write", 2, "x/two", *IMU]])
    assert [kind for kind, _, _ in decided(grants)] == ["write", "refuse"]
    grants.ask(2, 0, "a/opener", [["close", 1]])
    assert [kind for kind, _, _ in decided(grants)] == ["close"]
    grants.ask(3, 0, "a/opener", [["write", 3, "x/one", *IMU], ["write", 4, "x/one", *ODOMETRY]])
    facts, _ = grants.decide()
    assert [fact.kind for fact in facts] == ["write", "refuse"]
    assert facts[0].channel
    assert facts[0].channel.index == len(plan().channels)


def test_pattern_follows_channels_of_its_type_without_owning() -> None:
    grants = begun()
    grants.ask(1, 0, "a/opener", [["each", 1, "*/imu", *IMU], ["each", 2, "x/*", *IMU]])
    assert decided(grants) == [("read", A, "a/imu"), ("read", A, "b/imu")]
    grants.ask(2, 0, "b/opener", [["write", 1, "x/spot", *IMU], ["write", 2, "x/other", *ODOMETRY]])
    assert decided(grants)[2:] == [("read", A, "x/spot")]
    grants.ask(3, 0, "b/opener", [["close", 1]])
    assert decided(grants) == [("close", B, "x/spot"), ("close", A, "x/spot")]
    assert grants.table.find("x/spot") is None


def test_leaving_component_closes_channels_and_voids_requests() -> None:
    grants = begun()
    grants.ask(1, 0, "a/opener", [["write", 1, "x/spot", *IMU], ["read", 2, "b/imu", *IMU]])
    grants.decide()
    grants.ask(2, 0, "a/opener", [["write", 3, "x/more", *IMU]])
    grants.left(A)
    grants.came(A, 2)
    _, events = grants.decide()
    assert BlackboardEvent("instance_destroyed", "x/spot", "robot.imu_t", "a/opener") in events
    assert grants.table.find("x/more") is None
    assert A in grants.table.present


def test_a_busy_component_is_served_later() -> None:
    grants = begun()
    grants.ask(1, 0, "a/opener", [["write", 1, "x/spot", *IMU]])
    grants.left(B)
    assert grants.decide(lambda _: True) == ([], [])
    assert grants.asked
    assert [kind for kind, _, _ in decided(grants)] == ["go", "write"]


def test_facts_travel_and_a_snapshot_makes_the_same_table() -> None:
    grants = begun()
    grants.ask(1, 0, "a/opener", [["write", 1, "x/spot", *IMU], ["read", 2, "b/imu", *IMU], ["read", 3, "y/z", *IMU]])
    facts, _ = grants.decide()
    assert facts_of(text_of(facts)) == facts
    refused = [Fact("refuse", 1, 2, reason="because")]
    assert facts_of(text_of(refused)) == refused
    copy = ChannelTable(plan())
    copy.apply(facts_of(text_of(grants.table.snapshot())))
    views = [[table.view(each) for each in table.matching("*")] for table in (copy, grants.table)]
    assert views[0] == views[1]
