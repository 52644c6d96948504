"""A played piece of a match: what was true and what the robots believed, tick by tick."""

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from lcmtypes.robot import kicker_state_t, wheel_command_t, wheel_state_t
from lcmtypes.soccer import (
    ball_percept_t,
    field_t,
    game_state_t,
    ground_truth_t,
    match_event_t,
    match_events_t,
    pose_t,
    role_t,
    skill_status_t,
    team_inbox_t,
    team_message_t,
    true_robot_t,
    world_model_t,
)
from procs.model.field import Field, field_of
from procs.model.robot import ROBOT, RobotModel, team_in, team_of

TRUTH = "world/ground_truth"
"""Channel of the truth, without which nothing is measured."""
BELIEFS: dict[str, Any] = {
    "world_model": world_model_t,
    "team_message": team_message_t,
    "team_inbox": team_inbox_t,
    "ball_percept": ball_percept_t,
    "role": role_t,
    "wheel_command": wheel_command_t,
    "wheel_state": wheel_state_t,
    "skill_status": skill_status_t,
    "kicker_state": kicker_state_t,
    "pose": pose_t,
    "particle_pose": pose_t,
    "average_ball": world_model_t,
}
"""Interfaces of each robot that a piece keeps."""
SILENT_S = 0.5
"""A message of a component holds for so long; a component with `every` sends none in the ticks between."""


@dataclass
class Piece:
    """Messages of a piece by tick; a world model is compared with the truth of its own tick."""

    period_s: float
    truth: dict[int, ground_truth_t] = field(default_factory=dict)
    game: dict[int, game_state_t] = field(default_factory=dict)
    events: dict[int, list[match_event_t]] = field(default_factory=dict)
    last_touch: dict[int, str] = field(default_factory=dict)
    """Tick to the robot that touched the ball last; empty: none since the ball was placed."""
    by_robot: dict[str, dict[str, dict[int, Any]]] = field(default_factory=dict)
    """Interface to robot to tick to message, for the interfaces in `BELIEFS`."""
    told_bytes: dict[str, int] = field(default_factory=dict)
    """Robot to the size of all that it told its team."""
    measures: Field = field(default_factory=Field)
    """Field on which it was played."""
    model: RobotModel = ROBOT
    """Geometry of the robots that played."""

    @cached_property
    def players(self) -> dict[str, true_robot_t]:
        """Robots that were ever on the field, by name."""
        return {robot.name: robot for truth in self.truth.values() for robot in truth.robots}

    def team(self, name: str) -> str:
        """Returns the team of a robot: the stated one, or that of its name."""
        return team_in(self.players[name]) if name in self.players else team_of(name)

    @property
    def minutes(self) -> float:
        """Length of the piece."""
        return len(self.truth) * self.period_s / 60

    @property
    def robots(self) -> list[str]:
        """Names of the robots on the field."""
        return sorted(robot.name for robot in self.truth[max(self.truth)].robots)

    def robot(self, tick: int, name: str) -> true_robot_t:
        """Returns the true pose of a robot.

        Raises:
            StopIteration: no such robot is on the field.
        """
        return next(robot for robot in self.truth[tick].robots if robot.name == name)

    def rivals(self, tick: int, name: str) -> list[true_robot_t]:
        """Returns the robots of the other team."""
        return [robot for robot in self.truth[tick].robots if team_in(robot) != self.team(name)]

    def newest(self, interface: str, robot: str, tick: int) -> Any:
        """Returns what a robot said last in an interface, in a tick or shortly before; None if it said nothing."""
        told = self.by_robot.get(interface, {}).get(robot, {})
        ticks = range(tick, tick - math.floor(SILENT_S / self.period_s + 1e-9) - 1, -1)
        return next((told[each] for each in ticks if each in told), None)

    def touched_by(self, tick: int, within_s: float) -> set[str]:
        """Returns the robots that touched the ball in a tick or up to `within_s` before."""
        ticks = range(tick - math.floor(within_s / self.period_s + 1e-9), tick + 1)
        kinds = (match_event_t.TOUCH, match_event_t.KICK)
        return {event.robot for each in ticks for event in self.events.get(each, ()) if event.kind in kinds}


def piece_of(sent: Mapping[str, Sequence[bytes]], period_s: float, model: RobotModel = ROBOT) -> Piece:
    """Sorts the messages of a match by tick; `sent` holds the encoded messages of each channel."""
    piece = Piece(period_s, model=model)
    piece.truth = {truth.header.tick: truth for truth in map(ground_truth_t.decode, sent[TRUTH])}
    piece.game = {game.header.tick: game for game in map(game_state_t.decode, sent.get("world/game_state", ()))}
    reports = [match_events_t.decode(data) for data in sent.get("world/match_events", ())]
    piece.events = {report.header.tick: report.events for report in reports}
    piece.last_touch = {report.header.tick: report.last_touch for report in reports}
    measured = sent.get("world/field", ())
    piece.measures = field_of(field_t.decode(measured[-1])) if measured else Field()
    found: dict[str, dict[str, dict[int, Any]]] = defaultdict(dict)
    for channel, messages in sent.items():
        robot, _, interface = channel.rpartition("/")
        if interface == "team_message":
            piece.told_bytes[robot] = sum(map(len, messages))
        if interface in BELIEFS:
            decoded = map(BELIEFS[interface].decode, messages)
            found[interface][robot] = {message.header.tick: message for message in decoded}
    piece.by_robot = dict(found)
    return piece
