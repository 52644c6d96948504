"""Output of `fwk check`, as people and scripts see it."""

from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from fwk.cli.check.check import check

FILE = """
components:
  a/wheels: {use: plan_parts:Wheels, config: {gain: 0.25}}
  a/pilot: {use: plan_parts:Pilot}
outside: {b/odometry: robot.odometry_t}
"""


@pytest.fixture
def fwk(folder: Path) -> typer.Typer:
    (folder / "it.yaml").write_text(FILE)
    app = typer.Typer()
    app.command()(check)
    return app


def test_a_good_file_is_summed_up(fwk: typer.Typer) -> None:
    result = CliRunner().invoke(fwk, ["it.yaml"])
    assert result.exit_code == 0
    assert result.stdout == "it: 2 components, 3 channels, 2 processes, 10 stages, 20 ticks/s\n"
    one = CliRunner().invoke(fwk, ["it.yaml", "--hosting", "single", "--without", "a/pilot", "--set", "period_s=0.1"])
    assert one.stdout == "it: 1 component, 3 channels, 1 process, 10 stages, 10 ticks/s\n"


def test_changes_by_host_file_and_options_are_shown(fwk: typer.Typer, folder: Path) -> None:
    (folder / "it.host.yaml").write_text("config: {a: {}}\n")
    (folder / "it.host.yaml").write_text("config: {a/wheels: {mode: hard}}\n")
    sets = ("--set", "a/wheels.limits.speed_m_s=1", "--set", "a/wheels.brake=false")
    result = CliRunner().invoke(fwk, ["it.yaml", *sets])
    assert result.stdout.splitlines()[1:] == [
        "a/wheels.brake = false (--set)",
        "a/wheels.mode = hard (it.host.yaml:1)",
        "a/wheels.limits.speed_m_s = 1.0 (--set)",
    ]


def test_the_channels_are_listed(fwk: typer.Typer) -> None:
    lines = CliRunner().invoke(fwk, ["it.yaml", "--channels"]).stdout.splitlines()[1:]
    assert [line.split() for line in lines] == [
        ["channel", "type", "writer", "stage", "readers"],
        ["a/motor_command", "robot.motor_command_t", "a/pilot", "act", "a/wheels"],
        ["a/odometry", "robot.odometry_t", "a/wheels", "sensor_acquire,", "act_exec", "a/pilot"],
        ["b/odometry", "robot.odometry_t", "programs", "outside"],
    ]
    lines = CliRunner().invoke(fwk, ["it.yaml", "--channels", "--without", "a/pilot"]).stdout.splitlines()[2:]
    assert lines[0].split() == ["a/motor_command", "robot.motor_command_t", "none", "a/wheels"]


def test_the_settings_are_listed_with_their_origins(fwk: typer.Typer) -> None:
    lines = CliRunner().invoke(fwk, ["it.yaml", "--settings"]).stdout.splitlines()[2:]
    assert lines[0].split() == ["a/wheels.gain", "0.25", "it.yaml:3"]
    assert ["a/wheels.limits.turns", "[-1.0,", "1.0]", "default"] in [line.split() for line in lines]
    assert ["a/wheels.brake", "true", "default"] in [line.split() for line in lines]
    assert lines[-1].split() == ["a/pilot.log_level", "info", "default"]


def test_mistakes_end_with_code_2(fwk: typer.Typer) -> None:
    result = CliRunner().invoke(fwk, ["it.yaml", "--set", "a/wheels.gian=1", "--without", "c"])
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.splitlines() == [
        "--set: a/wheels: no setting 'gian'; did you mean 'gain'?",
        "--without: 'c' matches no component; there are a, a/pilot, a/wheels",
        "2 mistakes",
    ]
