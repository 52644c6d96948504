"""Tracks of other robots: accuracy, association, ghosts, and the exclusion of mates."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from fwk.testing import Bench
from lcmtypes.soccer import obstacle_t
from procs.model.frames import rotation
from procs.world_model.robot_tracks import RobotTracks, any_near, without_known
from procs.world_model.team import Mate, Places, Team
from procs.world_model.world_model import WorldModel

Floats = NDArray[np.float64]
PERIOD_S = 0.05


def spreads(count: int, deviation_m: float) -> Floats:
    return np.tile(np.eye(2) * deviation_m**2, (count, 1, 1))


def test_crossing_robots_keep_their_tracks() -> None:
    rng = np.random.default_rng(1)
    tracks = RobotTracks()
    positions = np.array([[-2.0, 0.0], [2.0, 0.6], [0.0, 4.0]])
    velocities = np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 0.0]])
    errors: list[float] = []
    raw: list[float] = []
    for _ in range(80):
        positions = positions + velocities * PERIOD_S
        seen = positions + 0.12 * rng.standard_normal(positions.shape)
        order = rng.permutation(3)
        recognised = order[rng.random(3) < 0.8]
        tracks.predict(PERIOD_S, 1.0)
        tracks.see(seen[recognised], spreads(len(recognised), 0.12))
        apart = np.hypot(*(tracks.states[None, tracks.sure, :2] - positions[:, None]).transpose(2, 0, 1))
        errors += apart.min(axis=1).tolist() if apart.size else []
        raw += np.hypot(*(seen - positions).T).tolist()
    assert len(tracks.sure) == 3
    assert np.sqrt(np.mean(np.square(errors[15:]))) < 0.85 * np.sqrt(np.mean(np.square(raw)))


def test_each_track_keeps_a_number_of_its_own() -> None:
    """The first robot is lost and comes back: then it has a new number."""
    tracks, places_m = RobotTracks(), np.array([[-2.0, 0.0], [0.0, 4.0]])
    numbers = []
    for tick in range(60):
        tracks.predict(PERIOD_S, 0.5)
        seen_m = places_m[1:] if 20 <= tick < 40 else places_m
        tracks.see(seen_m, spreads(len(seen_m), 0.05))
        numbers.append(dict(zip(tracks.states[:, 0].round().tolist(), tracks.ids.tolist(), strict=True)))
    assert numbers[19] == {-2.0: 1, 0.0: 2}
    assert numbers[39] == {0.0: 2}
    assert numbers[59] == {-2.0: 3, 0.0: 2}


@pytest.mark.parametrize(("radius_m", "count"), [(0.15, 2), (0.25, 1)])
def test_slim_robots_side_by_side_are_two(radius_m: float, count: int) -> None:
    bench = Bench(WorldModel, "cyan1/world_model", robot={"radius_m": radius_m})
    for _ in range(10):
        bench.port("pose").put(localized=True, covariance=(np.eye(3) * 1e-4).tolist())
        obstacles = [obstacle_t(x_m=2.0, y_m=y_m, covariance_m2=(np.eye(2) * 4e-4).tolist()) for y_m in (0.0, 0.32)]
        bench.port("obstacle_percepts").put(obstacles=obstacles)
        bench.iterate()
    assert len(bench.port("world_model").sent[-1].opponents) == count


@pytest.mark.parametrize("border_m", [1.0, 2.0])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_robot_at_the_wall_is_an_opponent_and_none_behind(side: float, border_m: float) -> None:
    bench = Bench(WorldModel, "cyan1/world_model", field={"border_m": border_m})
    wall_m, rng, known = 7.0 + border_m, np.random.default_rng(1), []
    for _ in range(40):
        bench.port("pose").put(x_m=2.0, y_m=side * 5.0, localized=True, covariance=(np.eye(3) * 1e-4).tolist())
        places_m = [(x_m, side * (y_m - 5.0)) for x_m, y_m in ((1.0, wall_m - 0.25), (-1.0, wall_m + 0.25))]
        seen_m = places_m + 0.04 * rng.standard_normal((2, 2))
        shown = [obstacle_t(x_m=x_m, y_m=y_m, covariance_m2=(np.eye(2) * 16e-4).tolist()) for x_m, y_m in seen_m]
        bench.port("obstacle_percepts").put(obstacles=shown)
        bench.iterate()
        known.append([round(each.x_m) for each in bench.port("world_model").sent[-1].opponents])
    assert known[2:] == [[3]] * 38


def test_track_follows_a_robot_that_brakes_and_turns_round() -> None:
    """A robot drives at 2.5 m/s, brakes at 3 m/s2 and drives back; it is seen ten times a second."""
    rng, tracks = np.random.default_rng(2), RobotTracks()
    x_m, vx_m_s, behind_m = -2.0, 2.5, []
    for tick in range(60):
        if tick >= 20:
            vx_m_s = max(-2.5, vx_m_s - 3.0 * 0.05)
        x_m += vx_m_s * 0.05
        tracks.predict(0.05, 1.0)
        if tick % 2:
            seen_m = np.array((x_m, 0.0)) + 0.04 * rng.standard_normal(2)
            tracks.see(seen_m[None], np.eye(2)[None] * 0.04**2)
        if tick >= 24:
            behind_m.append(abs(tracks.states[0, 0] - x_m))
    assert np.sqrt(np.mean(np.square(behind_m))) < 0.07


def test_track_lags_behind_no_robot_that_starts() -> None:
    """Robots start at 3 m/s2, drive at 2.5 m/s and brake; each is seen every second tick, 75 ms late."""
    behind, driven = 0.0, 0.0
    for seed in range(12):
        rng, tracks = np.random.default_rng(seed), RobotTracks()
        speeds_m_s = np.clip(np.minimum(3.0 * 0.04 * np.arange(60), 2.5), 0.0, 3.0 * 0.04 * np.arange(60)[::-1])
        places_m = np.cumsum(speeds_m_s) * 0.04
        for tick in range(2, 60):
            tracks.predict(0.04, 1.0)
            if tick % 2:
                late_m = np.interp(tick - 75 / 40, np.arange(60), places_m)
                seen_m = np.array((late_m, 0.0)) + 0.03 * rng.standard_normal(2)
                tracks.see(seen_m[None], np.eye(2)[None] * 0.03**2, 0.075)
            if speeds_m_s[tick] > 0.5 and len(tracks):
                behind += (places_m[tick] - tracks.states[0, 0]) * speeds_m_s[tick]
                driven += speeds_m_s[tick] ** 2
    assert abs(behind / driven) < 0.004


def test_ghost_seen_once_is_never_reported() -> None:
    tracks = RobotTracks()
    tracks.predict(PERIOD_S, 1.0)
    tracks.see(np.array([[1.0, 1.0]]), spreads(1, 0.1))
    for _ in range(10):
        assert len(tracks.sure) == 0
        tracks.predict(PERIOD_S, 1.0)
    assert len(tracks.states) == 0


def test_robot_that_is_gone_is_forgotten_after_the_timeout() -> None:
    tracks = RobotTracks()
    for _ in range(5):
        tracks.predict(PERIOD_S, 1.0)
        tracks.see(np.array([[1.0, 1.0]]), spreads(1, 0.1))
    for _ in range(19):
        tracks.predict(PERIOD_S, 1.0)
    assert len(tracks.sure) == 1
    tracks.predict(PERIOD_S, 1.0)
    tracks.predict(PERIOD_S, 1.0)
    assert len(tracks.sure) == 0


def test_sightings_of_one_opponent_by_two_robots_give_one_track() -> None:
    tracks = RobotTracks()
    for _ in range(10):
        tracks.predict(PERIOD_S, 1.0)
        tracks.see(np.array([[1.0, 1.0]]), spreads(1, 0.1))
        tracks.see(np.array([[1.15, 1.05]]), spreads(1, 0.1))
    assert len(tracks.states) == 1
    assert tracks.states[0, :2] == pytest.approx((1.08, 1.02), abs=0.1)


def test_track_covariance_is_not_too_small() -> None:
    rng = np.random.default_rng(2)
    values = []
    for _ in range(40):
        tracks = RobotTracks()
        state = np.array((0.0, 0.0, *rng.uniform(-1, 1, 2)))
        for _ in range(40):
            push = math.sqrt(1.25 / PERIOD_S) * rng.standard_normal(2)
            state[:2] += state[2:] * PERIOD_S + push * PERIOD_S**2 / 2
            state[2:] += push * PERIOD_S
            tracks.predict(PERIOD_S, 1.0)
            tracks.see(state[None, :2] + 0.1 * rng.standard_normal((1, 2)), spreads(1, 0.1))
        error = tracks.states[0] - state
        values.append(float(error @ np.linalg.solve(tracks.covariances[0], error)))
    assert 2.5 < np.mean(values) < 5.5, "4 for an honest covariance"


def test_mate_explains_one_obstacle_and_the_opponent_stays() -> None:
    seen = np.array([[1.0, 0.0], [1.4, 0.0], [4.0, 4.0]])
    sharp = spreads(3, 0.05)
    remain = without_known(seen, sharp, np.array([[1.05, 0.0]]), spreads(1, 0.05), 0.5)
    assert remain.tolist() == [False, True, True]
    assert without_known(seen, sharp, np.zeros((0, 2)), sharp[:0], 0.5).all()
    assert without_known(np.zeros((0, 2)), sharp[:0], seen, sharp, 0.5).tolist() == []


def test_poorly_seen_mate_is_that_mate_from_further_away() -> None:
    seen, mate = np.array([[2.0, 0.0]]), np.array([[1.0, 0.0]])
    assert without_known(seen, spreads(1, 0.05), mate, spreads(1, 0.05), 0.5).all()
    assert not without_known(seen, spreads(1, 0.4), mate, spreads(1, 0.05), 0.5).any()


def test_team_keeps_the_newest_message_until_the_timeout() -> None:
    def word(name: str, told_s: float, x_m: float, localized: bool = True) -> Mate:
        return Mate(name, "defender", told_s, np.array((x_m, 0.0)), 0.0, np.array((1.0, 0.0)), localized)

    team = Team()
    assert team.note(word("cyan2", 1.0, 2.0))
    overtaken = team.note(word("cyan2", 0.9, 7.0))
    assert overtaken
    assert overtaken.overtaken
    assert not team.note(word("cyan2", 0.9, 7.0)), "known already"
    assert not team.note(word("cyan2", 1.0, 7.0)), "known already"
    team.note(word("cyan1", 1.0, 0.0))
    team.note(word("cyan3", 1.0, 0.0, localized=False))
    mates = team.localized(1.2, 5.0)
    assert [mate.name for mate in mates] == ["cyan1", "cyan2"]
    assert mates[1].position_at(1.2) == pytest.approx((2.2, 0.0))
    places = Places(mates)
    assert places.at(1.2)[1][1, 0, 0] > places.at(1.0)[1][1, 0, 0]
    assert (places.first(1).at(1.2)[1] == places.at(1.2)[1][:1]).all()
    for time_s in (0.2, 1.2, 2.5):
        assert places.at(time_s)[0] == pytest.approx(np.array([mate.position_at(time_s) for mate in mates]))
    assert team.localized(6.1, 5.0) == []


def test_sighting_that_may_be_a_known_robot_is_never_overlooked() -> None:
    """`any_near` may say yes in vain, but never no where `without_known` takes a sighting away."""
    generator, vain = np.random.default_rng(3), 0
    for _ in range(300):
        turn = rotation(generator.uniform(0.0, math.pi))
        wide = turn @ np.diag(generator.uniform(0.001, 0.3, 2)) @ turn.T
        seen, mate = generator.uniform(-1.5, 1.5, (2, 1, 2))
        variances_m2 = [(float(wide[0, 0]), float(wide[1, 1]))]
        found = any_near(seen.tolist(), variances_m2, [(*mate[0].tolist(), 0.0, 0.0, *wide.ravel().tolist())], 0.5)
        taken = not without_known(seen, wide[None], mate, wide[None], 0.5).all()
        assert found or not taken
        vain += found and not taken
    assert 0 < vain < 150
