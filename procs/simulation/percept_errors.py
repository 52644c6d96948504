"""Deviation from the ideal of percepts drawn from the truth, for each preset; fitted to those of the rendered path.

Deviations are in pixels of the mirror's picture, so that they grow with distance as those of the detectors do. Rates of
phantoms and recognition are those of B-Human's percepts from the truth and ER-Force's simulator; others are estimates.
"""

from procs.model.realism import Realism
from procs.simulation.mirror_errors import MIRRORS, MirrorErrors


class PerceptErrors(MirrorErrors):
    """Errors of percepts. 0: ideal."""

    ball_px: float = 0.0
    """Standard deviation of the ball's place, in pixels. Fitted to rendered pictures."""
    ball_area_px: float = 0.0
    """Relative standard deviation of the ball's area, by which a ball in the air is known, times its radius."""
    robot_along_px: float = 0.0
    """Standard deviation of a robot's place along the ray from the camera, in pixels. Fitted to rendered pictures."""
    robot_across_px: float = 0.0
    """The same across the ray."""
    line_px: float = 0.0
    """Standard deviation of a point on a line, in pixels. Fitted to rendered pictures."""
    ball_missed: float = 0.0
    """Part of the frames in which a visible ball is not found. ER-Force: 5 %."""
    robot_missed: float = 0.0
    """Part of the frames in which a visible robot is not found. ER-Force: 2 %."""
    team_missed: float = 0.0
    """Part of the robots whose marker's colour is not recognized. An estimate from rendered pictures."""
    line_missed: float = 0.0
    """Part of the line points that are not found. Fitted to rendered pictures."""
    ball_phantoms_1_s: float = 0.0
    """Balls a second that are not there. B-Human: 0.0005 a frame."""
    mouth_phantoms_1_s: float = 0.0
    """Balls a second that seem to lie in the own mouth. ER-Force: 0.05 at each robot's dribbler."""
    robot_phantoms_1_s: float = 0.0
    """Robots a second that are not there. B-Human: 0.005 a frame."""
    line_phantoms: float = 0.0
    """Part of the points that do not lie on a line. An estimate."""


PRESETS: dict[Realism, PerceptErrors] = {
    "none": PerceptErrors(**dict(MIRRORS["none"])),
    "friendly": PerceptErrors(
        **dict(MIRRORS["friendly"]),
        ball_px=0.1,
        ball_area_px=0.08,
        robot_along_px=0.18,
        robot_across_px=0.92,
        line_px=0.25,
        ball_missed=0.02,
        robot_missed=0.01,
        team_missed=0.01,
        line_missed=0.02,
        line_phantoms=0.01,
    ),
    "realistic": PerceptErrors(
        **dict(MIRRORS["realistic"]),
        ball_px=0.15,
        ball_area_px=0.09,
        robot_along_px=0.2,
        robot_across_px=0.92,
        line_px=0.3,
        ball_missed=0.05,
        robot_missed=0.02,
        team_missed=0.03,
        line_missed=0.03,
        ball_phantoms_1_s=0.005,
        mouth_phantoms_1_s=0.05,
        robot_phantoms_1_s=0.05,
        line_phantoms=0.02,
    ),
    "harsh": PerceptErrors(
        **dict(MIRRORS["harsh"]),
        ball_px=0.3,
        ball_area_px=0.24,
        robot_along_px=0.2,
        robot_across_px=0.92,
        line_px=0.35,
        ball_missed=0.1,
        robot_missed=0.04,
        team_missed=0.1,
        line_missed=0.2,
        ball_phantoms_1_s=0.05,
        mouth_phantoms_1_s=0.05,
        robot_phantoms_1_s=0.1,
        line_phantoms=0.04,
    ),
}
