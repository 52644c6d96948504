"""Opponents that only a mate sees: they become known at every pace of camera and messages, ghosts do not."""

import numpy as np
import pytest

from fwk.testing import Bench
from lcmtypes.soccer import obstacle_t, team_message_t
from procs.model.units import US_PER_S
from procs.world_model.team import Mate, Team
from procs.world_model.world_model import WorldModel

Place = tuple[float, float]
OPPONENT_M, GHOST_M = (2.0, 1.0), (-3.0, -2.0)


class Pair:
    """Two robots at one place: cyan2 sees what the test shows, cyan1 hears of it a tick later."""

    def __init__(self, period_s: float = 0.04) -> None:
        self.period_us = round(period_s * US_PER_S)
        self._hears, self._sees = (Bench(WorldModel, f"cyan{n}/world_model", period_s=period_s) for n in (1, 2))
        self._under_way: list[tuple[int, team_message_t]] = []

    def tick(self, seen_m: list[Place] | None = None, latency_s: float = 0.035, delay_s: float = 0.0) -> list[int]:
        """Runs a tick in which cyan2 has a frame with `seen_m`; returns the ids of the opponents that cyan1 knows."""
        now_us = self._sees.time_us + self.period_us
        if seen_m is not None:
            obstacles = [
                obstacle_t(x_m=x_m, y_m=y_m, radius_m=0.25, team=2, covariance_m2=(np.eye(2) * 0.0016).tolist())
                for x_m, y_m in seen_m
            ]
            capture_us = max(1, now_us - round(latency_s * US_PER_S))
            self._sees.port("ball_percept").put(capture_us=capture_us)
            self._sees.port("obstacle_percepts").put(capture_us=capture_us, obstacles=obstacles)
        arrived = [message for due_us, message in self._under_way if due_us <= now_us]
        self._under_way = [each for each in self._under_way if each[0] > now_us]
        if arrived:
            self._hears.port("team_inbox").put(messages=arrived)
        for bench in (self._hears, self._sees):
            bench.port("pose").put(covariance=np.diag((1e-4, 1e-4, 1e-5)).tolist(), localized=True)
            bench.port("odometry").put()
            bench.port("kicker_state").put()
            bench.iterate()
        sent = self._sees.port("team_message").sent
        self._under_way += [(now_us + self.period_us + round(delay_s * US_PER_S), message) for message in sent]
        sent.clear()
        return [one.id for one in self._hears.port("world_model").sent[-1].opponents]


@pytest.mark.parametrize(
    ("period_s", "every", "latency_s"),
    [(0.04, 2, 0.035), (0.04, 2, 0.15), (0.04, 1, 0.035), (0.04, 3, 0.035), (0.04, 5, 0.035), (0.1, 1, 0.035)],
)
def test_opponent_that_only_a_mate_sees_stays_one(period_s: float, every: int, latency_s: float) -> None:
    pair, known = Pair(period_s), []
    for tick in range(round(4.0 / period_s)):
        known.append(pair.tick([OPPONENT_M] if tick % every == 0 else None, latency_s))
    settled = known[len(known) // 4 :]
    assert settled == [[settled[0][0]]] * len(settled)


def test_late_message_confirms_an_opponent() -> None:
    """Two frames show an opponent; the message with the second one takes 60 ms longer."""
    pair, known = Pair(), []
    for tick in range(40):
        seen_m = [OPPONENT_M] if tick in (20, 22) else []
        known.append(pair.tick(seen_m if tick % 2 == 0 else None, delay_s=0.06 if tick == 22 else 0.0))
    assert not any(known[:24])
    assert len(known[26]) == 1


def test_ghost_that_a_mate_sees_at_times_stays_unknown() -> None:
    """A ghost in every fourth frame of the mate is forgotten before it comes again."""
    pair = Pair()
    for tick in range(100):
        ghosts_m = [GHOST_M] if tick % 8 == 0 else []
        known = pair.tick([OPPONENT_M, *ghosts_m] if tick % 2 == 0 else None)
        assert len(known) <= 1
    assert len(known) == 1


def mate(name: str) -> Mate:
    return Mate(name, "", 1.0, np.zeros(2), 0.0, np.zeros(2), True)


def test_next_frame_of_a_mate_comes_at_its_pace() -> None:
    team, second, third = Team(), mate("cyan2"), mate("cyan3")
    team.note(second)
    team.note(third)
    first_s = team.next_s(second, 1_000_000, 0.1)
    assert first_s > 0.1
    for frame in range(1, 4):
        slow_s = team.next_s(second, 1_000_000 + 200_000 * frame, 0.1)
    assert team.next_s(second, 1_600_000, 0.1) == slow_s > 0.28, "a frame that is told twice"
    assert team.next_s(third, 1_600_000, 0.1) == first_s, "a mate of its own"
    second.overtaken = True
    assert team.next_s(second, 1_400_000, 0.1) == slow_s, "a frame in a message that was overtaken"
