"""Videos of recordings: one picture a tick, of the newest messages at its end."""

import json
import resource
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from fwk.cli.recordings.user_folders import use_folders
from fwk.cli.recordings.video import video as command
from fwk.model.plan import Plan
from fwk.model.plan_document import document_of
from fwk.recording import video_encoder
from fwk.recording.video import VideoError, drawing, render_video
from fwk.recording.video_encoder import Picture, advice, open_encoder
from fwk.testing import launch_plan
from lcmtypes.core import plan_t, protocol_t
from tests.fwk.recording.recording_made import entries, write

Newest = Callable[[str], Any]


def grey(newest: Newest) -> Picture | None:
    """As bright as the tick's number; needs odometry and world model of the same tick."""
    seen, model = newest("cyan2/odometry"), newest("cyan2/world_model")
    if seen is None:
        return None
    assert seen.header.tick == model.header.tick
    return np.full((48, 64, 3), 10 * seen.header.tick, np.uint8)


class Grey:
    """The same as a class."""

    def draw(self, newest: Newest) -> Picture | None:
        return grey(newest)


@pytest.fixture(params=["PyAV", "OpenCV"], autouse=True)
def library(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """The encoding library; both are installed for tests."""
    if request.param == "OpenCV":
        monkeypatch.setitem(sys.modules, "av", None)
    return str(request.param)


def played(file: Path) -> tuple[list[int], float]:
    """Returns the brightness of each picture, and the pictures a second."""
    capture = cv2.VideoCapture(str(file))
    found: list[int] = []
    while True:
        there, picture = capture.read()
        if not there:
            return found, float(capture.get(cv2.CAP_PROP_FPS))
        found.append(round(float(picture.mean())))


def test_each_tick_is_one_picture_at_the_speed_of_logical_time(tmp_path: Path) -> None:
    log = write(tmp_path / "log", entries(ticks=20))
    assert render_video(log, tmp_path / "out.mp4", grey).pictures == 20
    brightness, per_s = played(tmp_path / "out.mp4")
    assert brightness == pytest.approx([10 * tick for tick in range(1, 21)], abs=4)
    assert per_s == pytest.approx(20.0)


def test_pictures_begin_with_the_first_drawable_tick(tmp_path: Path) -> None:
    late = [made for made in entries(ticks=20) if made[0].startswith("cyan1") or made[2] > 500_000]
    assert render_video(write(tmp_path / "log", late), tmp_path / "out.mp4", grey).pictures == 10


def test_failures_are_reported(tmp_path: Path) -> None:
    log = write(tmp_path / "log", entries(ticks=3))
    with pytest.raises(VideoError, match="log: nothing to show"):
        render_video(log, tmp_path / "out.mp4", lambda newest: newest("nothing"))
    with pytest.raises(VideoError, match=r"out\.mp4: cannot write a video there"):
        render_video(log, tmp_path / "no folder" / "out.mp4", grey)
    with pytest.raises(VideoError, match="picture 2 is 64x20, not 64x10 as the first"):
        render_video(
            log, tmp_path / "out.mp4", lambda n: np.zeros((10 * n("cyan1/odometry").header.tick, 64, 3), np.uint8)
        )
    for name in ("no.such:module", "fwk.clock:nothing", ""):
        with pytest.raises(VideoError, match=f"no drawing '{name}': .*; use module:name"):
            drawing(name)


def test_a_video_on_a_full_disk_is_reported(tmp_path: Path) -> None:
    log, before = write(tmp_path / "log", entries(ticks=3)), resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (200, before[1]))  # Python ignores SIGXFSZ: writing fails instead
    try:
        with pytest.raises(VideoError, match=r"out\.mp4: cannot (be written|write a video)"):
            render_video(log, tmp_path / "out.mp4", grey)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_the_command_uses_the_drawing_of_the_recorded_run(tmp_path: Path) -> None:
    app = typer.Typer()
    app.command()(command)
    run = CliRunner().invoke
    log, out = write(tmp_path / "log", entries(ticks=3)), tmp_path / "out.mp4"
    alone = run(app, [str(tmp_path), "-o", str(out)])
    assert alone.exit_code == 1
    assert alone.stderr == f"error: {log}: no readable plan of its run in it; name the drawing with --draw\n"
    plan = Plan("x", "x.yaml", (), (), 50_000, "simulated", 1, (), (), (), video=f"{__name__}:Grey")
    said = plan_t()
    said.version, said.json = protocol_t.VERSION, json.dumps(document_of(plan))
    write(log, [("fwk/plan", said.encode(), 0), *entries(ticks=3)])
    drawn = run(app, [str(tmp_path), "-o", str(out)])
    assert drawn.exit_code == 0
    assert drawn.stdout.startswith(f"{out}, 3 pictures, ")
    told = json.loads(run(app, [str(log), "-o", str(out), "--draw", f"{__name__}:grey", "--json"]).stdout)
    assert (told["file"], told["pictures"]) == (str(out), 3)
    assert run(app, [str(log), "-o", "out.avi"]).exit_code == 2
    assert run(app, [str(tmp_path / "none"), "-o", str(out)]).exit_code == 2


