"""The ball that the crew puts on the spot of a set piece."""

import math

import numpy as np
import pytest

from lcmtypes.soccer import game_state_t
from procs.model.game_states import State
from tests.procs.world_model.team_on_bench import PERIOD_S, Floats, Robot, TeamOnBench

SPOT_M = (4.0, -6.9)
THERE = pytest.approx(SPOT_M, abs=0.15)


class Whistles:
    """The referee's state of the game, told to robots from the tick after a whistle on."""

    def __init__(self, *robots: Robot) -> None:
        self.robots = robots
        self.state, self.stopped, self.time_s = State.PLAY, False, 0.0

    def whistle(self, state: State, stopped: bool = True) -> None:
        self.state, self.stopped, self.time_s = state, stopped, 0.0

    def tell(self) -> None:
        for robot in self.robots:
            robot.bench.port("game_state").put(
                state=self.state,
                stopped=self.stopped,
                state_team=game_state_t.TEAM_CYAN,
                ball_x_m=SPOT_M[0],
                ball_y_m=SPOT_M[1],
                time_in_state_s=self.time_s,
            )
        self.time_s += PERIOD_S


def seer() -> tuple[Robot, Whistles]:
    robot = Robot("cyan1", (1.0, -4.0, 0.0), seed=3)
    return robot, Whistles(robot)


def look(robot: Robot, whistles: Whistles, ball_m: Floats | None) -> tuple[float, float]:
    """Runs a tick; returns where the robot believes the ball to be."""
    whistles.tell()
    robot.sense(ball_m, [])
    robot.bench.iterate()
    return robot.world.ball.x_m, robot.world.ball.y_m


def rolled_out(robot: Robot, whistles: Whistles) -> None:
    """Lets the ball roll over the touch line, out of sight from there on."""
    for tick in range(12):
        look(robot, whistles, np.array((4.0, -4.2 - 0.2 * tick)))


def test_ball_that_rolled_out_unseen_lies_on_the_spot() -> None:
    robot, whistles = seer()
    rolled_out(robot, whistles)
    whistles.whistle(State.THROW_IN)
    for _ in range(60):  # longer than a ball is remembered
        assert look(robot, whistles, None) == THERE
        assert math.hypot(robot.world.ball.vx_m_s, robot.world.ball.vy_m_s) < 0.1


def test_ball_in_play_is_not_on_a_spot() -> None:
    robot, whistles = seer()
    for _ in range(5):
        look(robot, whistles, np.array((0.0, -3.0)))
    assert look(robot, whistles, None) == pytest.approx((0.0, -3.0), abs=0.15)
    for _ in range(60):
        look(robot, whistles, None)
    assert not robot.world.ball.known


@pytest.mark.parametrize("state", [State.HALF_TIME, State.FROZEN])
def test_no_ball_is_put_down_while_no_set_piece_waits(state: State) -> None:
    robot, whistles = seer()
    whistles.whistle(state)
    look(robot, whistles, None)
    assert not robot.world.ball.known


def test_dropped_ball_that_is_free_can_be_anywhere() -> None:
    robot, whistles = seer()
    whistles.whistle(State.DROP_BALL)
    assert look(robot, whistles, None) == THERE
    whistles.whistle(State.DROP_BALL, stopped=False)
    for _ in range(60):
        look(robot, whistles, None)
    assert not robot.world.ball.known


def test_ball_that_is_seen_beside_the_spot_stays_there() -> None:
    robot, whistles = seer()
    beside_m = (SPOT_M[0] - 0.4, SPOT_M[1])
    for _ in range(10):
        look(robot, whistles, np.array(beside_m))
    whistles.whistle(State.THROW_IN)
    assert look(robot, whistles, None) == pytest.approx(beside_m, abs=0.1)


def test_ball_that_the_crew_left_elsewhere_is_found() -> None:
    robot, whistles = seer()
    rolled_out(robot, whistles)
    whistles.whistle(State.THROW_IN)
    look(robot, whistles, None)
    for _ in range(3):
        found = look(robot, whistles, np.array((4.0, -5.0)))
    assert found == pytest.approx((4.0, -5.0), abs=0.1)


def test_sighting_from_before_the_whistle_moves_no_placed_ball() -> None:
    near, far = Robot("cyan1", (1.0, -4.0, 0.0), seed=3), Robot("cyan2", (-9.0, 5.0, 0.0), seed=4)
    whistles, both = Whistles(near, far), TeamOnBench([near, far])
    for tick in range(12):
        whistles.tell()
        both.tick(np.array((4.0, -4.2 - 0.2 * tick)), blind=("cyan2",))
    whistles.whistle(State.THROW_IN)
    for _ in range(3):  # the message with the last sighting arrives after the whistle
        whistles.tell()
        both.tick(None)
        assert (far.world.ball.x_m, far.world.ball.y_m) == THERE
