"""Teams of robots by the colour of their markers, in rendered pictures."""

import math

import numpy as np
import pytest

from procs.model.field import Field
from procs.simulation.rendering.renderer import Pose, Renderer, Scene
from procs.simulation.rendering.shapes import Bodies
from procs.vision.colours import BLACK, COLOURS, WHITE, Bgr, ColourRange, Picture
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