@pytest.mark.parametrize(
    ("components", "name", "expected"),
    [("world/*", "robot", 0.4), ("world/*", "period_s", 0.25), ("a/*", "robot", 0.25)],
)
def test_drawings_get_the_settings_of_the_run(tmp_path: Path, components: str, name: str, expected: float) -> None:
    plan = launch_plan("soccer-1v1.yaml", ("shared.robot.radius_m=0.4",))
    said = plan_t(version=protocol_t.VERSION, json=json.dumps(document_of(plan)))
    log = write(tmp_path / "log", [("fwk/plan", said.encode(), 0), *entries(ticks=1)])
    found: list[float] = []

    def draw(newest: Any) -> Picture:
        found.append(newest.settings(components, name).get("radius_m", 0.25))
        return np.zeros((48, 64, 3), np.uint8)

    render_video(log, tmp_path / "out.mp4", draw)
    assert found == [expected]


def test_a_damaged_plan_gives_drawings_no_settings(tmp_path: Path) -> None:
    log = write(tmp_path / "log", [("fwk/plan", b"damaged", 0), *entries(ticks=1)])
    found: list[dict[str, Any]] = []

    def draw(newest: Any) -> Picture:
        found.append(newest.settings("*", "robot"))
        return np.zeros((48, 64, 3), np.uint8)

    render_video(log, tmp_path / "out.mp4", draw)
    assert found == [{}]


def test_an_interrupted_video_can_be_played(tmp_path: Path) -> None:
    log = write(tmp_path / "log", entries(ticks=20))

    def interrupt(pictures: int, _: float) -> None:
        if pictures == 12:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        render_video(log, tmp_path / "out.mp4", grey, interrupt)
    assert len(played(tmp_path / "out.mp4")[0]) == 12


def test_progress_names_pictures_and_logical_time(tmp_path: Path) -> None:
    told: list[tuple[int, float]] = []
    render_video(write(tmp_path / "log", entries(ticks=3)), tmp_path / "out.mp4", grey, lambda *each: told.append(each))
    assert [number for number, _ in told] == [1, 2, 3]
    assert [time_s for _, time_s in told] == pytest.approx([0.05, 0.1, 0.15])


def test_codec_is_named_with_advice_if_browsers_lack_it(tmp_path: Path) -> None:
    codec = render_video(write(tmp_path / "log", entries(ticks=3)), tmp_path / "out.mp4", grey).codec
    assert codec in ("H.264", "VP9", "MPEG-4 part 2")
    assert advice("H.264") == advice("VP9") == ""
    assert "pip install 'fwk[video]'" in advice("MPEG-4 part 2")


def test_the_best_installed_library_encodes(tmp_path: Path, library: str) -> None:
    made = open_encoder(tmp_path / "out.mp4", 20.0, 64, 48)
    assert isinstance(made, video_encoder.PyavEncoder if library == "PyAV" else video_encoder.OpencvEncoder)
    for number in range(5):
        made.write(np.full((48, 64, 3), 20 * number, np.uint8))
    made.close()
    assert len(played(tmp_path / "out.mp4")[0]) == 5


def test_folders_of_the_run_come_before_installed_modules(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "path", ["installed", str(tmp_path)])
    use_folders([str(tmp_path)])
    assert sys.path == [str(tmp_path), "installed"]
