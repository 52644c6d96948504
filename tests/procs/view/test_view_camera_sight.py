"""Detections of robots, drawn over the images of their cameras."""

import json
from dataclasses import replace
from typing import Any

import pytest

from fwk.web import Newest, Scene
from lcmtypes.core import frame_t
from lcmtypes.soccer import ball_candidate_t, ball_percept_t, line_points_t, obstacle_percepts_t, obstacle_t
from procs.view.web import MatchView
from procs.vision.calibration import MirrorConfig


def frame(width_px: int, height_px: int) -> frame_t:
    made = frame_t()
    made.width_px, made.height_px = width_px, height_px
    return made


def obstacles(*places: tuple[float, float]) -> obstacle_percepts_t:
    made = obstacle_percepts_t()
    for x_m, y_m in places:
        each = obstacle_t()
        each.x_m, each.y_m, each.radius_m = x_m, y_m, 0.25
        made.obstacles.append(each)
    made.n = len(places)
    return made


def sight(camera: str, **found: Any) -> list[dict[str, Any]]:
    scene = Scene()
    MatchView().sight(camera, Newest({f"cyan1/{name}": value for name, value in found.items()}), scene)
    shapes: list[dict[str, Any]] = json.loads(scene.encoded())["shapes"]
    return shapes


@pytest.mark.parametrize(("width_px", "height_px"), [(400, 400), (640, 480), (40, 30), (1650, 1640)])
def test_ball_and_lines_lie_over_their_pixels(width_px: int, height_px: int) -> None:
    ball = ball_percept_t()
    ball.visible, ball.x_m, ball.y_m = True, 2.0, 0.0
    lines = line_points_t()
    lines.n, lines.x_m, lines.y_m = 1, [0.0], [2.0]
    shapes = sight("cyan1/image", image=frame(width_px, height_px), ball_percept=ball, line_points=lines)
    (point,) = [shape for shape in shapes if shape["l"] == "lines"]
    ring, _ = [shape for shape in shapes if shape["l"] == "ball"]
    middle = (width_px - 1) / 2, (height_px - 1) / 2
    assert (ring["x"], point["y"]) == pytest.approx(middle, abs=0.6)
    away_px = replace(MirrorConfig().mirror(), size_px=min(width_px, height_px)).radius_px(2.0)
    assert middle[0] - point["x"] == pytest.approx(away_px, abs=1.0)
    assert 0 < middle[1] - ring["y"] < away_px * 1.1


def test_the_calibration_comes_from_the_settings() -> None:
    lines = line_points_t()
    lines.n, lines.x_m, lines.y_m = 1, [0.0], [2.0]
    size_px = MirrorConfig().size_px
    low = {("cyan1/omni_ball", "mirror.height_m"): 0.5, ("cyan2/omni_ball", "mirror.height_m"): 0.9}
    scene = Scene()
    messages = {"cyan1/image": frame(size_px, size_px), "cyan1/line_points": lines}
    MatchView().sight("cyan1/image", Newest(messages, low), scene)
    (point,) = json.loads(scene.encoded())["shapes"]
    away_px = MirrorConfig(height_m=0.5).mirror().radius_px(2.0)
    assert (size_px - 1) / 2 - point["x"] == pytest.approx(away_px, abs=1.0)
    assert abs(away_px - MirrorConfig().mirror().radius_px(2.0)) > 5.0


def test_a_smaller_ball_has_a_smaller_ring() -> None:
    ball, radii_px = ball_percept_t(), []
    ball.visible, ball.x_m = True, 2.0
    for radius_m in (0.05, 0.11):
        scene = Scene()
        settings = {("cyan1/omni_ball", "ball.radius_m"): radius_m}
        messages = {"cyan1/image": frame(400, 400), "cyan1/ball_percept": ball}
        MatchView().sight("cyan1/image", Newest(messages, settings), scene)
        radii_px += [shape["r"] for shape in json.loads(scene.encoded())["shapes"] if "r" in shape]
    small_px, usual_px = radii_px
    assert 3.0 < small_px < usual_px - 1.5


def test_height_candidates_and_teams_are_drawn() -> None:
    ball, other, obstacles, obstacle = ball_percept_t(), ball_candidate_t(), obstacle_percepts_t(), obstacle_t()
    ball.visible, ball.x_m, ball.z_m, other.x_m, other.confidence = True, 2.0, 0.34, -3.0, 0.4
    ball.others = [other]
    obstacle.x_m, obstacle.radius_m, obstacle.team = 3.0, 0.25, obstacle_t.TEAM_MAGENTA
    obstacles.obstacles = [obstacle]
    shapes = sight("cyan1/image", image=frame(400, 400), ball_percept=ball, obstacle_percepts=obstacles)
    rings = [shape for shape in shapes if shape["l"] == "ball" and "r" in shape]
    assert len(rings) == 2
    words = [shape["s"] for shape in shapes if "s" in shape]
    assert words == ["magenta 3.0 m", "ball 2.0 m, 0%, 0.3 m high", "40%"]


def test_unseen_balls_are_not_drawn() -> None:
    assert sight("cyan1/image", image=frame(400, 400), ball_percept=ball_percept_t()) == []
    assert sight("cyan1/image") == []


def test_obstacles_of_the_stereo_pair_lie_in_its_left_image() -> None:
    found = obstacles((3.0, 0.0), (3.0, 20.0), (-3.0, 0.0))
    shapes = sight("cyan1/stereo_image", image=frame(800, 200), stereo_image=frame(800, 200), stereo_obstacles=found)
    outline, words = shapes
    assert words["s"] == "3.0 m"
    columns = [x for x, _ in outline["p"]]
    assert 0 <= min(columns) < 200 < max(columns) < 400


def test_obstacle_partly_beside_the_stereo_image_is_drawn() -> None:
    """Robots near by and to the side are the ones that matter most."""
    found = obstacles((1.7, -0.8), (0.6, 0.0))
    shapes = sight("cyan1/stereo_image", stereo_image=frame(800, 200), stereo_obstacles=found)
    outlines = [shape["p"] for shape in shapes if "p" in shape]
    assert len(outlines) == 2
    for outline in outlines:
        assert all(0 <= x < 400 and 0 <= y < 200 for x, y in outline)


def test_stereo_overlay_fits_frames_of_another_shape() -> None:
    heights = []
    for width_px, height_px in ((800, 200), (1280, 480)):
        seen = {"stereo_image": frame(width_px, height_px), "stereo_obstacles": obstacles((3.0, 0.0))}
        (outline,) = [shape["p"] for shape in sight("cyan1/stereo_image", **seen) if "p" in shape]
        heights.append(max(y for _, y in outline) / height_px)
    assert heights[0] == pytest.approx(heights[1], abs=0.01)


def test_old_detections_are_not_drawn_over_new_frames() -> None:
    ball, image = ball_percept_t(), frame(400, 400)
    ball.visible, ball.x_m, image.header.time_us = True, 2.0, 2_000_000
    assert sight("cyan1/image", image=image, ball_percept=ball) == []


def test_ball_above_the_mirror_is_not_drawn() -> None:
    ball = ball_percept_t()
    ball.visible, ball.z_m = True, 0.8
    assert [shape for shape in sight("cyan1/image", image=frame(400, 400), ball_percept=ball) if "r" in shape] == []
