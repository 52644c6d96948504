"""Delays between robots and within them, and the load of the radio."""

from collections import defaultdict

import numpy as np

from procs.evaluation.beliefs import Samples
from procs.evaluation.piece import Piece
from procs.evaluation.poses import START_S

_BIT_PER_MBIT = 1e6


def delays(piece: Piece) -> Samples:
    """Returns the samples of every measure of delays and of the radio."""
    said_bit: dict[str, int] = defaultdict(int)
    for robot, size_bytes in piece.told_bytes.items():
        said_bit[piece.team(robot)] += 8 * size_bytes
    messages = sum(map(len, piece.by_robot.get("team_message", {}).values()))
    robots_s = len(piece.by_robot.get("team_message", {})) * 60 * piece.minutes
    volumes = [(bits / _BIT_PER_MBIT, 60 * piece.minutes) for bits in said_bit.values()]
    return {
        "radio, volume of a team": np.array(volumes).reshape(-1, 2),
        "radio, messages of a robot": np.array([(messages, robots_s)] if messages else []).reshape(-1, 2),
        "radio, age of a message, 95 %": np.array(_ages_s(piece)),
        "picture to motor command, 95 %": np.array(_reactions_s(piece)),
    }


def _ages_s(piece: Piece) -> list[float]:
    """Returns the time from writing to reading of each message that a mate gets: inboxes are read a tick later."""
    return [
        (inbox.header.time_us - message.header.time_us) / 1e6 + piece.period_s
        for inboxes in piece.by_robot.get("team_inbox", {}).values()
        for inbox in inboxes.values()
        for message in inbox.messages
    ]


def _reactions_s(piece: Piece) -> list[float]:
    """Returns the time from each exposure to the motor command that takes it into account.

    All components from the detector to the navigator iterate in the tick in which the picture arrives.
    """
    commands = piece.by_robot.get("motor_command", {})
    return [
        (percept.header.time_us - percept.capture_us) / 1e6
        for robot, percepts in piece.by_robot.get("ball_percept", {}).items()
        for tick, percept in percepts.items()
        if percept.capture_us and tick in commands.get(robot, {}) and tick * piece.period_s >= START_S
    ]
