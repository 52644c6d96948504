"""World state that a team reports to the RefBox, which records it and shows it to the audience.

A JSON object as in `MSLWMD-schema` of the RefBox. Its frame is the team's own, as in the league's recorded matches:
the origin is the middle of the field, y points to the opponents' goal and x to the right; a robot of heading 0 looks
along y, and angles grow to the left.
"""

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from lcmtypes.soccer import ball_estimate_t, robot_estimate_t, team_message_t, world_model_t
from procs.model.geometry import plausible, wrap_rad
from procs.refbox.protocol import ProtocolError, parse

_NEAR_M = 0.5  # distance from its true place within which a belief is right
_SAID = "worldstate"
_LISTS = ("robots", "balls", "obstacles")
_TEXTS = ("teamName", "intention")


class TeamFrame:
    """The frame of a team that plays towards the goal on side `ahead`, -1.0 or 1.0, of the world's x axis."""

    def __init__(self, ahead: float) -> None:
        self._ahead = ahead

    def place(self, x_m: float, y_m: float) -> list[float | None]:
        """Returns a place, velocity or other vector of the world frame in the team's; nulls for an impossible one."""
        return [-self._ahead * y_m + 0.0, self._ahead * x_m + 0.0] if plausible(x_m, y_m) else [None, None]  # no -0.0

    def heading_rad(self, heading_rad: float) -> float | None:
        """Returns a heading of the world frame in the team's; null for an impossible one."""
        if not plausible(heading_rad):
            return None
        return wrap_rad(heading_rad if self._ahead > 0 else heading_rad + math.pi)


def world_state(
    team: str,
    intention: str,
    messages: Sequence[team_message_t],
    belief: world_model_t | None,
    ahead: float,
    radius_m: float,
    age_s: float,
) -> dict[str, Any]:
    """Makes the report of a team.

    Args:
        team: its name.
        intention: what it is about to do, for people.
        messages: newest message of each robot that plays.
        belief: what a robot knows of ball and opponents; None if no robot knows its place.
        ahead: side of the opponents' goal, -1.0 or 1.0.
        radius_m: radius of a robot.
        age_s: time since the newest message.

    Returns:
        The JSON object; what is unknown is null, or left out where the schema wants a number.
    """
    frame = TeamFrame(ahead)
    balls = [_ball(belief.ball, frame)] if belief is not None and belief.ball.known else []
    opponents = belief.opponents if belief is not None else []
    return {
        "type": _SAID,
        "teamName": team,
        "intention": intention,
        "robots": [_robot(message, frame) for message in messages],
        "balls": balls,
        "obstacles": [_obstacle(opponent, frame, radius_m) for opponent in opponents],
        "ageMs": round(age_s * 1e3),
    }


def best_belief(beliefs: Iterable[world_model_t]) -> world_model_t | None:
    """Returns the belief of a robot that knows its place, the surest of the ball; None if no robot knows its place."""
    known = [belief for belief in beliefs if belief.localized]
    return min(known, key=lambda belief: (not belief.ball.known, _variance_m2(belief.ball.covariance)), default=None)


def intention_of(belief: world_model_t | None, team: Iterable[str]) -> str:
    """Returns what a team is about to do in play, by the robot that holds the ball."""
    holder = "" if belief is None else belief.ball_holder
    if not holder:
        return "win the ball"
    return "attack" if holder in team else "defend"


def encode(report: Mapping[str, Any]) -> bytes:
    """Returns the bytes of a report with its NUL."""
    return json.dumps(report, allow_nan=False).encode() + b"\0"


def check(message: bytes) -> dict[str, Any]:
    """Returns the report in a message without its NUL; the RefBox asks for the same members.

    Raises:
        ProtocolError: it is no report of a world state.
    """
    report = parse(message)
    if not isinstance(report, dict) or report.get("type") != _SAID:
        raise ProtocolError(f"it is no JSON object with the type {_SAID!r}")
    kinds: list[tuple[str, type, str]] = [(name, str, "a text") for name in _TEXTS]
    kinds += [(name, list, "a list") for name in _LISTS]
    for name, kind, words in [*kinds, ("ageMs", int, "a whole number")]:
        if not isinstance(report.get(name), kind) or isinstance(report[name], bool):
            raise ProtocolError(f"{name!r} of its world state is missing or is not {words}")
    return report


def _robot(message: team_message_t, frame: TeamFrame) -> dict[str, Any]:
    pose: list[float | None] = [None, None, None]
    velocity: list[float | None] = [None, None, None]
    target: list[float | None] = [None, None, None]
    if message.localized:
        pose = [*frame.place(message.x_m, message.y_m), frame.heading_rad(message.heading_rad)]
        velocity = [*frame.place(message.vx_m_s, message.vy_m_s), None]  # mates do not tell how fast they turn
    if message.has_target:
        target = [*frame.place(message.target_x_m, message.target_y_m), frame.heading_rad(message.target_heading_rad)]
    robot: dict[str, Any] = {
        "id": message.number,
        "pose": pose,
        "targetPose": target,
        "velocity": velocity,
        "intention": message.intention,
        "ballEngaged": int(message.ball_held),
    }
    if message.battery_known and plausible(message.battery_charge):
        robot["batteryLevel"] = 100.0 * message.battery_charge
    return robot


def _ball(ball: ball_estimate_t, frame: TeamFrame) -> dict[str, Any]:
    return {
        "position": [*frame.place(ball.x_m, ball.y_m), _number(ball.z_m)],
        "velocity": [*frame.place(ball.vx_m_s, ball.vy_m_s), _number(ball.vz_m_s)],
        "confidence": _confidence(ball.covariance),
    }


def _obstacle(robot: robot_estimate_t, frame: TeamFrame, radius_m: float) -> dict[str, Any]:
    return {
        "position": frame.place(robot.x_m, robot.y_m),
        "velocity": frame.place(robot.vx_m_s, robot.vy_m_s),
        "radius": radius_m,
        "confidence": _confidence(robot.covariance_m2),
    }


def _number(value: float) -> float | None:
    """Returns a value of a message; null if it is impossible."""
    return value if plausible(value) else None


def _confidence(covariance: Sequence[Sequence[float]]) -> float:
    """Returns the probability that something is within half a metre of where it is believed to be."""
    variance_m2 = _variance_m2(covariance)
    if not plausible(variance_m2) or variance_m2 < 0.0:
        return 0.0
    return -math.expm1(-(_NEAR_M**2) / (2 * variance_m2)) if variance_m2 else 1.0


def _variance_m2(covariance: Sequence[Sequence[float]]) -> float:
    """Returns the mean variance of a place along x and y."""
    return (covariance[0][0] + covariance[1][1]) / 2
