"""Measures the world model's filters beside filterpy's: `python -m tools.bench.filters` prints both and their ratio."""

import time
from collections.abc import Callable
from typing import Annotated

import numpy as np
import typer

from procs.model.ball import BALL
from procs.model.estimation import predict, update
from procs.model.frames import Floats
from procs.world_model.ball_filter import BallFilter
from procs.world_model.ball_modes import MODES, STATES, noise, passes
from procs.world_model.robot_tracks import RobotTracks
from tools.bench import program

_TICK_S = 0.04
_ROLLING_M_S2 = 0.3
_ROBOTS, _ROBOT_STATES = 9, 6
_SPREAD_M2: Floats = np.eye(2) * 0.05**2

Step = Callable[[Floats], object]
"""One tick: takes the places (n, 2) in m that a robot sees, of the ball or of robots."""


def own_ball() -> Step:
    """Returns the tick of the world model's ball: four models, with friction."""
    track = BallFilter(np.zeros(2), _SPREAD_M2, BALL)

    def step(places_m: Floats) -> None:
        track.predict(_TICK_S, _ROLLING_M_S2)
        track.see(places_m[0], _SPREAD_M2)

    return step


def library_ball() -> Step:
    """Returns the same tick with filterpy's interacting multiple models, without friction."""
    from filterpy.kalman import IMMEstimator, KalmanFilter  # takes half a second, for scipy.stats

    filters = []
    for added in noise(_TICK_S, BALL.rolling_share):
        made = KalmanFilter(dim_x=STATES, dim_z=2)
        made.F[:2, 2:4] = np.eye(2) * _TICK_S
        made.H, made.R, made.Q = np.eye(2, STATES), _SPREAD_M2, added
        filters.append(made)
    moves = passes(_TICK_S, contact=0.0, slow=False, flies=False)
    mixture = IMMEstimator(filters, np.full(MODES, 1.0 / MODES), moves)

    def step(places_m: Floats) -> None:
        mixture.predict()
        mixture.update(places_m[0])

    return step


def own_robots() -> Step:
    """Returns the tick of the world model's robots, which also finds the track of each sighting."""
    tracks, spreads_m2 = RobotTracks(), np.tile(_SPREAD_M2, (_ROBOTS, 1, 1))

    def step(places_m: Floats) -> None:
        tracks.predict(_TICK_S, 1.0)
        tracks.see(places_m, spreads_m2)

    return step


def library_robots() -> Step:
    """Returns the same tick with filterpy's functions, robot by robot, for sightings of known tracks."""
    motion, seen_as = np.eye(_ROBOT_STATES), np.eye(2, _ROBOT_STATES)
    motion[:4, 2:] += np.eye(4) * _TICK_S
    added = np.eye(_ROBOT_STATES) * 0.01
    tracks = [(np.zeros(_ROBOT_STATES), np.eye(_ROBOT_STATES)) for _ in range(_ROBOTS)]

    def step(places_m: Floats) -> None:
        for number, (state, covariance) in enumerate(tracks):
            state, covariance = predict(state, covariance, F=motion, Q=added)
            tracks[number] = update(state, covariance, places_m[number], _SPREAD_M2, H=seen_as)

    return step


def microseconds_of(step: Step, ticks: int) -> float:
    """Returns the processor time of a tick in us, over `ticks` ticks in which everything moves at 1 m/s."""
    rng = np.random.default_rng(1)
    starts_m = np.column_stack((np.zeros(_ROBOTS), np.arange(_ROBOTS)))
    ways_m = np.outer(np.arange(ticks) * _TICK_S, (1.0, 0.0))
    seen_m = starts_m + ways_m[:, None] + rng.normal(0.0, 0.05, (ticks, _ROBOTS, 2))
    began_s = time.process_time()
    for places_m in seen_m:
        step(places_m)
    return (time.process_time() - began_s) / ticks * 1e6


def main(
    ticks: Annotated[int, typer.Option(min=1, help="Ticks of a round")] = 500,
    rounds: Annotated[int, typer.Option(min=1, help="Rounds of each filter, by turns; the fastest counts")] = 5,
) -> None:
    """Prints the least processor time of each filter."""
    for what, own, library in (
        ("the ball, four models", own_ball, library_ball),
        (f"{_ROBOTS} robots", own_robots, library_robots),
    ):
        turns = [(microseconds_of(own(), ticks), microseconds_of(library(), ticks)) for _ in range(rounds)]
        own_us, library_us = (min(column) for column in zip(*turns, strict=True))
        typer.echo(f"{what}: {own_us:.0f} us, with filterpy's {library_us:.0f} us, {library_us / own_us:.1f} times")


if __name__ == "__main__":
    program.run(main)
