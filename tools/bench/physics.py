"""Measures the physics of a match alone: `python -m tools.bench.physics` prints its speed."""

import itertools
import math
import time
from typing import Annotated

import numpy as np
import typer

from procs.model.kinematics import Velocity, wheels_of
from procs.model.robot import PLAYERS, ROBOT
from procs.simulation.physics.kick_mechanism import KickerCommand
from procs.simulation.physics.realism import noise_of
from procs.simulation.physics.settings import PhysicsSettings
from procs.simulation.physics.world import World
from tools.bench import program

_TICK_US = 50_000
_STEPS_S = (0.005, 0.002)
_SPEED_M_S, _TURN_RAD_S, _KICK_M_S = 2.0, 2.0, 6.0
_CHASER = 2  # number of the robot of each team that wants the ball


def command(world: World, tick: int, fight: bool) -> None:
    """Lets all robots drive in circles; in a fight, one of each team chases the ball and kicks it once a second."""
    for name, robot in world.robots.items():
        chases = fight and PLAYERS[name].number == _CHASER
        away = world.ball.body.position - robot.body.position
        towards_rad = math.atan2(away.y, away.x) - robot.body.angle if chases else 0.0
        turn_rad_s = math.sin(towards_rad) if chases else _TURN_RAD_S
        wish = Velocity(_SPEED_M_S * math.cos(towards_rad), _SPEED_M_S * math.sin(towards_rad), turn_rad_s)
        robot.drive.command(wheels_of(wish, ROBOT.wheel_distance_m), world.time_us)
        kick_m_s = _KICK_M_S if chases and tick % 20 == 0 else 0.0
        world.kickers[name].command(KickerCommand(tick, kick_m_s, dribble=chases), world.time_us)


def seconds_of(step_s: float, match_s: float, fight: bool) -> float:
    """Returns the processor time of ten robots in steps of `step_s`; in a fight two of them are at the ball."""
    rng, noise = np.random.default_rng(1), noise_of("realistic", {})
    world = World(list(PLAYERS), rng, physics=PhysicsSettings(step_s=step_s), noise=noise)
    took_s = 0.0
    for tick in range(round(match_s * 1e6 / _TICK_US)):
        command(world, tick, fight)
        began_s = time.process_time()
        world.advance(_TICK_US)
        took_s += time.process_time() - began_s
        if not world.ball_in_field:
            world.place_ball(0.0, 0.0)
    return took_s


def main(
    seconds: Annotated[float, typer.Option(min=0.05, max=3600.0, help="Duration of a match")] = 20.0,
    rounds: Annotated[int, typer.Option(min=1, help="Matches of each size of step; the fastest counts")] = 5,
) -> None:
    """Prints the least processor time of each size of step."""
    for step_s, fight in itertools.product(_STEPS_S, (False, True)):
        took_s = min(seconds_of(step_s, seconds, fight) for _ in range(rounds))
        play = "two robots fight for the ball" if fight else "no robot is at the ball"
        print(
            f"steps of {step_s * 1000:g} ms, {play}: "
            f"{seconds / took_s:.1f} times real time, {took_s / (seconds / step_s) * 1e6:.1f} us a step"
        )


if __name__ == "__main__":
    program.run(main)
