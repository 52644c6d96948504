"""The rendered picture: positions, occlusion, and the same bytes every time."""

import math
from functools import cache
from itertools import permutations

import numpy as np
import pytest

from procs.model.field import Field
from procs.simulation.rendering.carpet import lay_carpet
from procs.simulation.rendering.renderer import Pose, Renderer, Scene
from procs.simulation.rendering.sensor_noise import SensorNoise
from procs.simulation.rendering.shapes import Bodies
from procs.simulation.rendering.stereo_renderer import StereoRenderer
from procs.vision.colours import BLACK, CYAN, GREEN, MAGENTA, ORANGE, WHITE, Bgr, Picture
from procs.vision.mirror import Mirror
from procs.vision.stereo_rig import StereoRig

MIRROR = Mirror()


@cache
def renderer() -> Renderer:
    return Renderer(MIRROR, Field(), Bodies())


def colour_at(picture: Picture, x_m: float, y_m: float, z_m: float = 0.0, mirror: Mirror = MIRROR) -> Bgr:
    """Returns the colour of the picture at a point of the robot frame."""
    column, row = np.rint(mirror.project(np.array([[x_m, y_m, z_m]]))[0]).astype(int)
    blue, green, red = (int(level) for level in picture[row, column])
    return blue, green, red


def test_carpet_has_its_lines_where_the_field_says() -> None:
    field = Field()
    carpet = lay_carpet(field)

    def at(x_m: float, y_m: float) -> tuple[int, ...]:
        column, row = (round(m / carpet.metres_per_px + o) for m, o in zip((x_m, y_m), carpet.origin_px, strict=True))
        return tuple(int(level) for level in carpet.pixels[row, column])

    for segment in field.segments():
        middle = (segment.start.x_m + segment.end.x_m) / 2, (segment.start.y_m + segment.end.y_m) / 2
        assert at(*middle) == WHITE
    circle = field.arcs()[0]
    for angle in np.arange(0.0, 6.0, 0.3):
        for beside_m, colour in ((0.0, WHITE), (0.035, WHITE), (-0.035, WHITE), (0.085, GREEN), (-0.085, GREEN)):
            radius = circle.radius_m + beside_m
            if abs(math.cos(angle)) * radius > 0.1:  # the halfway line crosses the circle
                assert at(radius * math.cos(angle), radius * math.sin(angle)) == colour
    for beside_m, colour in ((-0.075, GREEN), (-0.05, WHITE), (0.05, WHITE), (0.075, GREEN)):
        assert at(beside_m, 5.0) == at(field.half_length_m - 0.0625 + beside_m, 5.0) == colour


@pytest.mark.parametrize("heading_rad", [0.0, 1.0, -2.5])
def test_lines_appear_where_they_are(heading_rad: float) -> None:
    own = Pose(2.0, 4.0, heading_rad)
    picture = renderer().render(Scene(own, [], None))
    for distance_m, colour in ((1.5, GREEN), (2.0, WHITE), (2.5, GREEN)):  # across the halfway line
        angle = math.pi - heading_rad
        assert colour_at(picture, distance_m * math.cos(angle), distance_m * math.sin(angle)) == colour


def test_ball_and_robots_appear_where_they_are() -> None:
    own = Pose(-3.0, 1.0, math.pi / 2)
    scene = Scene(own, [(-5.0, 1.0, CYAN), (-3.0, -1.0, MAGENTA)], (-3.0, 2.5, 0.11))
    picture = renderer().render(scene)
    assert colour_at(picture, 1.5, 0.0, 0.11) == ORANGE
    assert colour_at(picture, 0.0, 1.75, 0.2) == BLACK
    assert colour_at(picture, 0.0, 1.75, 0.42) == CYAN
    assert colour_at(picture, -1.75, 0.0, 0.42) == MAGENTA
    assert colour_at(picture, 0.0, 1.70) == GREEN


def test_nearer_hides_the_farther() -> None:
    own = Pose(-3.0, 2.0, 0.0)
    hidden = renderer().render(Scene(own, [(-2.0, 2.0, CYAN)], (-1.3, 2.0, 0.11)))
    in_front = renderer().render(Scene(own, [(-1.0, 2.0, CYAN)], (-1.7, 2.0, 0.11)))
    orange = np.array(ORANGE, np.uint8)
    assert not (hidden == orange).all(axis=2).any()
    assert (in_front == orange).all(axis=2).sum() > 100


