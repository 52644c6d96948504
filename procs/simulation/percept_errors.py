"""Deviation from the ideal of percepts drawn from the truth, for each preset; fitted to those of the rendered path.

Deviations are in pixels of the mirror's picture, so that they grow with distance as those of the detectors do. What
rays and pixels of the detectors add is the same for all presets. Rates of balls and robots that are not there are those
of B-Human's percepts from the truth and ER-Force's simulator.
"""

from procs.model.realism import Realism
from procs.simulation.mirror_errors import MIRRORS, MirrorErrors


class PerceptErrors(MirrorErrors):
    """Errors of percepts. 0: ideal."""

    ball_px: float = 0.0
    """Standard deviation of the ball's place, in pixels. Fitted to rendered pictures."""
    ball_area_px: float = 0.0
    """Relative standard deviation of the ball's area, by which a ball in the air is known, times its radius. Fitted to
    rendered pictures."""
    ball_area_lost: float = 0.0
    """Part of the ball's area that noise and cast hide. Fitted to rendered pictures."""
    line_blur_px: float = 0.0
    """Least width in the picture, in pixels, of a line that blur leaves white; a narrower one is found in a part of its
    points. Fitted to rendered pictures."""
    worn: float = 0.0
    """Part of the lines' paint that is missing; as in `CameraErrors`."""
    ball_missed: float = 0.0
    """Part of the frames in which a visible ball is not found. Fitted to rendered pictures."""
    robot_missed: float = 0.0
    """Part of the frames in which a visible robot is not found. Fitted to rendered pictures."""
    team_missed: float = 0.0
    """Part of the robots whose marker's colour is not recognized. Fitted to rendered pictures."""
    line_missed: float = 0.0
    """Part of the line points that are not found; none in rendered pictures, but for paint and blur."""
    ball_phantoms_1_s: float = 0.0
    """Balls a second that are not there. B-Human: 0.0005 a frame."""
    mouth_phantoms_1_s: float = 0.0
    """Balls a second that seem to lie in the own mouth. ER-Force: 0.05 at each robot's dribbler."""
    robot_phantoms_1_s: float = 0.0
    """Robots a second that are not there. B-Human: 0.005 a frame."""
    line_phantoms: float = 0.0
    """Part of the points that do not lie on a line. Fitted to rendered pictures."""


PRESETS: dict[Realism, PerceptErrors] = {
    "none": PerceptErrors(**dict(MIRRORS["none"])),
    "friendly": PerceptErrors(
        **dict(MIRRORS["friendly"]),
        ball_px=0.03,
        ball_area_px=0.025,
        ball_area_lost=0.01,
        team_missed=0.001,
        line_phantoms=0.002,
    ),
    "realistic": PerceptErrors(
        **dict(MIRRORS["realistic"]),
        ball_px=0.035,
        ball_area_px=0.03,
        ball_area_lost=0.015,
        worn=0.075,
        ball_missed=0.0005,
        robot_missed=0.0005,
        team_missed=0.001,
        ball_phantoms_1_s=0.005,
        mouth_phantoms_1_s=0.05,
        robot_phantoms_1_s=0.05,
        line_phantoms=0.003,
    ),
    "harsh": PerceptErrors(
        **dict(MIRRORS["harsh"]),
        ball_px=0.04,
        ball_area_px=0.055,
        ball_area_lost=0.02,
        line_blur_px=2.2,
        worn=0.15,
        ball_missed=0.003,
        robot_missed=0.001,
        team_missed=0.001,
        ball_phantoms_1_s=0.05,
        mouth_phantoms_1_s=0.05,
        robot_phantoms_1_s=0.1,
        line_phantoms=0.004,
    ),
}
