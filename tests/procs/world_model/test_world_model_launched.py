"""World models of the real launch file, with its cameras and detectors."""

import pytest

from fwk.testing import system_of
from lcmtypes.soccer import team_message_t

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