@pytest.mark.parametrize("height_m", [0.5, 0.9, 1.2])
def test_stereo_picture_does_not_depend_on_the_order_of_robots(height_m: float) -> None:
    pair = StereoRenderer(StereoRig(height_m=height_m), Field(), Bodies())
    robots = [(2.0, 0.0), (2.8, 0.2), (3.6, -0.1)]
    frames = {pair.render(Pose(0.0, 0.0, 0.0), list(order)).tobytes() for order in permutations(robots)}
    assert len(frames) == 1


@pytest.mark.parametrize(("height_m", "shows"), [(0.5, False), (1.2, True)])
def test_stereo_pair_above_the_robots_sees_those_behind(height_m: float, shows: bool) -> None:
    pair, own = StereoRenderer(StereoRig(height_m=height_m), Field(), Bodies()), Pose(0.0, 0.0, 0.0)
    alone = pair.render(own, [(2.0, 0.0)])
    both = pair.render(own, [(2.0, 0.0), (3.0, 0.0)])
    assert (alone != both).any() == shows


def test_tilted_mirror_sees_the_same_things_elsewhere() -> None:
    tilted = Mirror(pitch_rad=math.radians(3.0))
    scene = Scene(Pose(-3.0, 2.0, 0.0), [], (0.0, 2.0, 0.11))
    picture = Renderer(tilted, Field(), Bodies()).render(scene)
    assert colour_at(picture, 3.0, 0.0, 0.11, tilted) == ORANGE
    assert colour_at(picture, 3.0, 0.0, 0.11, MIRROR) != ORANGE


@pytest.mark.parametrize("shake_px", [(3.0, -2.0), (1.5, 0.0), (-2.5, 1.5)])
def test_shaking_moves_the_whole_picture(shake_px: tuple[float, float]) -> None:
    scene = Scene(Pose(-3.0, 2.0, 0.3), [(-1.0, 3.0, CYAN)], (-2.0, 1.0, 0.11))
    still, shaken = renderer().render(scene), renderer().render(scene, shake_px)
    right, down = (math.floor(shake) for shake in shake_px)
    moved = np.roll(still, (down, right), axis=(0, 1))
    ring = np.hypot(*(np.indices(still.shape[:2]) - MIRROR.centre_px))
    ring_mask = (ring > 80) & (ring < 170)
    differing = (moved != shaken).any(axis=2)[ring_mask].mean()
    if shake_px == (right, down):
        assert differing < 1e-3
    else:  # half a pixel further: edges change, surfaces do not
        assert 0.0 < differing < 0.1
    assert (still != shaken).any(axis=2)[ring_mask].mean() > differing


def test_equal_scenes_give_equal_bytes() -> None:
    scene = Scene(Pose(1.0, 2.0, 0.7), [(2.0, 3.0, CYAN), (4.0, 1.0, MAGENTA)], (2.0, 1.0, 0.11))
    other = Renderer(MIRROR, Field(), Bodies())
    assert renderer().render(scene).tobytes() == other.render(scene).tobytes()


def test_robots_at_the_camera_or_far_away_can_be_drawn() -> None:
    robots = [(0.1, 0.0, CYAN), (0.0, 0.0, CYAN), (1e4, 0.0, MAGENTA)]
    renderer().render(Scene(Pose(0.0, 0.0, 0.0), robots, (0.0, 0.0, 0.11)))
    renderer().render(Scene(Pose(0.0, 0.0, 0.0), [], (0.3, 0.0, 5.0)))
    for beside_m in (0.0, 0.05, 0.1):
        renderer().render(Scene(Pose(0.0, 0.0, 0.0), [], (beside_m, 0.0, MIRROR.height_m)))


def test_noise_is_as_strong_as_set_and_differs_by_frame() -> None:
    grey = np.full((200, 200, 3), 128, np.uint8)
    noise, rng = SensorNoise((200, 200, 3), 5.0, 1.0, 0.0), np.random.default_rng(2)
    first, second = noise.apply(grey, rng), noise.apply(grey, rng)
    assert first.std() == pytest.approx(5.0, rel=0.05)
    assert first.mean() == pytest.approx(128.0, abs=0.2)
    assert np.corrcoef(first.ravel(), second.ravel())[0, 1] < 0.1


def test_brightness_scales_and_flicker_varies() -> None:
    grey, rng = np.full((100, 100, 3), 100, np.uint8), np.random.default_rng(2)
    assert SensorNoise((100, 100, 3), 0.0, 1.5, 0.0).apply(grey, rng).mean() == 150.0
    flickering = SensorNoise((100, 100, 3), 0.0, 1.0, 0.1)
    means = [float(flickering.apply(grey, rng).mean()) for _ in range(200)]
    assert np.std(means) == pytest.approx(10.0, rel=0.2)
