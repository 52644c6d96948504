"""Quality of the robots' play: collisions, distances at restarts, passes, goals."""

import itertools
import math
from collections.abc import Iterator

import numpy as np

from lcmtypes.soccer import ground_truth_t, match_event_t
from procs.behaviour.roles import GOALKEEPER
from procs.evaluation.beliefs import Samples
from procs.evaluation.piece import Piece
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.robot import number_in
from procs.model.teams import Ends, Team
from procs.referee.positions import in_wrong_half, too_near
from procs.referee.restarts import Restart
from procs.referee.rules import Rules
from procs.referee.sight import LEAVES

_HEAVY_M_S, _LIGHT_M_S = 3.0, 1.0
_CONTROL_S = 0.3
_FLIGHT_S = 4.0
_TAKEN_S = 7.0
_LIES_M = 0.1  # a ball that has moved less still lies on its spot


def conducted(piece: Piece) -> Samples:
    """Returns the samples of every measure of the play."""
    hits_m_s = [
        event.speed_m_s for events in piece.events.values() for event in events if event.kind == match_event_t.COLLISION
    ]
    distances, halves = _restarts(piece)
    return {
        "collisions above 1 m/s": np.array([(sum(hit > _LIGHT_M_S for hit in hits_m_s), piece.minutes)]),
        "collisions above 3 m/s": np.array([(sum(hit > _HEAVY_M_S for hit in hits_m_s), piece.minutes)]),
        "distance violated at restarts": np.array(distances, np.float64),
        "half violated at kick-offs": np.array(halves, np.float64),
        "restarts taken within 7 s": np.array(_taken(piece), np.float64),
        "role changes of a field player": np.array([_role_changes(piece)]),
        "passes controlled by the receiver": np.array(_passes(piece), np.float64),
    }


def _restarts(piece: Piece) -> tuple[list[bool], list[bool]]:
    """Returns whether distances, and halves of the field, were violated at each set piece, until the ball moved."""
    distances, halves = [], []
    rules = Rules(field=piece.measures)
    for released in _released(piece):
        near, crossed = [], []
        for tick in _untaken(piece, released):
            restart, middles, ends = _standing(piece, tick, piece.truth[released])
            near += too_near(restart, middles, ends, rules, rules.tolerance_m)
            crossed += in_wrong_half(restart, middles, ends, rules.tolerance_m)
        if released in piece.truth:
            distances.append(bool(near))
            if piece.game[released].state == State.KICK_OFF:
                halves.append(bool(crossed))
    return distances, halves


def _untaken(piece: Piece, released: int) -> Iterator[int]:
    """Yields the ticks of a set piece from its release on while its ball lies where it was laid.

    A dropped ball is free from its release on, so that there is one tick of it.
    """
    state = piece.game[released].state
    for tick in itertools.count(released):
        if tick not in piece.truth or tick not in piece.game:
            return
        game, laid, ball = piece.game[tick], piece.truth[released], piece.truth[tick]
        moved_m = math.dist((ball.ball_x_m, ball.ball_y_m), (laid.ball_x_m, laid.ball_y_m))
        if game.stopped or game.state != state or moved_m > _LIES_M:
            return
        yield tick
        if state == State.DROP_BALL:
            return


def _standing(piece: Piece, tick: int, laid: ground_truth_t) -> tuple[Restart, dict[str, Point], Ends]:
    """Returns a set piece whose ball was `laid`, the middles of the robots on the field in a tick, and their ends."""
    game, truth = piece.game[tick], piece.truth[tick]
    playing = [robot for robot in truth.robots if robot.name not in game.sent_off]
    middles = {f"{piece.team(robot.name)}{number_in(robot)}": Point(robot.x_m, robot.y_m) for robot in playing}
    spot = Point(laid.ball_x_m, laid.ball_y_m)
    return Restart(State(game.state), Team(game.state_team), spot), middles, Ends.told(game.cyan_side)


def _released(piece: Piece) -> Iterator[int]:
    """Yields the ticks in which set pieces are released."""
    for before, tick in itertools.pairwise(sorted(piece.game)):
        if piece.game[before].stopped and not piece.game[tick].stopped:
            yield tick


def _taken(piece: Piece) -> list[bool]:
    """Returns whether its team kicked the ball in time, for each set piece that the referee does not stop before.

    One that the piece ends too soon for is left out, taken or not: otherwise only those that were taken would count.
    """
    taken = []
    for tick in _released(piece):
        team = Team(piece.game[tick].state_team)
        in_time = range(tick, tick + round(_TAKEN_S / piece.period_s) + 1)
        if in_time[-1] > max(piece.game):
            continue
        running = list(itertools.takewhile(lambda each: each in piece.game and not piece.game[each].stopped, in_time))
        events = [event for each in running for event in piece.events.get(each, ())]
        kicked = any(each.kind == match_event_t.KICK and piece.team(each.robot) == team.name.lower() for each in events)
        if team is not Team.NONE and (kicked or len(running) == len(in_time)):
            taken.append(kicked)
    return taken


def _role_changes(piece: Piece) -> tuple[int, float]:
    """Returns how often robots took another role in play, and the minutes that they played, all together."""
    changes, ticks = 0, 0
    for robot in piece.by_robot.get("role", {}):
        for tick in piece.game:
            both = piece.newest("role", robot, tick - 1), piece.newest("role", robot, tick)
            running = piece.game[tick].state == State.PLAY and not piece.game[tick].stopped
            if running and both[0] and both[1] and GOALKEEPER not in (both[0].role, both[1].role):
                ticks += 1
                changes += both[0].role != both[1].role
    return changes, ticks * piece.period_s / 60


def _passes(piece: Piece) -> list[bool]:
    """Returns for each pass whether a mate had the ball in its mouth for a while before another robot touched it.

    A pass of which the piece does not show the end is left out, as is one that a foul elsewhere interrupts.
    """
    controlled = []
    for tick, events in piece.events.items():
        for event in events:
            running = piece.newest("skill_status", event.robot, tick - 1)
            if event.kind == match_event_t.KICK and running and running.skill == "pass":
                outcome = _is_controlled(piece, tick, event.robot)
                if outcome is not None:
                    controlled.append(outcome)
    return controlled


def _left(piece: Piece, *ticks: int) -> bool:
    """Returns whether the ball left the field in one of the ticks."""
    return any(event.kind in LEAVES for tick in ticks for event in piece.events.get(tick, ()))


def _is_controlled(piece: Piece, kicked: int, passer: str) -> bool | None:
    """Returns whether a mate controls a pass; none does if a rival or no robot touches it, or if it leaves the field.

    None if the piece ends before that is known, or the referee stops the game for another reason.
    """
    held: dict[str, int] = {}
    for tick in range(kicked + 1, kicked + round(_FLIGHT_S / piece.period_s)):
        if _left(piece, tick - 1, tick):
            return False
        if tick not in piece.truth or (tick in piece.game and piece.game[tick].stopped):
            return None
        touching = piece.touched_by(tick, 0.0) - {passer}
        if any(piece.team(robot) != piece.team(passer) for robot in touching):
            return False
        for robot in sorted(touching):
            state = piece.newest("kicker_state", robot, tick)
            held[robot] = held.get(robot, 0) + 1 if state and state.ball_held else 0
            if held[robot] * piece.period_s >= _CONTROL_S:
                return True
    return False
