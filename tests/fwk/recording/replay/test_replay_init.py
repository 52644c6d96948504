"""`init` sees the same in a replay: sequence numbers, the blackboard, and frame numbers."""

from pathlib import Path

import numpy as np

from fwk import Blackboard, Component, VisionMaster, Writes
from fwk.model.channel_table import Fact, change_message
from fwk.model.tick_events import ChannelsChanged, HostLost, HostStarted, StageBegun, StageDone
from fwk.testing.plans import plan_of
from lcmtypes.core import frame_t
from lcmtypes.soccer import pose_t
from tests.fwk.recording.replay.replay_logs import HandMadeLog

THINK = 5
CAME = 1  # number of the change with which the component joins


class Witness(Component):
    """Reports what it saw in `init`: the newest number of its channel, and whether the blackboard names its writer."""

    stage = "think"
    blackboard: Blackboard
    camera: VisionMaster
    pose: Writes[pose_t]

    def init(self) -> None:
        self.pose.value.x_m = float(self.pose.sequence)
        self.pose.value.y_m = float(self.blackboard.writer("r/pose") == "r/witness")
        self.camera.publish(np.full((1, 1), 7, np.uint8))

    def loop(self) -> None:
        self.pose.write()


def pose(sequence: float, named: float) -> pose_t:
    made = pose_t()
    made.x_m, made.y_m = sequence, named
    return made


def frame(number: int) -> frame_t:
    made = frame_t()
    made.frame, made.slot, made.encoding = number, number % 4, "gray8"
    made.height_px = made.width_px = made.channels = 1
    return made


def test_init_after_restart_sees_what_it_saw_in_the_run(tmp_path: Path) -> None:
    log = HandMadeLog(tmp_path / "log.lcm", plan_of({"r/witness": Witness}))
    came = change_message(CAME, [Fact("come", 0)])
    stage = StageBegun(THINK, THINK)
    log.message("r/camera", frame(1), "r/witness", 1, THINK)
    log.message("r/pose", pose(0.0, 0.0), "r/witness", 1, THINK)
    log.tick(1, [HostStarted(0, 1, 0), ChannelsChanged(CAME), stage, StageDone(0, 1, THINK)], [came])
    log.message("r/camera", frame(2), "r/witness#2", 2, THINK)
    log.message("r/pose", pose(1.0, 1.0), "r/witness#2", 2, THINK)
    log.tick(2, [HostLost(0), HostStarted(0, 2, CAME), stage, StageDone(0, 2, THINK)])
    replay = log.replayed()
    assert [str(each) for each in replay.differences] == []
    assert replay.compared == 4
