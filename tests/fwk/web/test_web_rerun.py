"""Messages, images and drawings of projects as entities of Rerun, read back from the file."""

import contextlib
import json
import signal
import socket
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rerun.chunk import RrdReader
from typer.testing import CliRunner

from fwk.cli.commands import app
from fwk.log_tools.live_frames import LiveFrames
from fwk.web.rerun_feed import RerunFeed
from lcmtypes.core import frame_t, log_t, picture_t, transform_t, transforms_t
from lcmtypes.robot import laser_scan_t
from lcmtypes.soccer import ball_percept_t, pose_t
from tests.fwk.log_tools.log_tools_made import PLAIN, recording
from tests.fwk.recording.recording_made import Entry, write
from tests.harness.commands import BIN

POSE = pose_t(x_m=1.0, y_m=2.0, localized=True)
PROJECT = """
from fwk.web import View

class Garden(View):
    title = "Garden"
    needs = ("cyan1/odometry",)
    channels = ("cyan1/odometry",)

    def draw(self, newest, scene):
        scene.bounds = (-4, -4, 4, 4)
        scene.layer("lawn")
        scene.polygon([(-4, -4), (4, -4), (4, 4), (-4, 4)], fill="#30803c")
        scene.layer("mower")
        x_m = newest("cyan1/odometry").x_m
        scene.circle(x_m, 0, 0.3, fill="#e53935", stroke="#ffffff")
        scene.text(x_m, 1, "mower", "#000")
"""


class Written:
    """Contents of a file of Rerun."""

    def __init__(self, file: Path) -> None:
        self.rows: dict[str, list[dict[str, Any]]] = {}
        for chunk in RrdReader(str(file)).stream():
            self.rows.setdefault(chunk.entity_path, []).extend(chunk.to_record_batch().to_pylist())

    def values(self, path: str, component: str) -> dict[int | None, Any]:
        """Returns the values of a component of an entity by tick; None: at all ticks."""
        return {row.get("tick"): row[component] for row in self.rows[path] if row.get(component) is not None}


def shown(folder: Path, entries: list[Entry], channels: tuple[str, ...] = ()) -> Written:
    """Writes a log with these messages as a file of Rerun and returns its contents."""
    log = write(folder / "log.lcm", [("fwk/plan", b"", 0), *entries])
    feed = RerunFeed("log", channels, (), folder)
    feed.save(folder / "log.rrd")
    feed.read(log)
    feed.close()
    return Written(folder / "log.rrd")


def at(tick: int, channel: str, message: Any) -> Entry:
    message.header.tick = message.header.sequence = tick
    message.header.time_us = 50_000 * tick
    return channel, message.encode(), 50_000 * tick


def test_positions_are_in_their_frame_with_heading_and_deviation(tmp_path: Path) -> None:
    seen = ball_percept_t(visible=True, x_m=3.0, covariance_m2=[[0.25, 0.0], [0.0, 0.01]])
    pose = pose_t(x_m=1.0, y_m=2.0, heading_rad=0.5, localized=True)
    written = shown(tmp_path, [at(1, "r/pose", pose), at(1, "r/ball", seen), at(2, "r/ball", ball_percept_t())])
    assert written.values("/r/pose/world", "Points3D:positions") == {1: [[1.0, 2.0, 0.0]]}
    assert written.values("/r/pose/world", "CoordinateFrame:frame") == {None: ["world"]}
    assert written.values("/r/ball/robot", "CoordinateFrame:frame") == {None: ["r/robot"]}
    assert written.values("/r/pose/frame", "Transform3D:child_frame") == {1: ["r/robot"]}
    (outline,) = written.values("/r/ball/robot/deviation", "LineStrips3D:strips")[1]
    assert max(point[0] for point in outline) == pytest.approx(3.0 + 2 * 0.5)
    assert written.values("/r/ball/robot", "Clear:is_recursive") == {2: [False]}, "the ball is out of sight"
    assert written.values("/r/pose/world/heading", "Arrows3D:vectors")[1][0][1] == pytest.approx(0.3 * np.sin(0.5))


