"""The mirror's geometry: directions, pixels, ground, spheres."""

import math

import numpy as np
import pytest

from procs.vision.mirror import Mirror

TILTED = Mirror(roll_rad=0.03, pitch_rad=-0.02)


@pytest.mark.parametrize("mirror", [Mirror(), Mirror(size_px=301, height_m=0.6), TILTED])
def test_ground_undoes_project(mirror: Mirror) -> None:
    points = np.random.default_rng(1).uniform(-6.0, 6.0, (200, 2))
    for height_m in (0.0, 0.11):
        pixels = mirror.project(np.column_stack((points, np.full(200, height_m))))
        assert np.allclose(mirror.ground(pixels, height_m), points, atol=1e-9)


def test_forward_is_up_and_left_is_left() -> None:
    mirror = Mirror()
    (ahead, left) = mirror.project(np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]))
    assert ahead[0] == pytest.approx(mirror.centre_px)
    assert ahead[1] < mirror.centre_px
    assert left[0] < mirror.centre_px
    assert left[1] == pytest.approx(mirror.centre_px)


def test_image_radius_grows_with_distance_up_to_eight_metres() -> None:
    mirror = Mirror()
    radii = [mirror.radius_px(distance) for distance in np.arange(0.0, 8.01, 0.1)]
    assert np.all(np.diff(radii) > 0.0)
    assert radii[-1] < mirror.size_px / 2


def test_metres_per_pixel_is_the_slope_of_the_mapping() -> None:
    mirror = Mirror()
    for distance in (0.3, 1.0, 3.0, 6.0):
        along, across = mirror.metres_per_px(distance)
        assert mirror.radius_px(distance + along / 100) - mirror.radius_px(distance) == pytest.approx(0.01, rel=0.01)
        assert across == pytest.approx(distance / mirror.radius_px(distance))


def test_ball_at_five_metres_is_several_pixels_wide() -> None:
    _, _, radius_px = Mirror().sphere((5.0, 0.0, 0.11), 0.11)
    assert 2 * radius_px > 6.0


@pytest.mark.parametrize("mirror", [Mirror(), TILTED])
@pytest.mark.parametrize("centre", [(0.36, 0.0, 0.11), (-2.0, 1.5, 0.11), (3.0, -3.0, 0.5)])
def test_sphere_is_the_circle_of_its_tangent_rays(mirror: Mirror, centre: tuple[float, float, float]) -> None:
    """Points on the sphere never appear outside the circle; those where rays touch the sphere appear on it."""
    radius_m = 0.11
    column, row, radius_px = mirror.sphere(centre, radius_m)
    directions = np.random.default_rng(2).standard_normal((20000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    seen = mirror.project(np.array(centre) + radius_m * directions)
    distances = np.hypot(seen[:, 0] - column, seen[:, 1] - row)
    assert distances.max() <= radius_px + 1e-9
    assert distances.max() == pytest.approx(radius_px, rel=1e-3)


def test_above_the_horizon_there_is_no_ground() -> None:
    mirror = Mirror(view_angle_rad=math.radians(110.0))
    corner = np.array([[0.0, mirror.centre_px]])
    assert np.isnan(mirror.ground(corner)).all()


@pytest.mark.parametrize("mirror", [Mirror(), TILTED])
@pytest.mark.parametrize("centre", [(0.36, 0.0, 0.11), (-2.0, 1.5, 0.11), (3.0, -3.0, 0.5), (1.0, 4.0, 0.85)])
def test_centre_of_a_circle_undoes_sphere(mirror: Mirror, centre: tuple[float, float, float]) -> None:
    assert mirror.centre_of(*mirror.sphere(centre, 0.11), 0.11) == pytest.approx(centre)


def test_reach_is_the_ground_at_the_pictures_edge() -> None:
    mirror = Mirror(size_px=360, view_angle_rad=math.radians(80.0))
    assert mirror.radius_px(mirror.reach_m()) == pytest.approx(180.0)
    assert mirror.reach_m(0.11) == pytest.approx(0.64 / 0.75 * mirror.reach_m())
    assert Mirror(view_angle_rad=math.radians(92.0)).reach_m() == math.inf


@pytest.mark.parametrize("height_m", [0.87, 1.2, 3.0])
def test_sphere_straight_above_the_viewpoint_is_not_shown(height_m: float) -> None:
    """Such a sphere fills everything outside a circle of the picture, so its radius is negative."""
    for away_m in (0.01, 0.05, 0.1):
        assert not Mirror().shows_all(*Mirror().sphere((away_m, 0.0, height_m), 0.11))


@pytest.mark.parametrize("beside_m", [0.0, 0.05, 0.1])
def test_sphere_around_the_viewpoint_hides_everything(beside_m: float) -> None:
    """The middle of a ball on top of a robot 0.64 m high is level with the mirror's viewpoint."""
    mirror = Mirror()
    column, row, radius_px = mirror.sphere((beside_m, 0.0, mirror.height_m), 0.11)
    assert radius_px > 100 * mirror.size_px
    assert math.hypot(column - mirror.centre_px, row - mirror.centre_px) < 1.001 * radius_px
    assert not mirror.shows_all(column, row, radius_px)
