"""A robot as a body of the physics engine: round, with a flat mouth in front, moved by its wheels."""

import math

import pymunk

from procs.model.geometry import wrap_rad
from procs.model.kinematics import Velocity
from procs.model.robot import RobotModel
from procs.simulation.physics.arena import HULL, HULL_FILTER, ROBOT, ROBOT_FILTER
from procs.simulation.physics.drive import Drive
from procs.simulation.physics.settings import ContactSettings
from procs.simulation.physics.start_places import Pose

_HULL_CORNERS = 16
_MOUTH_LIP_M = 0.005


class Robot:
    """One robot; positions in the world frame."""

    def __init__(
        self, space: pymunk.Space, name: str, robot: RobotModel, drive: Drive, contacts: ContactSettings
    ) -> None:
        self.name = name
        self.radius_m = robot.radius_m
        self.drive = drive
        half_rad = math.radians(robot.mouth_half_angle_deg)
        self.mouth_x_m = robot.mouth_m
        """From the robot's middle to the plane of the mouth."""
        self.body = pymunk.Body(robot.mass_kg, robot.inertia * robot.mass_kg * robot.radius_m**2)
        half_mouth_m = robot.radius_m * math.sin(half_rad)
        circle = pymunk.Circle(self.body, robot.radius_m)
        circle.collision_type, circle.elasticity, circle.friction = (
            ROBOT,
            contacts.robot_bounce,
            contacts.robot_friction,
        )
        circle.filter = ROBOT_FILTER
        hull = pymunk.Poly(self.body, _hull(robot.radius_m, half_rad))
        hull.collision_type, hull.filter = HULL, HULL_FILTER
        hull.elasticity, hull.friction = contacts.hull_bounce, contacts.hull_friction
        lip_x_m = self.mouth_x_m - _MOUTH_LIP_M
        mouth = pymunk.Segment(self.body, (lip_x_m, -half_mouth_m), (lip_x_m, half_mouth_m), _MOUTH_LIP_M)
        mouth.collision_type, mouth.filter = HULL, HULL_FILTER
        mouth.elasticity, mouth.friction = contacts.mouth_bounce, contacts.mouth_friction
        space.add(self.body, circle, hull, mouth)

    @property
    def velocity(self) -> Velocity:
        """Velocity in the robot frame."""
        forward, left = self.body.velocity.rotated(-self.body.angle)
        return Velocity(forward, left, self.body.angular_velocity)

    def put(self, x_m: float, y_m: float, heading_rad: float) -> None:
        """Sets the robot down at rest, its motors too."""
        self.drive.halt()
        self.body.position, self.body.angle = (x_m, y_m), wrap_rad(heading_rad)  # so that a huge one can still change
        self.body.velocity, self.body.angular_velocity = (0.0, 0.0), 0.0

    def gap_m(self, pose: Pose, x_m: float, y_m: float) -> float:
        """Returns the distance from a point to the hull of the robot if it stood at a pose; negative inside."""
        away_x, away_y = x_m - pose.x_m, y_m - pose.y_m
        cos, sin = math.cos(pose.heading_rad), math.sin(pose.heading_rad)
        ahead_m, aside_m = cos * away_x + sin * away_y, abs(cos * away_y - sin * away_x)
        round_m = math.hypot(ahead_m, aside_m) - self.radius_m
        if ahead_m <= self.mouth_x_m:
            return max(round_m, ahead_m - self.mouth_x_m)
        half_mouth_m = math.sqrt(self.radius_m**2 - self.mouth_x_m**2)
        if aside_m <= half_mouth_m:
            return ahead_m - self.mouth_x_m
        beside_mouth = aside_m * self.mouth_x_m <= half_mouth_m * ahead_m
        return math.hypot(ahead_m - self.mouth_x_m, aside_m - half_mouth_m) if beside_mouth else round_m


def _hull(radius_m: float, half_rad: float) -> list[tuple[float, float]]:
    step_rad = (2 * math.pi - 2 * half_rad) / _HULL_CORNERS
    angles = [half_rad + corner * step_rad for corner in range(_HULL_CORNERS + 1)]
    inner_m = radius_m * math.cos(half_rad) - _MOUTH_LIP_M
    return [(min(radius_m * math.cos(angle), inner_m), radius_m * math.sin(angle)) for angle in angles]
