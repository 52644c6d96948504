"""Team and number in the names of robots, whatever names the radio brings."""

import numpy as np
import pytest

from fwk.testing import Bench
from lcmtypes.soccer import team_message_t
from procs.model.robot import NUMBER_MAX, PLAYERS, number_of, player_of, team_of
from procs.world_model.world_model import WorldModel

LONG = "9" * 5000


@pytest.mark.parametrize(
    ("name", "team", "number"),
    [
        ("cyan3", "cyan", 3),
        ("cyan007", "cyan", 7),
        ("cyan0", "cyan", 0),
        ("anna", "anna", 0),
        ("", "", 0),
        ("4", "", 4),
        ("a1b2", "a1b", 2),
        (f"cyan{NUMBER_MAX}", "cyan", NUMBER_MAX),
        (f"cyan000{NUMBER_MAX}", "cyan", NUMBER_MAX),
        (f"cyan{NUMBER_MAX + 1}", "cyan", 0),
        (f"cyan{LONG}", "cyan", 0),
        (f"cyan{LONG * 20}x", f"cyan{LONG * 20}x", 0),
        ("cyan٣", "cyan٣", 0),
    ],
    ids=lambda each: f"{each:.20}" if isinstance(each, str) else None,
)
def test_name_is_a_team_and_a_number(name: str, team: str, number: int) -> None:
    assert (team_of(name), number_of(name)) == (team, number)
    assert (player_of(name, PLAYERS) is not None) is (team == "cyan" and number > 0)


@pytest.mark.parametrize("name", [f"cyan{LONG}", "cyan٣", "cyan0"])
def test_message_of_a_robot_with_a_strange_name_does_no_harm(name: str) -> None:
    bench = Bench(WorldModel, "cyan1/world_model")
    message = team_message_t(robot=name, localized=True, pose_covariance=np.eye(3).tolist())
    bench.port("pose").put(localized=True, covariance=np.eye(3).tolist())
    bench.port("team_inbox").put(messages=[message])
    bench.iterate()
    assert bench.port("world_model").sent[-1].localized


def test_names_from_the_radio_are_not_kept_without_end() -> None:
    for number in range(10_000):
        number_of(f"stranger{number}")
    assert number_of.cache_info().currsize == team_of.cache_info().currsize == 4096
