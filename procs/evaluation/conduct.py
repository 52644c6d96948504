"""How the robots play: collisions, distances at restarts, passes, goals."""

import itertools
import math

import numpy as np

from lcmtypes.robot import kicker_state_t
from lcmtypes.soccer import game_state_t, match_event_t
from procs.evaluation.beliefs import Samples
from procs.evaluation.piece import Piece
from procs.model.robot import CYAN, side_of, team_of

OWN_M, THEIRS_M, DROPPED_M = 2.0, 3.0, 1.0
"""Distances from the ball at a set piece: of the team that takes it, of the other, and at a dropped ball."""
_TOLERANCE_M = 0.05
_HEAVY_M_S, _LIGHT_M_S = 3.0, 1.0
_CONTROL_S = 0.3
_FLIGHT_S = 4.0
_NUMBERS = {game_state_t.TEAM_CYAN: "cyan", game_state_t.TEAM_MAGENTA: "magenta"}


def conducted(piece: Piece) -> Samples:
    """Returns the samples of every measure of the play."""
    hits_m_s = [
        event.speed_m_s for events in piece.events.values() for event in events if event.kind == match_event_t.COLLISION
    ]
    goals = sum(event.kind == match_event_t.GOAL for events in piece.events.values() for event in events)
    distances, halves = _restarts(piece)
    return {
        "collisions above 1 m/s": np.array([(sum(hit > _LIGHT_M_S for hit in hits_m_s), piece.minutes)]),
        "collisions above 3 m/s": np.array([(sum(hit > _HEAVY_M_S for hit in hits_m_s), piece.minutes)]),
        "distance violated at restarts": np.array(distances, np.float64),
        "half violated at kick-offs": np.array(halves, np.float64),
        "passes controlled by the receiver": np.array(_passes(piece), np.float64),
        "goals": np.array([(goals, piece.minutes)]),
    }


def _restarts(piece: Piece) -> tuple[list[bool], list[bool]]:
    """Returns whether distances, and halves of the field, were violated when each set piece was released."""
    distances, halves = [], []
    ticks = sorted(piece.game)
    for before, tick in itertools.pairwise(ticks):
        game = piece.game[tick]
        if piece.game[before].stopped and not game.stopped and tick in piece.truth:
            distances.append(_too_near(piece, tick))
            if game.state == game_state_t.KICK_OFF:
                halves.append(_in_wrong_half(piece, tick))
    return distances, halves


def _too_near(piece: Piece, tick: int) -> bool:
    truth, game = piece.truth[tick], piece.game[tick]
    ball, taking = (truth.ball_x_m, truth.ball_y_m), _NUMBERS.get(game.state_team, "")
    mates_m = sorted(math.dist(ball, (each.x_m, each.y_m)) for each in truth.robots if team_of(each.name) == taking)
    others_m = [math.dist(ball, (each.x_m, each.y_m)) for each in truth.robots if team_of(each.name) != taking]
    limit_m = DROPPED_M if game.state == game_state_t.DROP_BALL else THEIRS_M
    return any(each < OWN_M - _TOLERANCE_M for each in mates_m[1:]) or min(others_m, default=99.0) < (
        limit_m - _TOLERANCE_M
    )


def _in_wrong_half(piece: Piece, tick: int) -> bool:
    game = piece.game[tick]
    ball = piece.truth[tick].ball_x_m, piece.truth[tick].ball_y_m
    robots = piece.truth[tick].robots
    taking = [each for each in robots if team_of(each.name) == _NUMBERS.get(game.state_team, CYAN)]
    taker = min(taking, key=lambda each: math.dist(ball, (each.x_m, each.y_m)), default=None)
    return any(
        each.x_m * side_of(team_of(each.name)) < -_TOLERANCE_M
        for each in robots
        if taker is None or each.name != taker.name
    )


def _passes(piece: Piece) -> list[bool]:
    """Returns for each pass whether a mate had the ball in its mouth for a while before another robot touched it."""
    controlled = []
    commands, kickers = piece.by_robot.get("skill_command", {}), piece.by_robot.get("kicker_state", {})
    for tick, events in piece.events.items():
        for event in events:
            asked = commands.get(event.robot, {}).get(tick - 1)
            if event.kind == match_event_t.KICK and asked and asked.skill == "pass":
                controlled.append(_receiver(piece, tick, event.robot, kickers) != "")
    return controlled


def _receiver(piece: Piece, kicked: int, passer: str, kickers: dict[str, dict[int, kicker_state_t]]) -> str:
    """Returns the mate that controls a pass; empty if a rival touches the ball first, or no robot does."""
    held: dict[str, int] = {}
    for tick in range(kicked + 1, kicked + round(_FLIGHT_S / piece.period_s)):
        touching = piece.touched_by(tick, 0.0) - {passer}
        if any(team_of(robot) != team_of(passer) for robot in touching):
            return ""
        for robot in sorted(touching):
            state = kickers.get(robot, {}).get(tick)
            held[robot] = held.get(robot, 0) + 1 if state and state.ball_held else 0
            if held[robot] * piece.period_s >= _CONTROL_S:
                return robot
    return ""
