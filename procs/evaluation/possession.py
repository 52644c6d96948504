"""Figures of a match: shots, goals of each team, share of time without a robot at the ball, captures that bounce."""

import numpy as np

from lcmtypes.soccer import match_event_t
from procs.evaluation.beliefs import Samples
from procs.evaluation.piece import Piece
from procs.model.game_states import State

_SHOOTING = ("shoot", "lob")  # skills
_SHOT_M_S = 6.0
_FREE_S = 0.3  # without a touch for so long the ball is free
_BOUNCED_S = 0.6  # a ball that is free again so soon after its capture has bounced off


def possession(piece: Piece) -> Samples:
    """Returns the samples of every measure."""
    free = {tick: not piece.touched_by(tick, _FREE_S) for tick in _played(piece)}
    last = piece.game[max(piece.game)] if piece.game else None
    scores = (last.score_cyan, last.score_magenta) if last else (0, 0)
    return {
        "shots": np.array([(len(_shots(piece)), piece.minutes)]),
        "goals": np.array([(sum(scores), piece.minutes)]),
        "goals of cyan": np.array([(scores[0], piece.minutes)]),
        "goals of magenta": np.array([(scores[1], piece.minutes)]),
        "goals of cyan less those of magenta": np.array([(scores[0] - scores[1], piece.minutes)]),
        "won by cyan": np.array([scores[0] > scores[1]], np.float64),
        "lost by cyan": np.array([scores[0] < scores[1]], np.float64),
        "ball free": np.array(list(free.values()), np.float64),
        "captures that bounce": np.array(_bounces(piece), np.float64),
    }


def _played(piece: Piece) -> list[int]:
    return [tick for tick in sorted(piece.truth) if tick in piece.game and piece.game[tick].state == State.PLAY]


def _shots(piece: Piece) -> list[match_event_t]:
    """Returns the fast kicks of the skills that shoot."""
    return [
        event
        for tick, events in piece.events.items()
        for event in events
        if event.kind == match_event_t.KICK and event.speed_m_s > _SHOT_M_S
        for running in [piece.newest("skill_status", event.robot, tick - 1)]
        if running and running.skill in _SHOOTING
    ]


def _bounces(piece: Piece) -> list[bool]:
    """Returns for each first touch of a free ball whether the ball was soon free again, without a kick.

    One that a whistle or the end of the piece follows too soon is left out.
    """
    soon, found = round(_BOUNCED_S / piece.period_s), []
    played = dict.fromkeys(_played(piece))
    for tick in played:
        after = range(tick + 1, tick + 1 + soon)
        if (
            not all(each in played for each in after)
            or not piece.touched_by(tick, 0.0)
            or piece.touched_by(tick - 1, _FREE_S)
        ):
            continue
        kinds = {event.kind for each in (tick, *after) for event in piece.events.get(each, ())}
        if match_event_t.KICK not in kinds:
            found.append(not piece.touched_by(after.stop - 1, _FREE_S))
    return found
