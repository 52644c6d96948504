"""World models of the real launch file, with its cameras and detectors."""

import pytest

from fwk.testing import system_of
from lcmtypes.soccer import team_message_t
from procs.evaluation.match import samples_of
from procs.evaluation.piece import piece_of

OWNERS = ("world", "team_cyan", "cyan2", "cyan3")


@pytest.mark.slow
def test_robots_share_the_ball_in_odd_and_even_ticks() -> None:
    """The launch file lets cameras alternate; no robot's tick may fall between its messages."""
    system = system_of("soccer.yaml", lambda name: name.partition("/")[0] in OWNERS)
    system.tick(60)
    for robot in ("cyan2", "cyan3"):
        told = [team_message_t.decode(sent) for sent in system.sent[f"{robot}/team_message"]][-15:]
        with_ball = sum(message.ball_visible for message in told)
        assert with_ball >= 10, f"{robot}: {with_ball} of {len(told)}"


@pytest.mark.slow
@pytest.mark.parametrize("realism", ["realistic", "harsh"])
def test_covariances_are_honest_with_good_and_bad_sensors(realism: str) -> None:
    """The true ball lies in the ellipses of the robots as often as they say, also if their mirrors are tilted."""
    system = system_of("soccer-percepts.yaml", seed=1, sets=(f"shared.realism={realism}",))
    system.tick(220)
    inside = samples_of(piece_of(system.sent, 0.04))["inside 95 %, all"]
    assert len(inside) > 700
    assert 0.9 <= sum(inside) / len(inside) <= 1.0
