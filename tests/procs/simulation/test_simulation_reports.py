"""Events as the simulator reports them to the referee."""

import pytest

from lcmtypes.soccer import game_state_t
from procs.model.events import Event, Kind
from procs.model.robot import PLAYERS
from procs.simulation.physics.reports import event_message


@pytest.mark.parametrize("x_m", [11.2, -11.2])
@pytest.mark.parametrize("robot", ["cyan1", "magenta1", ""])
def test_goal_is_reported_without_a_team(robot: str, x_m: float) -> None:
    """Teams change ends, so that only the referee knows whose goal it is."""
    message = event_message(Event(Kind.GOAL, robot, "", x_m, 0.0, 3.0), PLAYERS)
    assert (message.team, message.robot, message.x_m) == (game_state_t.TEAM_NONE, robot, x_m)


@pytest.mark.parametrize(
    ("robot", "team"),
    [
        ("cyan1", game_state_t.TEAM_CYAN),
        ("magenta1", game_state_t.TEAM_MAGENTA),
        ("robby", game_state_t.TEAM_NONE),
        ("", game_state_t.TEAM_NONE),
    ],
)
@pytest.mark.parametrize("kind", [kind for kind in Kind if kind is not Kind.GOAL])
def test_other_events_have_the_team_of_their_robot(kind: Kind, robot: str, team: int) -> None:
    assert event_message(Event(kind, robot, "", 11.2, 0.0, 3.0), PLAYERS).team == team
