"""The own view: percepts of old exposures are placed from where the robot was then."""

import numpy as np
import pytest

from lcmtypes.robot import odometry_t
from lcmtypes.soccer import ball_percept_t, obstacle_percepts_t, obstacle_t, pose_t
from procs.world_model.own_view import OwnView, Shaking

PERIOD_S = 0.05
STILL = Shaking(0.0, 0.0)


def view_after(*poses: tuple[float, float, float]) -> OwnView:
    """Returns the view of a robot that was at these poses, tick by tick."""
    view: OwnView | None = None
    for x_m, y_m, heading_rad in poses:
        pose = pose_t(x_m=x_m, y_m=y_m, heading_rad=heading_rad, localized=True)
        pose.covariance = (np.eye(3) * 1e-4).tolist()
        view = OwnView(pose, odometry_t(), True, STILL, view, PERIOD_S)
    assert view is not None
    return view


def ball_from(view: OwnView, age_s: float) -> list[float]:
    """Returns the place of a ball that was seen 3 m ahead."""
    percept = ball_percept_t(visible=True, x_m=3.0, covariance_m2=(np.eye(2) * 1e-4).tolist())
    (place_m,) = view.ball(percept, age_s).positions_m.tolist()
    return [float(each) for each in place_m]


@pytest.mark.parametrize(("age_s", "heading_rad"), [(0.0, 0.5), (0.025, 0.4), (0.05, 0.3), (0.125, 0.1), (0.2, 0.0)])
def test_old_ball_is_placed_from_the_pose_of_its_exposure(age_s: float, heading_rad: float) -> None:
    """The robot turns faster and faster, and drives back."""
    view = view_after(*((-0.1 * tick, 0.0, turned) for tick, turned in enumerate((0.0, 0.05, 0.15, 0.3, 0.5))))
    begin_m = -0.4 + 2.0 * age_s
    expected_m = [begin_m + 3.0 * np.cos(heading_rad), 3.0 * np.sin(heading_rad)]
    assert ball_from(view, age_s) == pytest.approx(expected_m, abs=1e-9)


def test_poses_before_a_correction_do_not_count() -> None:
    view = view_after((-5.0, 4.0, 2.0), (-5.0, 4.0, 2.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    assert ball_from(view, 0.15) == pytest.approx([3.0, 0.0])


def test_sightings_of_a_faster_robot_are_less_certain() -> None:
    """A mirror shakes in proportion to the speed; the size that tells the distance of a lob does not."""
    pose = pose_t(localized=True, covariance=np.zeros((3, 3)).tolist())
    view = OwnView(pose, odometry_t(vx_m_s=2.0), True, Shaking(ball_s_m=0.9, robot_s_m=0.35))
    ball = ball_percept_t(visible=True, x_m=3.0, covariance_m2=(np.eye(2) * 1e-2).tolist())
    assert view.ball(ball, 0.0).covariances_m2[0] == pytest.approx(np.eye(2) * 2.8**2 * 1e-2, rel=1e-3)
    lob = ball_percept_t(visible=True, y_m=3.0, z_m=0.5, covariance_m2=(np.eye(2) * 1e-2).tolist())
    assert view.ball(lob, 0.0).covariances_m2[0] == pytest.approx(np.diag((2.8**2 * 1e-2, 1e-2)), rel=1e-3)
    robot = obstacle_t(x_m=3.0, radius_m=0.25, covariance_m2=(np.eye(2) * 1e-2).tolist())
    seen = view.obstacles(obstacle_percepts_t(obstacles=[robot]), 0.0, 0)
    assert seen.covariances_m2[0] == pytest.approx(np.eye(2) * 1.7**2 * 1e-2, rel=1e-3)
