"""Delays between robots and within them, and the load of the radio."""

from collections import defaultdict
from collections.abc import Mapping, Sequence

import numpy as np

from procs.evaluation.beliefs import Samples
from procs.evaluation.piece import Piece
from procs.evaluation.poses import START_S
from procs.model.algebra import Floats
from procs.model.geometry import plausible
from procs.model.units import US_PER_S

_BIT_PER_MBIT = 1e6
_LAGS_S = np.arange(0.0, 0.5, 0.005)  # between a command and the motion of the wheels


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
        "radio, age of a mate's newest message, 95 %": np.array(_ages_s(piece)),
        "picture to motion of the wheels, 95 %": np.array(_loops_s(piece)),
    }


def _ages_s(piece: Piece) -> list[float]:
    """Returns how old the newest message of each mate is in each tick of a robot: inboxes are read a tick later."""
    ages_s = []
    for inboxes in piece.by_robot.get("team_inbox", {}).values():
        newest_us: dict[str, int] = {}
        for _, inbox in sorted(inboxes.items()):
            for message in inbox.messages:
                newest_us[message.robot] = max(message.header.time_us, newest_us.get(message.robot, 0))
            ages_s += [(inbox.header.time_us - sent_us) / US_PER_S + piece.period_s for sent_us in newest_us.values()]
    return ages_s


def _loops_s(piece: Piece) -> list[float]:
    """Returns the time from each exposure until the wheels turn as the commands that take it into account say.

    All components from the detector to the base iterate in the tick in which the picture arrives. From their command on
    it takes as long as the wheels lag behind commands.
    """
    commands = piece.by_robot.get("wheel_command", {})
    lags_s = {robot: _lag_s(piece, robot) for robot in commands}
    return [
        (percept.header.time_us - percept.capture_us) / US_PER_S + lag_s
        for robot, percepts in piece.by_robot.get("ball_percept", {}).items()
        for tick, percept in percepts.items()
        if percept.capture_us and tick in commands.get(robot, {}) and tick * piece.period_s >= START_S
        if (lag_s := lags_s[robot]) is not None
    ]


def _lag_s(piece: Piece, robot: str) -> float | None:
    """Returns the time after which the wheels of a robot turn most nearly as commanded; None if they stand.

    Measured speeds are means of a tick, and count in its middle.
    """
    commands = piece.by_robot["wheel_command"][robot]
    states = piece.by_robot.get("wheel_state", {}).get(robot, {})
    times_s, wanted_m_s = _wheels({tick: command.wheel_m_s for tick, command in commands.items()}, piece.period_s)
    ends_s, turning_m_s = _wheels({tick: state.measured_m_s for tick, state in states.items()}, piece.period_s)
    middles_s = ends_s - piece.period_s / 2
    compared = (times_s >= START_S) & (times_s + _LAGS_S[-1] <= middles_s.max(initial=0.0))
    times_s, wanted_m_s = times_s[compared], wanted_m_s[:, compared]
    if not wanted_m_s.any():
        return None
    errors_m2_s2 = [
        sum(
            float(((np.interp(times_s + lag_s, middles_s, turning) - wanted) ** 2).sum())
            for turning, wanted in zip(turning_m_s, wanted_m_s, strict=True)
        )
        for lag_s in _LAGS_S
    ]
    return float(_LAGS_S[np.argmin(errors_m2_s2)])


def _wheels(speeds_m_s: Mapping[int, Sequence[float]], period_s: float) -> tuple[Floats, Floats]:
    """Returns the times (n) and the speeds (3, n) of the ticks in which all three wheels have one."""
    sound = {tick: speeds for tick, speeds in speeds_m_s.items() if len(speeds) == 3 and plausible(*speeds)}
    return np.array(list(sound)) * period_s, np.array(list(sound.values())).reshape(-1, 3).T
