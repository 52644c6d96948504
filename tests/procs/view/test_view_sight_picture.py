"""The picture of a camera with what was found in it."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from lcmtypes.soccer import ball_percept_t, line_points_t, obstacle_percepts_t, obstacle_t
from procs.view import sight_picture
from procs.view.sight_picture import BALL, LINE, OBSTACLE, drawn
from procs.vision.colours import Picture
from procs.vision.mirror import Mirror
from tests.procs.vision.picture_parts import shades, write_folder

MIRROR = Mirror()


def test_findings_are_drawn_where_they_were_found() -> None:
    ball, obstacles, lines, obstacle = ball_percept_t(), obstacle_percepts_t(), line_points_t(), obstacle_t()
    ball.visible, ball.x_m = True, 2.0
    obstacle.y_m, obstacle.radius_m = 2.0, 0.25
    obstacles.obstacles = [obstacle]
    lines.x_m, lines.y_m = [-1.5], [-1.0]
    picture = drawn(np.zeros((400, 400, 3), np.uint8), MIRROR, ball, obstacles, lines)
    assert picture.shape == (800, 800, 3)
    for colour, place in (
        (BALL, (2.0, 0.0, 0.11)),
        (OBSTACLE, (0.0, 2.0, 0.0)),
        (LINE, (-1.5, -1.0, 0.0)),
    ):
        rows, columns = np.nonzero((picture == colour).all(axis=2))
        (expected,) = 2 * MIRROR.project(np.array([place]))
        assert np.hypot(columns.mean() - expected[0], rows.mean() - expected[1]) < 8.0


def test_ring_fits_the_size_of_the_ball() -> None:
    ball = ball_percept_t()
    ball.visible, ball.x_m = True, 2.0
    widths_px = []
    for radius_m in (0.05, 0.11, 0.2):
        black = np.zeros((400, 400, 3), np.uint8)
        picture = drawn(black, MIRROR, ball, obstacle_percepts_t(), line_points_t(), ball_radius_m=radius_m)
        widths_px.append(int(np.ptp(np.nonzero((picture == BALL).all(axis=2))[1])))
    assert widths_px[0] < widths_px[1] < widths_px[2]


def test_nothing_found_leaves_the_picture_as_it_is() -> None:
    frame = np.full((400, 400, 3), 77, np.uint8)
    empty = drawn(frame, MIRROR, ball_percept_t(), obstacle_percepts_t(), line_points_t(), scale=1)
    assert (empty == frame).all()


@pytest.mark.slow
def test_command_draws_the_camera_of_a_match(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "sight.png"
    words = ["sight_picture", str(file), "--launch", "soccer-1v1.yaml", "--robot", "cyan1", "--time", "0.4"]
    monkeypatch.setattr("sys.argv", words)
    sight_picture.main()
    picture = cv2.imread(str(file))
    assert picture is not None
    assert picture.shape == (2 * MIRROR.size_px, 2 * MIRROR.size_px, 3)
    assert (picture == LINE).all(axis=2).sum() > 100
    monkeypatch.setattr("sys.argv", [*words[:-4], "--robot", "cyan9", "--time", "0.1"])
    with pytest.raises(SystemExit, match="2"):
        sight_picture.main()
    assert "no omni_ball of cyan9" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "mistake"),
    [
        (["sight.xyz"], "'sight.xyz' ends in '.xyz'; it should end in .png or .jpg"),
        (["nowhere/sight.png"], "'nowhere/sight.png' cannot be written: there is no folder 'nowhere'"),
        (["sight.png", "--launch", "soccer-1vs1.yaml"], "no such launch file; did you mean 'soccer-1v1.yaml'?"),
        (
            ["sight.png", "--robot", "cyan9"],
            "soccer.yaml: no omni_ball of cyan9; robots with one: cyan1, cyan2, cyan3, cyan4",
        ),
        (["sight.png", "--launch", "soccer-truth.yaml"], "no omni_ball of cyan3; robots with one: none"),
        (
            ["sight.png", "--launch", "soccer-1v1.yaml", "--robot", "cyan1", "--time", "0"],
            "no picture of cyan1/image until 0 s; a later --time",
        ),
    ],
)
def test_command_says_what_is_wrong(
    words: list[str], mistake: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["sight_picture", "--time", "0.2", *words])
    with pytest.raises(SystemExit) as raised:
        sight_picture.main()
    assert raised.value.code == 2
    said = capsys.readouterr().err
    assert said.startswith("error: ")
    assert mistake in said


@pytest.mark.parametrize(
    ("words", "mistake"),
    [
        (["--time", "inf"], "'inf' is not a time; use seconds from 0 to 3600"),
        (["--time", "nan"], "'nan' is not a time"),
        (["--time", "-1"], "'-1' is not a time"),
        (["--seed", "-1"], "'-1' is not a seed; use a whole number from 0"),
    ],
)
def test_command_refuses_numbers_without_a_meaning(
    words: list[str], mistake: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["sight_picture", "sight.png", "--launch", "nowhere.yaml", *words])
    with pytest.raises(SystemExit, match="2"):
        sight_picture.main()
    assert mistake in capsys.readouterr().err


@pytest.mark.parametrize("launch", ["my own.yaml", "./my own.yaml", "parts/mine.yaml", "there.yaml"])
def test_command_takes_launch_files_of_the_user(launch: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """They are given by their paths, or lie in `launch/`."""
    for folder, name in (("", "my own"), ("parts", "mine"), ("launch", "there")):
        (tmp_path / folder).mkdir(exist_ok=True)
        (tmp_path / folder / f"{name}.yaml").write_text("include: soccer-1v1.yaml\nname: mine\n")
    monkeypatch.chdir(tmp_path)
    words = ["sight_picture", "sight.png", "--launch", launch, "--robot", "cyan1", "--time", "0.3"]
    monkeypatch.setattr("sys.argv", words)
    sight_picture.main()
    assert cv2.imread(str(tmp_path / "sight.png")) is not None


def sight_of(launch: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> Picture:
    """Returns the sight of cyan1 in a launch file after 0.4 s."""
    (folder / "mine.yaml").write_text(launch)
    monkeypatch.chdir(folder)
    words = ["sight_picture", "sight.png", "--launch", "mine.yaml", "--robot", "cyan1", "--time", "0.4"]
    monkeypatch.setattr("sys.argv", words)
    sight_picture.main()
    return np.asarray(cv2.imread(str(folder / "sight.png")), np.uint8)


def test_sight_of_a_camera_driver_is_drawn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The picture shows the part of the frames that the detectors see."""
    folder = write_folder(tmp_path / "seen", [np.dstack([each[:, :, :2], 0 * each[:, :, 2]]) for each in shades(9)])
    camera = f"{{use: procs.drivers.camera_driver, config: {{source: {folder}}}}}"
    detector = "{use: procs.vision.omni_ball, config: {mirror: {size_px: 200}}}"
    text = f"components:\n  cyan1/camera: {camera}\n  cyan1/omni_ball: {detector}\n"
    picture = sight_of(text, tmp_path, monkeypatch)
    assert picture.shape == (400, 400, 3)
    assert np.median(picture, axis=(0, 1)).tolist() == [56, 56, 0]


def test_launch_file_with_pictures_of_its_own_is_taken(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    own = "components: {world/pictures: {use: procs.view.pictures, config: {longest_px: 100}}}"
    picture = sight_of(f"include: soccer-1v1.yaml\nname: mine\n{own}\n", tmp_path, monkeypatch)
    assert (picture == LINE).all(axis=2).any()


def test_failure_of_a_component_is_an_error_in_a_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    words = ["sight_picture", "sight.png", "--launch", "vision.yaml", "--robot", "cyan1", "--time", "0.1"]
    monkeypatch.setattr("sys.argv", words)
    with pytest.raises(SystemExit) as raised:
        sight_picture.main()
    assert raised.value.code == 1
    said = capsys.readouterr().err
    assert said.startswith("error: vision.yaml: cyan1/camera: SourceError: 'pictures': No such file or directory; ")
    assert said.count("\n") == 1
