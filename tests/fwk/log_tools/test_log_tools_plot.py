"""Series of recorded values, and their drawing."""

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import cv2
import pytest
from typer.testing import CliRunner

from fwk.cli.commands import app
from fwk.cli.look.plot import plot
from fwk.cli.look.public_messages import Heard
from fwk.lcm.event_log import LogError
from fwk.log_tools.series import SeriesOf, series_in, unit_of
from lcmtypes.robot import odometry_t
from tests.fwk.log_tools.log_tools_made import heard, recording
from tests.fwk.recording.recording_made import entry, odometry


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


@pytest.mark.slow
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


def test_a_recording_is_drawn_into_the_terminal(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    words = ["plot", "cyan1/odometry.x_m", "cyan1/odometry.vx_m_s", "--from", str(recording(tmp_path / "log"))]
    shown = CliRunner().invoke(app, words).stdout
    assert "cyan1/odometry.x_m 0.5" in shown
    assert "[m/s] over s" in shown
    assert max(map(len, shown.splitlines())) <= 100
    assert "\x1b" not in shown
    monkeypatch.delitem(sys.modules, "fwk.log_tools.terminal_plot", raising=False)
    monkeypatch.setitem(sys.modules, "plotext", None)
    missing = CliRunner().invoke(app, words)
    assert missing.stderr == "error: plotext is not installed; type: pip install 'fwk[plot]'\n"


def heard_live(ticks: int) -> Iterator[Heard]:
    for tick in range(1, ticks + 1):
        channel, data, time_us = entry("cyan1/odometry", odometry(tick, 1), tick)
        yield Heard(channel, data, time_us)
        yield Heard("cyan1/other", b"12345678", time_us)
        yield Heard("cyan1/odometry", b"broken", time_us)


@pytest.mark.slow
def test_a_live_run_is_drawn_again_and_again(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    @contextmanager
    def listening(*_: object) -> Iterator[tuple[dict[str, str], Iterator[Heard]]]:
        yield {"name": "match"}, heard_live(ticks=100)

    monkeypatch.setattr("fwk.cli.look.plot.listening", listening)
    monkeypatch.setattr("fwk.cli.look.plot.monotonic_us", iter(range(0, 1 << 40, 300_000)).__next__)
    monkeypatch.setenv("FORCE_COLOR", "1")
    plot(["cyan1/odometry.x_m"], last=2.0)
    shown = capsys.readouterr().out
    assert "cyan1/odometry.x_m 0.05" in shown
    assert "cyan1/odometry.x_m 5" in shown
    assert "3.0" in shown.rpartition("cyan1/odometry.x_m")[2], "the last two seconds begin at 3 s"


def test_what_a_live_plot_needs_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    refused = CliRunner().invoke(app, ["plot", "a/b.x_m", "-o", str(tmp_path / "a.png")])
    assert (refused.exit_code, "name it with --from" in " ".join(refused.stderr.split())) == (2, True)
    monkeypatch.setenv("TTY_COMPATIBLE", "0")
    piped = CliRunner().invoke(app, ["plot", "a/b.x_m"])
    assert (piped.exit_code, "error: a live plot needs a terminal" in piped.stderr) == (2, True)


def test_values_of_the_past_are_forgotten() -> None:
    made = SeriesOf("run", ["cyan1/*.x_m"])
    for tick in range(1, 11):
        made.add("cyan1/odometry", odometry_t, odometry(tick, 1), tick * 0.05)
        made.add("cyan2/odometry", odometry_t, odometry(tick, 2), tick * 0.05)
    made.forget(before_s=0.4)
    (series,) = made.series
    assert series.label == "cyan1/odometry.x_m"
    assert series.times_s == pytest.approx([0.4, 0.45, 0.5])


def test_other_formats_and_a_missing_library_are_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    log = recording(tmp_path / "log", ticks=1)
    words = ["plot", "cyan1/odometry.x_m", "--from", str(log), "-o"]
    refused = CliRunner().invoke(app, [*words, str(tmp_path / "a.gif")])
    assert (refused.exit_code, "use .png or .svg" in refused.stderr) == (2, True)
    monkeypatch.delitem(sys.modules, "fwk.log_tools.plot", raising=False)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    missing = CliRunner().invoke(app, [*words, str(tmp_path / "a.png")])
    assert missing.stderr == "error: matplotlib is not installed; type: pip install 'fwk[plot]'\n"
