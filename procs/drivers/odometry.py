"""Dead reckoning: integrates body velocities to a pose."""

import math

from procs.model.kinematics import STANDSTILL, Velocity


class Odometry:
    """Pose relative to the start, with the distance driven; the heading is not wrapped."""

    def __init__(self) -> None:
        self.x_m = 0.0
        self.y_m = 0.0
        self.heading_rad = 0.0
        self.path_length_m = 0.0
        self.velocity = STANDSTILL

    def advance(self, velocity: Velocity, duration_s: float) -> None:
        """Moves the pose at a constant velocity (robot frame), exactly along the arc of a circle."""
        self.velocity = velocity
        way_m = math.hypot(velocity.vx_m_s, velocity.vy_m_s) * duration_s
        turn_rad = velocity.omega_rad_s * duration_s
        # The chord of the arc points along the direction at its middle and is shorter than the arc by sin(t)/t.
        half_rad = turn_rad / 2
        chord_m = way_m * (math.sin(half_rad) / half_rad if half_rad else 1.0)
        direction_rad = self.heading_rad + half_rad + math.atan2(velocity.vy_m_s, velocity.vx_m_s)
        self.x_m += chord_m * math.cos(direction_rad)
        self.y_m += chord_m * math.sin(direction_rad)
        self.heading_rad += turn_rad
        self.path_length_m += way_m
