"""The tree of a robot's frames, and a component that uses its transforms."""

import math
from typing import Any

import numpy as np
import pytest

from fwk import Clock, Component, Writes
from fwk.model.errors import PlanError
from fwk.testing import Bench, MemorySystem, launch_plan
from lcmtypes.core import transforms_t
from lcmtypes.soccer import ball_percept_t, pose_t
from procs.localization.frame_tree import FrameTree
from procs.world_model.ball_spot import BallSpot


class Senses(Component):
    """Drives one metre a tick along x and sees the ball two metres ahead, in the air."""

    stage = "sensor_process"
    seen = True
    pose: Writes[pose_t]
    ball_percept: Writes[ball_percept_t]

    def loop(self) -> None:
        self.pose.value.x_m += 1.0
        self.pose.value.localized = True
        self.ball_percept.value.visible, self.ball_percept.value.x_m = self.seen, 2.0
        self.ball_percept.value.z_m = 0.5
        self.pose.write()
        self.ball_percept.write()


class Delayed(Senses):
    """Sees the ball in pictures that are 0.1 s old."""

    clock: Clock

    def loop(self) -> None:
        self.ball_percept.value.capture_us = max(50_000, self.clock.now_us - 100_000)
        super().loop()


class Blind(Senses):
    """Drives and does not see the ball."""

    seen = False


def edges(bench: Bench) -> dict[tuple[str, str], Any]:
    message: transforms_t = bench.port("transforms").sent[-1]
    return {(each.parent, each.child): each for each in message.transforms}


def test_tree_has_mounted_frames_and_the_pose_once_known() -> None:
    bench = Bench(FrameTree, mounted={"camera": {"z_m": 0.5, "yaw_rad": math.pi}})
    bench.iterate()
    assert list(edges(bench)) == [("base", "camera"), ("base", "kicker")]
    camera = edges(bench)["base", "camera"]
    assert (camera.fixed, camera.z_m, camera.qw, camera.qz) == (True, 0.5, pytest.approx(0.0), pytest.approx(1.0))
    bench.port("pose").put(x_m=1.0, y_m=2.0, heading_rad=math.pi / 2, localized=True)
    bench.iterate()
    base = edges(bench)["world", "base"]
    assert (base.fixed, base.x_m, base.y_m, base.qz) == (False, 1.0, 2.0, pytest.approx(math.sin(math.pi / 4)))


def test_camera_and_kicker_are_where_the_shared_settings_say() -> None:
    bench = Bench(FrameTree, mirror={"height_m": 0.6}, robot={"radius_m": 0.3, "mouth_half_angle_deg": 60.0})
    bench.iterate()
    found = edges(bench)
    assert (found["base", "camera"].z_m, found["base", "kicker"].x_m) == pytest.approx((0.6, 0.15))


def test_base_may_not_be_the_world() -> None:
    with pytest.raises(ValueError, match="frames would form a cycle: base in base"):
        Bench(FrameTree, world="base")


def test_renamed_base_carries_camera_and_kicker() -> None:
    bench = Bench(FrameTree, base="chassis", mounted={"laser": {"parent": "camera"}})
    bench.iterate()
    assert list(edges(bench)) == [("chassis", "camera"), ("chassis", "kicker"), ("camera", "laser")]


@pytest.mark.parametrize(
    ("mounted", "mistake"),
    [
        ("{b: {parent: a}, a: {parent: b}}", "frames would form a cycle: a in b in a"),
        ("{world: {}}", "frames would form a cycle: world in base in world"),
        ("{base: {parent: camera}}", "frame 'base' has the parent 'world' and cannot also have 'camera'"),
        ("{laser: {parent: bse}}", "frame 'laser' has the parent 'bse'; there are base, camera, kicker, world"),
    ],
)
def test_wrong_frames_are_refused_at_launch(mounted: str, mistake: str) -> None:
    with pytest.raises(PlanError) as raised:
        launch_plan("frames.yaml", (f"cyan1/frame_tree.mounted={mounted}",))
    assert mistake in str(raised.value)


def test_transform_lookups_use_the_time_of_the_input() -> None:
    system = MemorySystem({"r/senses": Senses, "r/spot": BallSpot, "r/tree": FrameTree})
    spot = system.runners["r/spot"].component
    system.tick(5)
    sent = system.newest("r/ball_spot")
    assert (sent.frame, sent.capture_us, sent.x_m, sent.y_m, sent.z_m) == ("world", 250_000, 7.0, 0.0, 0.5)
    tf = spot.tf  # type: ignore[attr-defined]
    assert tf.frames == ["base", "camera", "kicker", "world"]
    assert tf.lookup("world", "camera", 125_000).apply(np.zeros(3)) == pytest.approx((2.5, 0.0, 0.75))
    assert not system.logged


def test_without_a_pose_the_spot_states_the_reason_once() -> None:
    bench = Bench(BallSpot)
    for _ in range(3):
        bench.port("ball_percept").put(visible=True, x_m=1.0)
        bench.iterate()
    assert bench.port("ball_spot").sent == []
    assert [line.text for line in bench.logged] == ["no spot of the ball: no frame 'world'; there is none"]


def test_spot_is_where_the_ball_was_at_the_exposure() -> None:
    system = MemorySystem({"r/senses": Delayed, "r/spot": BallSpot, "r/tree": FrameTree})
    system.tick(5)
    sent = system.newest("r/ball_spot")
    assert (sent.header.time_us, sent.capture_us, sent.x_m) == (250_000, 150_000, 5.0)


def test_ball_that_is_not_seen_has_no_spot() -> None:
    system = MemorySystem({"r/senses": Blind, "r/spot": BallSpot, "r/tree": FrameTree})
    system.tick(5)
    assert system.sent["r/ball_spot"] == []
    assert not system.logged
