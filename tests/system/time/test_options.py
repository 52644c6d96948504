"""Options of `fwk-launch`: duration, speed, parts, and a video."""

import re
from pathlib import Path

import cv2
import pytest

from tests.harness.fixtures import Launch
from tests.harness.logs import Recording

pytestmark = pytest.mark.system

FILE = "launch/orchestra.yaml"
ROOT = Path(__file__).parents[3]


def test_time_is_logical(launch: Launch, folder: Path) -> None:
    run = launch(FILE, "--time", "1.5", "--record", "log.lcm")
    assert run.wait() == 0, run.text
    *before, last = [record.time_us for record in Recording(folder / "log.lcm").records]
    assert last >= 1_500_000 > max(before)


def test_speed_scales_logical_time(launch: Launch, folder: Path) -> None:
    run = launch(FILE, "--time", "2", "--speed", "2")
    assert run.wait() == 0, run.text
    found = re.search(r"([\d.]+) s of logical time in ([\d.]+) s", run.text)
    assert found
    logical_s, wall_s = map(float, found.groups())
    assert wall_s >= 0.9 * (logical_s - 0.1) / 2  # a busy machine may be slower, never faster


@pytest.mark.parametrize(
    ("choice", "players"),
    [(("--only", "a/player", "b/player"), "ab"), (("--without", "world/conductor", "a", "d/player"), "bcef")],
)
def test_part_of_a_plan_runs_alone(launch: Launch, folder: Path, choice: tuple[str, ...], players: str) -> None:
    run = launch(FILE, *choice, "--ticks", "5", "--record", "log.lcm")
    assert run.wait() == 0, run.text
    recording = Recording(folder / "log.lcm")
    assert {channel.partition("/")[0] for channel in recording.messages} == set(players)
    assert recording.records[-1].time_us == 5 * 50_000  # without the conductor: the period
    assert recording.gaps() == {}


@pytest.mark.slow
def test_a_match_is_drawn_into_a_video(launch: Launch, tmp_path: Path) -> None:
    film = tmp_path / "film.mp4"
    run = launch(str(ROOT / "launch/one-robot.yaml"), "--ticks", "20", "--speed", "max", "--video", str(film))
    assert run.wait() == 0, run.text
    video = cv2.VideoCapture(str(film))
    pictures = 0
    while video.read()[0]:
        pictures += 1
    video.release()
    assert f"video: {film}, {pictures} pictures" in run.text
    assert pictures >= 20