def test_numbers_are_series_on_the_time_lines(tmp_path: Path) -> None:
    written = shown(tmp_path, [at(tick, "r/pose", pose_t(x_m=tick, heading_rad=0.1)) for tick in range(1, 501)])
    metres = written.values("/plots/r/pose/m", "Scalars:scalars")
    assert metres == {tick: [float(tick), 0.0] for tick in range(1, 501)}
    assert written.values("/plots/r/pose/m", "SeriesLines:names") == {None: ["r/pose.x_m", "r/pose.y_m"]}
    seconds = {row["tick"]: row["time"].total_seconds() for row in written.rows["/plots/r/pose/rad"] if row.get("tick")}
    assert seconds[40] == 2.0


def test_scans_transforms_and_images_are_shown(tmp_path: Path) -> None:
    scan = laser_scan_t(angle_step_rad=np.pi / 2, n_ranges=3, ranges_m=[1.0, float("inf"), 2.0])
    mounted = transforms_t(n=1, transforms=[transform_t(parent="r/robot", child="r/sensor", x_m=0.2, qw=1.0)])
    picture = picture_t(camera="r/image", format="jpeg", n=3, data=b"abc")
    written = shown(tmp_path, [at(1, "r/scan", scan), at(1, "r/mounts", mounted), at(1, "r/pictures", picture)])
    assert np.allclose(written.values("/r/scan/scan", "Points3D:positions")[1], [[1, 0, 0], [-2, 0, 0]], atol=1e-6)
    assert written.values("/r/mounts/r/sensor", "Transform3D:parent_frame") == {1: ["r/robot"]}
    assert written.values("/images/r/image", "EncodedImage:media_type") == {1: ["image/jpeg"]}


def test_images_of_a_run_come_from_its_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def pixels(_: LiveFrames, channel: str, announced: frame_t) -> Any:
        return np.full((20, 30, 3), announced.frame, np.uint8) if channel == "r/image" else None

    monkeypatch.setattr(LiveFrames, "pixels", pixels)
    log = write(tmp_path / "log", [at(tick, "r/image", frame_t(frame=tick)) for tick in range(1, 21)])
    feed = RerunFeed("run", (), (), tmp_path, pid=1)
    feed.save(tmp_path / "a.rrd")
    feed.read(log)
    feed.close()
    images = Written(tmp_path / "a.rrd").values("/images/r/image", "EncodedImage:blob")
    assert list(images) == [1, 5, 9, 13, 17], "five a second"


def test_log_lines_are_at_their_tick_and_move_no_other_message(tmp_path: Path) -> None:
    line = "fwk/log", log_t(tick=3, time_us=150_000, component="r/base", text="hot").encode(), 50_000
    written = shown(tmp_path, [at(1, "r/pose", POSE), line, at(2, "r/pose", POSE)])
    assert written.values("/log/r/base", "TextLog:text") == {3: ["r/base: hot"]}
    assert [*written.values("/r/pose/world", "Points3D:positions")] == [1, 2]


