"""The comparison counts the messages that it compares."""

from pathlib import Path

from typer.testing import CliRunner

from fwk import Component, Writes
from fwk.cli.commands import app
from fwk.model.tick_events import HostStarted, StageBegun, StageDone
from fwk.testing.plans import plan_of
from lcmtypes.soccer import pose_t
from tests.fwk.recording.replay.replay_logs import HandMadeLog

THINK = 5


class Counter(Component):
    """Counts its iterations."""

    stage = "think"
    pose: Writes[pose_t]

    def loop(self) -> None:
        self.pose.value.x_m += 1.0
        self.pose.write()


def test_messages_before_from_tick_are_not_called_equal(tmp_path: Path) -> None:
    log = HandMadeLog(tmp_path / "log.lcm", plan_of({"r/counter": Counter}))
    for tick, x_m in enumerate([9.0, 2.0, 3.0], start=1):
        recorded = pose_t()
        recorded.x_m = x_m
        log.message("r/pose", recorded, "r/counter", tick, THINK)
        began = [HostStarted(0, 1, 0)] if tick == 1 else []
        log.tick(tick, [*began, StageBegun(THINK, THINK), StageDone(0, tick, THINK)])
    log.replayed()
    command = ["replay", str(log.path), "--verify"]
    assert "different: 1 of 3 messages" in CliRunner().invoke(app, command).stdout
    said = CliRunner().invoke(app, [*command, "--from-tick", "2"]).stdout
    assert "equal: 2 messages are byte for byte what was recorded" in said
