"""Programs in launch files: their ports are wired like those of classes, and their mistakes are found."""

import re
from pathlib import Path

import pytest

from fwk.model.errors import PlanError
from fwk.plan.load import LaunchOptions, load_plan


def loaded(folder: Path, entry: str) -> object:
    file = folder / "garden.yaml"
    file.write_text(f"components:\n  r/device: {entry}\n")
    return load_plan(str(file), LaunchOptions())


def test_ports_command_and_stage_are_in_the_plan(tmp_path: Path) -> None:
    file = tmp_path / "garden.yaml"
    file.write_text(
        """
templates:
  robot:
    device: {command: [sh, -c, "{namespace}"], stage: act, reads: {motor: robot.odometry_t}, channels: {motor: x},
             writes: {pose: robot.odometry_t}, config: {repeatable: true}}
    other: {command: sh, writes: {x: robot.odometry_t}}
robots: {r: {use: robot}}
"""
    )
    plan = load_plan(str(file), LaunchOptions())
    device, other = plan.components
    assert device.class_name == "Program(motor: Reads[robot.odometry_t], pose: Writes[robot.odometry_t])"
    assert (device.config["command"], other.config["command"]) == (["sh", "-c", "r"], ["sh"])
    assert (device.config["repeatable"], [plan.stages[each] for each in device.stages]) == (True, ["act"])
    assert {channel.name: channel.readers for channel in plan.channels} == {"r/x": (0,), "r/pose": ()}


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("{command: ./device}", "garden.yaml:2: r/device: no program './device' beside the launch file"),
        ("{command: no-such}", "no program 'no-such' on the path; for a file write ./NAME"),
        ("{command: sh, use: x}", "both 'use' and 'command'; keep one of them"),
        ("{use: x, reads: {a: b.c_t}}", "'reads', 'writes', 'serves' and 'calls' are for a program, with 'command'"),
        ("{command: sh, reads: {a: no.ball_t}}", "a: no LCM type 'no.ball_t'"),
        ("{command: sh, reads: {a b: robot.odometry_t}}", "is not a port; write ball: Reads[play.ball_t]"),
        ("{command: sh, reads: {a: robot.odometry_t}}", "no component writes 'r/a', which r/device reads as 'a'"),
        (
            "{command: sh, reads: {a: robot.odometry_t}, writes: {a: robot.odometry_t}}",
            "'a' is in 'reads' and 'writes'",
        ),
        ("{command: sh, calls: {a: robot.odometry_t}}", "robot.odometry_t is not a request"),
        ("{command: sh, reads: {a: [robot.odometry_t, robot.odometry_t]}}", "'components.r/device.reads.a' is ["),
        ("{command: sh, serves: {a: [soccer.kick_t, soccer.ball_t, c]}}", "is not a port"),
        ("{command: sh, reads: 3}", "'components.r/device.reads' is 3"),
        ("{command: []}", "'command' is []"),
        ("{command: sh, config: {answer_timeout: 3}}", "no setting 'answer_timeout'; did you mean 'answer_timeout_s'?"),
        ("{}", "the key 'components.r/device.use' is missing"),
    ],
)
def test_mistakes_are_reported_with_their_line(tmp_path: Path, entry: str, text: str) -> None:
    with pytest.raises(PlanError, match=re.escape(text)):
        loaded(tmp_path, entry)
