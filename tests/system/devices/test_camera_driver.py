"""The match's detectors on recorded pictures, in a real run: `fwk-launch vision.yaml`."""

import os
import signal
from pathlib import Path

import numpy as np
import pexpect
import pytest

from procs.vision.colours import Picture
from tests.harness.commands import BIN
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording, difference
from tests.harness.runs import TIMEOUT_S, PortBlock, fwk, replayed
from tests.procs.vision.picture_parts import read, shades, simulated, write_folder, write_video
from tests.programs.control_system import Steered

pytestmark = pytest.mark.system

TICKS = 12


@pytest.fixture(scope="module")
def film(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path, dict[str, list[bytes]]]:
    """A folder and a video of simulated frames, and the detectors' messages about them."""
    pictures, live = simulated(TICKS)
    folder = tmp_path_factory.mktemp("film")
    return write_folder(folder / "pictures", pictures), write_video(folder / "film.mp4", pictures), live.sent


def source(path: Path) -> tuple[str, str]:
    return "--set", f"cyan1/camera.source={path}"


def test_detectors_see_the_same_in_a_folder_as_in_the_camera(
    launch: Launch, film: tuple[Path, Path, dict[str, list[bytes]]], tmp_path: Path
) -> None:
    folder, _, said = film
    run = launch("vision.yaml", *source(folder), "--ticks", str(TICKS), "--speed", "max", "--record", "a.lcm")
    assert run.wait() == 0, run.text
    recording = Recording(tmp_path / "a.lcm")
    for channel in ("cyan1/ball_percept", "cyan1/line_points", "cyan1/obstacle_percepts"):
        assert recording.messages[channel] == said[channel]
    replayed(tmp_path, log="a.lcm")


def test_a_video_gives_the_same_messages_in_every_process_layout(
    launch: Launch, film: tuple[Path, Path, dict[str, list[bytes]]], tmp_path: Path
) -> None:
    for hosting in ("process", "single"):
        run = launch(
            *("vision.yaml", *source(film[1]), "--ticks", str(TICKS + 3), "--speed", "max"),
            *("--hosting", hosting, "--record", f"{hosting}.lcm"),
        )
        assert run.wait() == 0, run.text
        assert f"film.mp4 has ended after picture {TICKS}; no more frames" in run.text
    assert difference(tmp_path / "process.lcm", tmp_path / "single.lcm") == ""
    percepts = Recording(tmp_path / "single.lcm").decoded("cyan1/ball_percept")
    assert [percept.visible for percept in percepts] == [True] * TICKS


def test_a_restarted_driver_resumes_at_the_picture_of_its_tick(
    launch: Launch, film: tuple[Path, Path, dict[str, list[bytes]]], ports: PortBlock, tmp_path: Path
) -> None:
    looping = ("--set", "cyan1/camera.at_end=loop")
    run = Steered(launch("vision.yaml", *source(film[1]), *looping, "--record", "a.lcm"), ports)
    run.steer("restart", "cyan1/camera")
    run.ticks_pass(TICKS)
    run.launched.signal(signal.SIGINT)
    assert run.launched.wait() == 0, run.launched.text
    percepts = Recording(tmp_path / "a.lcm").decoded("cyan1/ball_percept")
    assert len(percepts) > TICKS
    places = {(each.header.tick - 1) % TICKS: (each.x_m, each.y_m) for each in percepts}
    assert all(places[(each.header.tick - 1) % TICKS] == (each.x_m, each.y_m) for each in percepts)


def test_a_missing_source_is_named_before_anything_starts(launch: Launch) -> None:
    run = launch("vision.yaml", "--set", "cyan1/camera.source=/dev/video99")
    assert run.wait() == 1, run.text
    assert "cyan1/camera: SourceError: '/dev/video99': No such file or directory; video devices" in run.text


@pytest.fixture
def with_pictures(tmp_path: Path) -> tuple[Path, list[Picture]]:
    """A launch file with lossless pictures of all cameras on the bus, and its camera's frames, repeated."""
    pictures = shades(5)
    folder = write_folder(tmp_path / "seen", pictures)
    camera = f"{{use: procs.drivers.camera_driver, config: {{source: {folder}, at_end: loop}}}}"
    on_the_bus = "{use: procs.view.pictures, config: {rate_hz: 0, format: png}}"
    text = f"components:\n  cyan1/camera: {camera}\n  world/pictures: {on_the_bus}\n"
    (tmp_path / "pictures.yaml").write_text(text)
    return tmp_path / "pictures.yaml", pictures


def test_fwk_cam_shows_the_pictures_of_a_running_camera(
    launch: Launch, ports: PortBlock, with_pictures: tuple[Path, list[Picture]], tmp_path: Path
) -> None:
    file, pictures = with_pictures
    run = Steered(launch(file.name, "--set", f"public_url={ports.public_url}"), ports)
    assert run.json("cam")[0]["writer"] == "cyan1/camera"
    for name in ("cyan1/camera", "cyan1/image"):
        assert "120 x 160 x 3" in run.fwk("cam", name, "--save", "one.png")
        assert any(np.array_equal(read(tmp_path / "one.png"), each) for each in pictures)
    assert "did you mean 'cyan1/camera'" in run.fwk("cam", "cyan1/camra", "--save", "one.png", code=2)
    run.ticks_pass(3)
    log = run.end()
    fwk(tmp_path, "cam", "cyan1/camera", "--log", log, "--save", "all/")
    saved = sorted((tmp_path / "all").iterdir())
    assert len(saved) > 3
    assert all(np.array_equal(read(path), pictures[at % 5]) for at, path in enumerate(saved))


def test_fwk_cam_draws_in_a_terminal(
    launch: Launch, ports: PortBlock, with_pictures: tuple[Path, list[Picture]], tmp_path: Path
) -> None:
    run = Steered(launch(with_pictures[0].name, "--set", f"public_url={ports.public_url}"), ports)
    command = f"{BIN / 'fwk'} cam cyan1/camera --bus-port {ports.bus}"
    env = {key: value for key, value in os.environ.items() if key not in ("COLUMNS", "LINES", "NO_COLOR")}
    terminal = pexpect.spawn(
        command,
        cwd=tmp_path,
        timeout=TIMEOUT_S,
        dimensions=(12, 60),
        encoding="utf-8",
        env={**env, "TERM": "xterm-256color"},
    )
    terminal.expect("cyan1/image, frame")
    drawn = terminal.before or ""
    assert drawn.count("▀") == 10 * 27  # two lines are left for the caption and the prompt
    terminal.expect(pexpect.EOF)
    run.end()
