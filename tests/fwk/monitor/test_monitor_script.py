"""Scripts of `fwk monitor`, and the templates for them."""

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from fwk.cli.commands import app
from fwk.lcm.event_log import LogWriter
from fwk.monitor.script import Script, ScriptError, templates
from lcmtypes.core import frame_t
from lcmtypes.robot import gps_fix_t, imu_t, joint_state_t, joystick_t, laser_scan_t, odometry_t

MESSAGES: dict[str, tuple[str, Any, str]] = {
    "base": ("r/odometry", odometry_t(vx_m_s=3.0, vy_m_s=4.0, x_m=1.0), "5.00 m/s at (1.00, 0.00) m"),
    "camera": ("r/image", frame_t(frame=20, width_px=64, height_px=48), "frame 20, 64 x 48"),
    "gps": ("r/gps", gps_fix_t(kind=gps_fix_t.KINEMATIC, satellites=9, latitude_deg=50.0), "kinematic, 9 satellites"),
    "imu": ("r/imu", imu_t(yaw_rate_rad_s=3.141592653589793, ax_m_s2=2.0), "180.0 deg/s"),
    "joints": (
        "r/joints",
        joint_state_t(n_joints=2, names=["hip", "knee"], positions=[1, 2], velocities=[0, 0.5], efforts=[0, 0]),
        "knee at 2.000, +0.500",
    ),
    "joystick": (
        "r/joystick",
        joystick_t(n_axes=1, axes=[0.5], n_buttons=2, buttons=[False, True]),
        "axes +0.50, buttons [1]",
    ),
    "laser": (
        "r/scan",
        laser_scan_t(angle_step_rad=1.5707963267948966, range_max_m=9.0, n_ranges=3, ranges_m=[2.0, 0.5, float("inf")]),
        "0.50 m at 90 deg",
    ),
}
PLAIN = """
channels = ("r/imu",)
seen = []

def message(channel, message, time_us):
    seen.append(message.heading_rad)
    if message.heading_rad == 3.0:
        raise ValueError("three")

def end():
    print(channels, seen)
"""


@pytest.fixture
def script(tmp_path: Path) -> Path:
    (tmp_path / "mine.py").write_text(PLAIN)
    return tmp_path / "mine.py"


@pytest.fixture
def log(tmp_path: Path) -> Path:
    writer = LogWriter(tmp_path / "log.lcm", print)
    for number in range(5):
        writer.append("r/imu", imu_t(heading_rad=float(number)).encode(), number * 50_000)
        writer.append("r/pose", b"no message of any type", number * 50_000)
    writer.close()
    return tmp_path / "log.lcm"


@pytest.mark.parametrize("name", sorted(templates()))
def test_template_prints_what_its_hardware_says(tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str) -> None:
    channel, message, text = MESSAGES[name]
    (tmp_path / "it.py").write_text(templates()[name])
    made = Script(tmp_path / "it.py")
    for number in range(20):
        assert made.hear(channel, message.encode(), 1_000_000 + number * 50_000)
    made.end()
    assert text in capsys.readouterr().out


def test_printed_lines_become_json_lines(tmp_path: Path, log: Path) -> None:
    text = "channels = ('r/imu',)\ndef message(c, m, t): print('seen\\ntwice')\ndef end(): print('over')\n"
    (tmp_path / "it.py").write_text(text)
    words = ["monitor", str(tmp_path / "it.py"), "--from", str(log), "--count", "1", "--json"]
    assert [json.loads(line) for line in CliRunner().invoke(app, words).output.splitlines()] == [
        {"channel": "r/imu", "time_us": 0, "text": "seen"},
        {"channel": "r/imu", "time_us": 0, "text": "twice"},
        {"text": "over"},
    ]


def test_other_channels_are_not_given_to_the_script(script: Path) -> None:
    assert not Script(script).hear("r/other", imu_t().encode(), 0)


def test_failing_script_is_named_with_line_and_message(script: Path) -> None:
    with pytest.raises(ScriptError, match=r"mine\.py:8: ValueError: three \(r/imu at 7 us\)"):
        Script(script).hear("r/imu", imu_t(heading_rad=3.0).encode(), 7)
    with pytest.raises(ScriptError, match="r/imu: a message of an unknown type"):
        Script(script).hear("r/imu", b"garbage!", 7)


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("def message(: pass", r"mine\.py:1: SyntaxError"),
        ("1 / 0", r"mine\.py:1: ZeroDivisionError"),
        ("channels = ('a',)", "lacks 'channels'"),
        ("channels = 'a'\ndef message(*_): pass", "lacks 'channels'"),
    ],
)
def test_script_that_cannot_be_used_is_explained(script: Path, text: str, error: str) -> None:
    script.write_text(text)
    with pytest.raises(ScriptError, match=error):
        Script(script)


def test_command_reads_a_log_and_prints_templates(script: Path, log: Path) -> None:
    run = CliRunner().invoke
    some = run(app, ["monitor", str(script), "--from", str(log), "--count", "2"])
    assert (some.exit_code, some.output) == (0, "('r/imu',) [0.0, 1.0]\n")
    failing = run(app, ["monitor", str(script), "--from", str(log)])
    assert (failing.exit_code, "ValueError: three (r/imu at 150000 us)" in failing.output) == (1, True)
    assert run(app, ["monitor", "--template", "imu"]).output == templates()["imu"]
    assert len(run(app, ["monitor", "--template", "list"]).output.splitlines()) == len(templates())
    assert set(json.loads(run(app, ["monitor", "--template", "list", "--json"]).output)) == set(templates())
    assert run(app, ["monitor", "--template", "imo"]).exit_code == 2
    assert run(app, ["monitor"]).exit_code == 2
    assert run(app, ["monitor", "none.py"]).exit_code == 2
    assert sorted(templates()) == sorted(MESSAGES)