def test_the_command_writes_what_a_project_draws(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    recording(tmp_path / "log.lcm", ticks=6)
    (tmp_path / "garden_view.py").write_text(PROJECT)
    words = ["view", "--from", "log.lcm", "--save", "out.rrd", "--view", "garden_view", "--channels", "cyan1/*"]
    done = CliRunner().invoke(app, words)
    assert (done.exit_code, done.stdout) == (0, f"{tmp_path}/out.rrd: open it with: rerun {tmp_path}/out.rrd\n")
    written = Written(tmp_path / "out.rrd")
    assert list(written.values("/views/Garden/lawn/areas", "Mesh3D:vertex_positions")) == [1], "it never changes"
    assert len(written.values("/views/Garden/mower/lines", "LineStrips3D:strips")) == 6
    assert written.values("/views/Garden/mower/labels", "Points3D:labels")[6] == ["mower"]
    assert not [path for path in written.rows if PLAIN in path], "not chosen"
    assert written.values("/log/supervisor", "TextLog:text")[4] == ["supervisor: ball taken away"]


def test_bad_input_of_the_command_is_named(tmp_path: Path) -> None:
    wrong = CliRunner().invoke(app, ["view", "--from", "log", "--save", "out.mp4"])
    assert (wrong.exit_code, "a name such as run.rrd" in " ".join(wrong.stderr.replace("│", "").split())) == (2, True)
    log = recording(tmp_path / "log", ticks=1)
    words = ["view", "--from", str(log), "--save", str(tmp_path / "c.rrd"), "--json"]
    assert json.loads(CliRunner().invoke(app, words).stdout) == {"name": "log", "file": str(tmp_path / "c.rrd")}
    missing = CliRunner().invoke(app, ["view", "--from", str(log), "--save", str(tmp_path / "a.rrd"), "--view", "nix"])
    assert (missing.exit_code, "nix: cannot be imported" in missing.stderr) == (2, True)
    words = ["view", "--from", str(log), "--save", str(tmp_path / "b.rrd"), "--channels", "cyan1/odometri"]
    nothing = CliRunner().invoke(app, words)
    assert nothing.exit_code == 2
    assert "no channel matches 'cyan1/odometri'; did you mean 'cyan1/odometry'?" in nothing.stderr


def test_a_port_that_is_taken_is_named(tmp_path: Path) -> None:
    log = recording(tmp_path / "log", ticks=1)
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = int(other.getsockname()[1])
        done = CliRunner().invoke(app, ["view", "--from", str(log), "--web", "--port", str(port - 1)])
    assert (done.exit_code, done.stderr) == (1, f"error: port {port} is taken; choose another with --port\n")


def free_ports() -> int:
    """Returns a port that was free just now, as the next one was."""
    while True:
        with socket.socket() as first, socket.socket() as second:
            first.bind(("127.0.0.1", 0))
            port = int(first.getsockname()[1])
            with contextlib.suppress(OSError, OverflowError):
                second.bind(("127.0.0.1", port + 1))
                return port


@pytest.mark.slow
@pytest.mark.system
def test_ctrl_c_while_a_log_is_read_ends_the_page(tmp_path: Path) -> None:
    recording(tmp_path / "log.lcm", ticks=6)
    endless = PROJECT.replace(
        "        scene.bounds", "        print('drawing', flush=True)\n        time.sleep(60)\n        scene.bounds"
    )
    (tmp_path / "garden_view.py").write_text(f"import time\n{endless}")
    words = ["view", "--from", "log.lcm", "--web", "--view", "garden_view", "--port", str(free_ports()), "--json"]
    pipe = subprocess.PIPE
    with subprocess.Popen([str(BIN / "fwk"), *words], cwd=tmp_path, stdout=pipe, stderr=pipe, text=True) as process:
        assert process.stdout
        assert process.stderr
        assert "page" in json.loads(process.stdout.readline())
        assert process.stdout.readline() == "drawing\n"
        process.send_signal(signal.SIGINT)
        assert process.wait(30) == 0
        assert "Traceback" not in process.stderr.read()


@pytest.fixture
def page(tmp_path: Path, needs: Callable[..., None]) -> Iterator[str]:
    """The address of a page with a recording, for Chromium."""
    from tools.docs.rerun_picture import CHROMIUM

    needs(CHROMIUM)
    recording(tmp_path / "log.lcm", ticks=6)
    (tmp_path / "garden_view.py").write_text(PROJECT)
    words = ["view", "--from", "log.lcm", "--web", "--view", "garden_view", "--port", str(free_ports()), "--json"]
    with subprocess.Popen([str(BIN / "fwk"), *words], cwd=tmp_path, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout
        served = json.loads(process.stdout.readline())
        yield served["page"]
        process.send_signal(signal.SIGINT)
        assert process.wait(30) == 0
    assert served["page"].endswith(f"/?url={served['stream']}")


@pytest.mark.slow
@pytest.mark.system
def test_chromium_shows_the_page(page: str) -> None:
    from tools.docs.rerun_picture import picture_of, share_of

    lawn = b"\x30\x80\x3c"
    assert share_of(picture_of(page, lawn), lawn) > 0.02
