"""Mates whose messages do not arrive: the own camera shows where they are."""

import numpy as np
import pytest

from lcmtypes.soccer import robot_estimate_t
from tests.procs.world_model.team_on_bench import PERIOD_S, Floats, Robot, TeamOnBench

OWN, OTHER = 1, 2  # colours of the teams


def places(estimates: list[robot_estimate_t]) -> list[tuple[float, float]]:
    return [(one.x_m, one.y_m) for one in estimates]


def watched(mate: Robot, others_m: tuple[Floats, ...] = ()) -> tuple[Robot, TeamOnBench]:
    """Returns a robot that has heard a mate and seen others for two seconds, and both together."""
    watching = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    both = TeamOnBench([watching, mate])
    for _ in range(40):
        both.tick(None, others_m=others_m, teams=(OWN,))
    return watching, both


def watch(robot: Robot, seen_m: list[Floats], teams: tuple[int, ...]) -> None:
    """Lets a robot look while its radio receives nothing."""
    robot.sense(None, seen_m, teams=teams)
    robot.bench.iterate()


def test_mate_whose_radio_broke_hides_no_opponent() -> None:
    """The mate drives away with a broken radio; an opponent and later the mate are seen where it was not."""
    opponent_m, gone_m = np.array((4.5, 1.0)), np.array((3.0, -1.5))
    watching, _ = watched(Robot("cyan3", (3.0, 0.0, 1.0), seed=2), (opponent_m,))
    for tick in range(80):
        if tick == 40:
            assert watching.world.mates[0].covariance_m2[0][0] > 0.9  # its last place is old
        watch(watching, [opponent_m, gone_m][: 1 + (tick >= 40)], (OTHER, OWN))
        assert places(watching.world.opponents) == [pytest.approx((4.5, 1.0), abs=0.2)]
    assert places(watching.world.mates) == [pytest.approx((3.0, -1.5), abs=0.2)]
    assert watching.world.mates[0].covariance_m2[0][0] < 0.01
    assert watching.world.mates[0].age_s == pytest.approx(80 * PERIOD_S, abs=0.15)  # that of its message
    assert not watching.world.silent_mates


@pytest.mark.parametrize("again", [False, True])
def test_mate_is_followed_through_an_outage(again: bool) -> None:
    """The mate starts at 3 m/s², and its last message tells that it stands."""
    mate = Robot("cyan3", (3.0, -2.0, 1.0), seed=2)
    watching, both = watched(mate)
    for tick in range(1, 25):
        mate.pose[1] = -2.0 + 1.5 * (tick * PERIOD_S) ** 2
        watch(watching, [mate.pose[:2]], (OWN,))
        watch(mate, [], ())
        mate.bench.port("team_message").sent.clear()
        assert len(watching.world.mates) == 1
        assert not watching.world.silent_mates
    (found,) = watching.world.mates
    assert (found.x_m, found.y_m) == pytest.approx(tuple(mate.pose[:2]), abs=0.15)
    assert (found.vx_m_s, found.vy_m_s) == pytest.approx((0.0, 3.6), abs=0.7)
    for _ in range(20 if again else 0):
        both.tick(None, teams=(OWN,))
        assert len(watching.world.mates) == 1
        assert not watching.world.silent_mates
    assert places(watching.world.mates) == [pytest.approx(tuple(mate.pose[:2]), abs=0.15)]


def test_robot_beside_a_heard_mate_stays_a_silent_one() -> None:
    watching, both = watched(Robot("cyan3", (3.0, 0.0, 1.0), seed=2))
    beside_m = np.array((3.0, 0.8))
    for _ in range(20):
        both.tick(None, others_m=(beside_m,), teams=(OWN, OWN))
    assert places(watching.world.mates) == [pytest.approx((3.0, 0.0), abs=0.1)]
    assert places(watching.world.silent_mates) == [pytest.approx((3.0, 0.8), abs=0.1)]


def test_robot_out_of_reach_is_not_the_mate() -> None:
    """In half a second a mate strays a metre at most."""
    watching, _ = watched(Robot("cyan3", (3.0, 0.0, 1.0), seed=2))
    far_m = np.array((-2.0, 3.0))
    for _ in range(10):
        watch(watching, [far_m], (OWN,))
    assert places(watching.world.mates) == [pytest.approx((3.0, 0.0), abs=0.1)]
    assert places(watching.world.silent_mates) == [pytest.approx((-2.0, 3.0), abs=0.2)]
