"""An aspect that a component provides, in real processes: a robot's transforms from its own localization."""

import math
from pathlib import Path

import pytest

from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import PortBlock
from tests.programs.control_system import Steered

pytestmark = pytest.mark.system

FILE = str(Path(__file__).parents[3] / "launch" / "frames.yaml")


def test_sightings_are_transformed_to_the_true_ball(launch: Launch, tmp_path: Path) -> None:
    run = launch(FILE, "--ticks", "130", "--speed", "max", "--record", "log.lcm")
    assert run.wait() == 0, run.text
    recording = Recording(tmp_path / "log.lcm")
    truth = {each.header.tick: each for each in recording.decoded("world/ground_truth")}
    spots = recording.decoded("cyan1/ball_spot")
    assert len(spots) > 10
    assert {each.frame for each in spots} == {"world"}
    errors_m = [math.hypot(each.x_m - (true := truth[each.header.tick]).ball_x_m, each.y_m - true.ball_y_m)
                for each in spots]  # fmt: skip
    assert sorted(errors_m)[len(errors_m) // 2] < 0.3


def test_a_provider_stays_while_it_has_users_and_replays(launch: Launch, ports: PortBlock) -> None:
    run = Steered(launch(FILE, "--speed", "1"), ports)  # no more ticks than are waited for
    assert "cyan1/frame_tree is needed by cyan1/ball_spot" in run.fwk("unload", "cyan1/frame_tree", code=2)
    run.fwk("restart", "cyan1/frame_tree", "cyan1/ball_spot")
    run.ticks_pass()
    run.fwk("unload", "--force", "cyan1/frame_tree")
    assert {run.component(name)["state"] for name in ("cyan1/frame_tree", "cyan1/ball_spot")} == {"stopped"}
    run.fwk("load", "cyan1/ball_spot")
    run.ticks_pass()
    assert {run.component(name)["state"] for name in ("cyan1/frame_tree", "cyan1/ball_spot")} == {"running"}
    run.fwk("replay", str(run.end()), "--verify")
