"""Series of recorded values, and their drawing."""

import json
import sys
from pathlib import Path

import cv2
import pytest
from typer.testing import CliRunner

from fwk.cli.commands import app
from fwk.lcm.event_log import LogError
from fwk.log_tools.series import series_in, unit_of
from tests.fwk.log_tools.log_tools_made import heard, recording


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("x_m", "m"),
        ("ball.vx_m_s", "m/s"),
        ("ax_m_s2", "m/s²"),
        ("covariance_m2.0.1", "m²"),
        ("heading_rad", "rad"),
        ("capture_us", "µs"),
        ("known", ""),
        ("items", ""),
    ],
)
def test_a_name_ends_with_its_unit(name: str, unit: str) -> None:
    assert unit_of(name) == unit


def test_series_have_times_and_numbers(tmp_path: Path) -> None:
    log = recording(tmp_path / "log", ticks=4)
    series, notes = series_in(log, ["cyan1/world_model.ball.x_m", "*/odometry.x_m", "cyan1/world_model.ball.known"])
    assert [(each.label, each.unit) for each in series] == [
        ("cyan1/world_model.ball.x_m", "m"),
        ("cyan1/odometry.x_m", "m"),
        ("cyan1/world_model.ball.known", ""),
    ]
    assert series[0].values == pytest.approx([0.1, 0.2, 0.3, 0.4])
    assert series[1].times_s == [0.05, 0.1, 0.15, 0.2]
    assert series[2].values == [1, 1, 1, 1]
    assert [note.text for note in notes] == ["ball taken away"]


def test_wall_time_counts_from_the_first_message(tmp_path: Path) -> None:
    (series,), _ = series_in(heard(tmp_path / "log", ticks=3), ["cyan2/odometry.x_m"])
    assert series.times_s == [0.0, 0.05, 0.1]


@pytest.mark.parametrize(
    ("path", "reason"),
    [
        ("cyan1/odometry", "'cyan1/odometry' is not a field of a channel; use CHANNEL.FIELD"),
        ("cyan1/odometri.x_m", "no channel matches 'cyan1/odometri'; did you mean 'cyan1/odometry'"),
        ("cyan1/odometry.x_mm", "cyan1/odometry: no field 'x_mm' in robot.odometry_t; did you mean 'x_m'"),
        ("cyan1/world_model.mates", "cyan1/world_model.mates is a list, not a number"),
        ("cyan1/world_model.ball_holder", "cyan1/world_model.ball_holder is a text, not a number"),
    ],
)
def test_a_path_without_numbers_is_refused(tmp_path: Path, path: str, reason: str) -> None:
    with pytest.raises(LogError) as error:
        series_in(recording(tmp_path / "log", ticks=1), [path])
    assert reason in str(error.value)


def test_the_command_draws_pictures(tmp_path: Path) -> None:
    log, out = recording(tmp_path / "log"), tmp_path / "drive.png"
    words = ["plot", "cyan1/odometry.x_m", "cyan1/odometry.vx_m_s", "--from", str(log), "-o"]
    result = CliRunner().invoke(app, [*words, str(out), "--json"])
    assert json.loads(result.stdout)["series"][1] == {"series": "cyan1/odometry.vx_m_s", "unit": "m/s", "values": 10}
    picture = cv2.imread(str(out))
    assert picture is not None
    assert (picture.shape, len(set(map(tuple, picture.reshape(-1, 3)))) > 50) == ((640, 1000, 3), True)
    assert CliRunner().invoke(app, [*words, str(out)]).exit_code == 2, "the picture exists"
    drawn = [tmp_path / "a.svg", tmp_path / "b.svg"]
    assert [CliRunner().invoke(app, [*words, str(each)]).exit_code for each in drawn] == [0, 0]
    assert drawn[0].read_bytes() == drawn[1].read_bytes()
    assert "ball taken away" in drawn[0].read_text()


def test_other_formats_and_a_missing_library_are_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    log = recording(tmp_path / "log", ticks=1)
    words = ["plot", "cyan1/odometry.x_m", "--from", str(log), "-o"]
    refused = CliRunner().invoke(app, [*words, str(tmp_path / "a.gif")])
    assert (refused.exit_code, "use .png or .svg" in refused.stderr) == (2, True)
    monkeypatch.delitem(sys.modules, "fwk.log_tools.plot", raising=False)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    missing = CliRunner().invoke(app, [*words, str(tmp_path / "a.png")])
    assert missing.stderr == "error: matplotlib is not installed; type: pip install 'fwk[plot]'\n"
