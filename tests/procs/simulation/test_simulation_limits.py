"""Settings at their limits: the world stays finite, between its walls, and true to the commands."""

import math
from typing import Any

import numpy as np
import pytest
from pydantic import BaseModel

from fwk.model.errors import PlanError
from fwk.testing import launch_plan
from procs.model.ball import BallModel
from procs.model.kinematics import Velocity, wheels_of
from procs.model.robot import RobotModel
from procs.simulation.physics.kick_mechanism import KickerCommand
from procs.simulation.physics.realism import Noise
from procs.simulation.physics.settings import (
    ContactSettings,
    DriveSettings,
    HandlingSettings,
    KickerSettings,
    PhysicsSettings,
)
from procs.simulation.physics.start_places import Pose
from procs.simulation.physics.world import World

TICK_US = 40_000
PARTS: dict[type[BaseModel], str] = {
    DriveSettings: "drive",
    HandlingSettings: "handling",
    KickerSettings: "kicker",
    ContactSettings: "contacts",
}
WHOLES: dict[type[BaseModel], str] = {RobotModel: "robot", BallModel: "ball", Noise: "noise"}


def limits_of(kind: type[BaseModel]) -> list[tuple[str, float]]:
    """Returns each setting with each of its limits; a limit that it may not reach is nearly reached."""
    found = []
    for name, field in kind.model_fields.items():
        said = {
            limit: getattr(each, limit)
            for each in field.metadata
            for limit in ("gt", "ge", "lt", "le")
            if hasattr(each, limit)
        }
        assert len(said) == 2, f"{kind.__name__}.{name} has no limit above or below"
        least, most = said.get("ge", said.get("gt", 0.0) + 1e-9), said.get("le", said.get("lt", 0.0) - 1e-9)
        found += [(name, least), (name, most)]
    return found


CASES = [(kind, name, value) for kind in [*WHOLES, *PARTS] for name, value in limits_of(kind)]


@pytest.mark.parametrize(("kind", "name", "value"), CASES, ids=[f"{name}={value:g}" for _, name, value in CASES])
def test_world_stays_finite_and_between_its_walls(kind: type[BaseModel], name: str, value: float) -> None:
    """Two robots drive at each other, and at the ball between them; one kicks."""
    made = kind(**{name: value})
    given: dict[str, Any] = (
        {WHOLES[kind]: made} if kind in WHOLES else {"physics": PhysicsSettings.model_validate({PARTS[kind]: made})}
    )
    starts = {"cyan1": Pose(-1.2, 0.0, 0.0), "magenta1": Pose(1.2, 0.0, math.pi)}
    world = World(list(starts), np.random.default_rng(1), starts=starts, **given)
    for tick in range(60):
        for robot in starts:
            world.robots[robot].drive.command((-3.0, 0.0, 3.0), world.time_us)
            world.kickers[robot].command(KickerCommand(tick // 30, 8.0, True, 0.3), world.time_us)
        world.advance(TICK_US)
        for body in (world.ball.body, *(robot.body for robot in world.robots.values())):
            assert all(map(math.isfinite, (*body.position, body.angle, *body.velocity, body.angular_velocity)))
            assert max(abs(body.position.x) - 4.0, abs(body.position.y)) < 8.5
            assert body.velocity.length < 60.0


@pytest.mark.parametrize("radius_m", [0.01, 0.02, 0.05, 0.11])
def test_net_keeps_a_ball_of_any_size(radius_m: float) -> None:
    for start_m in np.arange(9.0, 9.1, 0.01).tolist():
        world = World([], np.random.default_rng(1), ball=BallModel(radius_m=radius_m))
        world.place_ball(start_m, 0.3)
        world.throw_ball(0.0, (15.0, 0.0, 0.0))
        for _ in range(10):
            world.advance(TICK_US)
        assert world.ball.body.position.x < 11.6, f"thrown from {start_m:g} m"


@pytest.mark.parametrize(
    ("wheel_distance_m", "drive"),
    [
        (0.2, DriveSettings()),
        (0.2, DriveSettings(full_slip_m_s=0.02)),
        (0.2, DriveSettings(traction=2.0)),
        (0.4, DriveSettings()),
        (0.5, DriveSettings(full_slip_m_s=0.02, traction=2.0)),
    ],
)
@pytest.mark.parametrize("wanted", [Velocity(0.0, 0.0, 3.0), Velocity(0.6, 0.3, 1.0)])
def test_robot_reaches_its_velocity_whatever_its_grip(
    wanted: Velocity, wheel_distance_m: float, drive: DriveSettings
) -> None:
    robot, physics = RobotModel(wheel_distance_m=wheel_distance_m), PhysicsSettings(drive=drive)
    starts = {"cyan1": Pose(0.0, 0.0, 0.0)}
    world = World(["cyan1"], np.random.default_rng(1), robot=robot, physics=physics, starts=starts)
    world.place_ball(-5.0, -5.0)
    for _ in range(50):
        world.robots["cyan1"].drive.command(wheels_of(wanted, wheel_distance_m), world.time_us)
        world.advance(TICK_US)
    assert world.robots["cyan1"].velocity.omega_rad_s == pytest.approx(wanted.omega_rad_s, rel=0.02)


@pytest.mark.parametrize(
    ("setting", "mistake"),
    [
        ("shared.robot.radius_m=0.001", "'robot.radius_m' is 0.001; it should be greater than or equal to 0.05"),
        ("shared.robot.mass_kg=1e-9", "'robot.mass_kg' is 1e-09; it should be greater than or equal to 1"),
        ("shared.ball.mass_kg=450", "'ball.mass_kg' is 450; it should be less than or equal to 1"),
        ("shared.ball.inertia=1e-300", "'ball.inertia' is 1e-300; it should be greater than or equal to 0.1"),
        (
            "world/simulator.physics.contacts.robot_friction=1e300",
            "'physics.contacts.robot_friction' is 1e+300; it should be less than or equal to 10",
        ),
        (
            "world/simulator.physics.handling.centring_s=1e-300",
            "'physics.handling.centring_s' is 1e-300; it should be greater than or equal to 0.01",
        ),
        (
            "world/simulator.physics.step_s=1e-12",
            "'physics.step_s' is 1e-12; it should be greater than or equal to 0.0001",
        ),
        ("world/simulator.period_s=0.02", "no setting 'period_s'"),
        ("shared.field.goal_height_m=0.1", "no ball of 0.22 m goes into a goal with a goal_height_m of 0.1 m"),
        ("shared.field.goal_depth_m=0.2", "no ball of 0.22 m goes into a goal with a goal_depth_m of 0.2 m"),
        ("shared.ball.radius_m=0.3", "no ball of 0.6 m goes into a goal with a goal_depth_m of 0.6 m"),
    ],
)
def test_values_with_which_no_world_works_are_refused(setting: str, mistake: str) -> None:
    with pytest.raises(PlanError) as raised:
        launch_plan("soccer-truth.yaml", (setting,))
    assert mistake in str(raised.value)
