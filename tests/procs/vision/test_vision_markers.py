"""Teams of robots by the colour of their markers, in rendered pictures."""

import math

import numpy as np
import pytest

from procs.model.ball import BALL
from procs.model.field import Field
from procs.model.robot import RobotModel
from procs.simulation.rendering.renderer import Pose, Renderer, Scene
from procs.simulation.rendering.shapes import Bodies
from procs.vision.calibration import MirrorConfig
from procs.vision.colours import BLACK, COLOURS, WHITE, Bgr, ColourRange, Picture, to_hsv
from procs.vision.marker_finder import MarkerFinder
from procs.vision.omni_field import OmniFieldConfig
from tests.procs.vision.test_vision_ball import picture

CONFIG = OmniFieldConfig()
MIRROR = CONFIG.mirror.mirror()
FINDER = MarkerFinder(
    MIRROR, (ColourRange(CONFIG.cyan_low, CONFIG.cyan_high), ColourRange(CONFIG.magenta_low, CONFIG.magenta_high))
)


def recognized(team: str, distance_m: float, count: int = 40) -> list[int]:
    """Returns the teams found for robots of a team, whose places are known as well as the detector knows them."""
    rng, found = np.random.default_rng(round(10 * distance_m)), []
    for _ in range(count):
        angle = rng.uniform(-math.pi, math.pi)
        place_m = distance_m * np.array((math.cos(angle), math.sin(angle)))
        frame = picture(Scene(Pose(0.0, 0.0, 0.0), [(*place_m.tolist(), COLOURS[team])], None), rng, shake_px=0.4)
        x_m, y_m = (place_m + (0.02 + 0.003 * distance_m**2) * rng.standard_normal(2)).tolist()
        found += FINDER.find(frame, [(x_m, y_m)])
    return found


@pytest.mark.parametrize(("team", "number"), [("cyan", 1), ("magenta", 2)])
@pytest.mark.parametrize(("distance_m", "least"), [(0.6, 0.95), (2.0, 0.95), (4.0, 0.95), (6.0, 0.7)])
def test_team_is_recognized_and_never_mistaken(team: str, number: int, distance_m: float, least: float) -> None:
    found = recognized(team, distance_m)
    assert found.count(number) / len(found) >= least
    assert set(found) <= {0, number}


@pytest.mark.parametrize("colour", [BLACK, WHITE])
def test_other_colours_are_of_no_team(colour: Bgr) -> None:
    frame = render(Scene(Pose(0.0, 0.0, 0.0), [(2.0, 0.0, colour)], None))
    assert FINDER.find(frame, [(2.0, 0.0)]) == [0]


def render(scene: Scene) -> Picture:
    return Renderer(MIRROR, Field(), Bodies()).render(scene)


def test_obstacle_at_or_under_the_camera_is_of_no_team() -> None:
    frame = render(Scene(Pose(0.0, 0.0, 0.0), [], None))
    assert FINDER.find(frame, [(0.0, 0.0), (1e-9, 0.0), (100.0, 0.0)]) == [0, 0, 0]


def test_no_robots_have_no_teams() -> None:
    assert FINDER.find(np.zeros((400, 400, 3), np.uint8), []) == []


@pytest.mark.parametrize("height_m", [0.3, 0.4, 0.8])
def test_marker_is_on_the_body_however_high_it_is(height_m: float) -> None:
    robot = RobotModel(height_m=height_m)
    mirror = MirrorConfig(height_m=0.6).mirror()
    frame = Renderer(mirror, Field(), Bodies.of(robot, BALL)).render(
        Scene(Pose(0.0, 0.0, 0.0), [(1.5, 0.0, COLOURS["magenta"])], None)
    )
    above, below = mirror.project(np.array([(1.25, 0.0, height_m + 0.02), (1.25, 0.0, height_m - 0.02)]))
    assert robot.marker_m[1] <= height_m
    assert CONFIG.magenta_low[0] > to_hsv(frame)[tuple(np.rint(above[::-1]).astype(int))][0]
    assert below[1] > above[1]
    finder = MarkerFinder(mirror, FINDER.colours, robot.radius_m, robot.marker_m)
    assert finder.find(frame, [(1.5, 0.0)]) == [2]
