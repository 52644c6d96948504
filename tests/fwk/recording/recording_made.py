"""Builds short logs directly, like those of a run of a small system."""

from pathlib import Path
from typing import Any

from fwk.lcm import messages
from fwk.lcm.event_log import LogWriter
from lcmtypes.core import log_t
from lcmtypes.robot import odometry_t
from lcmtypes.soccer import ball_estimate_t, mate_estimate_t, world_model_t

Entry = tuple[str, bytes, int]
"""Channel, message, logical time in µs."""

PERIOD_US = 50_000
WRITERS = {"odometry": (1, "base"), "world_model": (4, "world_model")}


def entries(ticks: int = 20, robots: int = 2) -> list[Entry]:
    """A run in the recorder's order: for each tick odometry, world models and a line of text."""
    made: list[Entry] = []
    for tick in range(1, ticks + 1):
        for robot in range(1, robots + 1):
            made.append(entry(f"cyan{robot}/odometry", odometry(tick, robot), tick))
        for robot in range(1, robots + 1):
            made.append(entry(f"cyan{robot}/world_model", world_model(tick, robot), tick))
        line = log_t()
        line.text = f"tick {tick}"
        made.append(("fwk/log", line.encode(), tick * PERIOD_US))
    return made


def entry(channel: str, message: Any, tick: int) -> Entry:
    """Stamps a message; its sequence number is the tick."""
    namespace, _, short = channel.rpartition("/")
    stage, writer = WRITERS[short]
    message.header.tick = message.header.sequence = tick
    message.header.time_us = tick * PERIOD_US
    message.header.stage = stage
    message.header.writer = f"{namespace}/{writer}"
    return channel, messages.encode(message, channel), tick * PERIOD_US


def odometry(tick: int, robot: int) -> odometry_t:
    """A robot that drives straight on."""
    made = odometry_t()
    made.x_m, made.vx_m_s = 0.05 * tick * robot, float(robot)
    return made


def world_model(tick: int, robot: int) -> world_model_t:
    """A ball that rolls, and one team mate."""
    made = world_model_t()
    made.ball = ball_estimate_t()
    made.ball.known, made.ball.x_m, made.ball.vx_m_s = True, 0.1 * tick, 2.0
    made.mates = [mate_estimate_t(name=f"cyan{3 - robot}", x_m=0.5, role="attacker")]
    return made


def write(path: Path, made: list[Entry]) -> Path:
    """Writes a log of these events."""

    def refuse(text: str) -> None:
        raise AssertionError(text)

    with LogWriter(path, refuse) as writer:
        for channel, data, time_us in made:
            writer.append(channel, data, time_us)
    return path
