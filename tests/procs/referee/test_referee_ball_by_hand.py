"""A ball that a person puts down outside the lines has left the field, off no robot; balls of any size."""

import pytest

from fwk.testing import MemorySystem
from lcmtypes.soccer import freeze_world_t, game_state_t, place_ball_t, referee_command_t
from procs.model.events import Event, Kind
from procs.model.field import Field, Point
from procs.model.game_states import State
from procs.referee.orders import carry_out
from procs.referee.referee import Referee
from procs.referee.sight import Sight, left_unseen
from procs.scenarios.dummy import Dummy
from procs.simulation.simulator import Simulator
from tests.procs.referee.script import Script


class Hands:
    """Simulator, referee and a person, with two robots that stand still."""

    def __init__(self) -> None:
        self.system = MemorySystem(
            {"world/simulator": Simulator, "world/referee": Referee, "cyan1/dummy": Dummy, "magenta1/dummy": Dummy},
            settings={"world/referee": {"stoppage_s": 5.0}},
        )
        self.system.tick(2)
        self.command("start")
        self.put(2.0, 1.0)
        assert self.state == (State.PLAY, False)

    def command(self, name: str) -> None:
        """Gives the referee a command."""
        self.system.come_in("world/referee_command@outside", referee_command_t(name=name))
        self.system.tick(3)

    def freeze(self, frozen: bool) -> None:
        """Lets the world stand still, or go on."""
        self.system.come_in("world/freeze@outside", freeze_world_t(frozen=frozen))
        self.system.tick(3)

    def put(self, x_m: float, y_m: float) -> None:
        """Puts the ball down."""
        self.system.come_in("world/place_ball@outside", place_ball_t(x_m=x_m, y_m=y_m))
        self.system.tick(3)

    @property
    def state(self) -> tuple[State, bool]:
        """State of the game, and whether it is stopped."""
        game: game_state_t = self.system.newest("world/game_state")
        return State(game.state), bool(game.stopped)


PLACES = {"beside": (3.0, 7.5), "behind": (11.5, 4.0), "in a goal": (11.3, 0.2), "in the other goal": (-11.3, 0.0)}


@pytest.mark.parametrize("place", PLACES.values(), ids=PLACES)
def test_ball_put_outside_is_dropped(place: tuple[float, float]) -> None:
    hands = Hands()
    hands.put(*place)
    assert hands.state == (State.DROP_BALL, True)
    game = hands.system.newest("world/game_state")
    assert (game.score_cyan, game.score_magenta) == (0, 0)


def test_ball_put_outside_in_a_frozen_world_is_called_later() -> None:
    hands = Hands()
    hands.freeze(True)
    hands.put(3.0, 7.5)
    assert hands.state == (State.PLAY, False)
    hands.freeze(False)
    assert hands.state == (State.DROP_BALL, True)


def test_ball_put_back_into_the_field_at_once_is_no_call() -> None:
    hands = Hands()
    hands.freeze(True)
    hands.put(3.0, 7.5)
    hands.put(3.0, 5.0)
    hands.freeze(False)
    assert hands.state == (State.PLAY, False)


def test_ball_put_outside_in_a_stoppage_is_put_back() -> None:
    hands = Hands()
    hands.put(3.0, 7.5)
    calls = hands.system.newest("world/game_state").decisions
    hands.put(-3.0, 7.5)
    hands.system.tick(20)
    game, truth = hands.system.newest("world/game_state"), hands.system.newest("world/ground_truth")
    assert (game.decisions, State(game.state)) == (calls, State.DROP_BALL)
    assert (truth.ball_x_m, truth.ball_y_m) == pytest.approx((game.ball_x_m, game.ball_y_m), abs=0.01)


@pytest.mark.parametrize("kind", [Kind.OUT_END, Kind.GOAL])
def test_deciding_penalty_without_its_ball_is_repeated(kind: Kind) -> None:
    match = Script(decide=True)
    carry_out(match.whistle, Sight(match.ball), "penalties")
    match.started()
    shooter = match.whistle.team
    match.ball = Point(11.3, 0.2 if kind is Kind.GOAL else 4.0)
    match.tick(Event(kind, "", "", *match.ball, 0.0))
    assert match.state == (State.PENALTY, shooter, True)
    assert match.whistle.shootout is not None
    assert set(match.whistle.shootout.shots.values()) == {0}, "no miss"
    assert match.started().whistle.spot == match.ball


@pytest.mark.parametrize(("radius_m", "put_back"), [(0.11, True), (0.3, False)])
def test_ball_of_any_size_is_out_when_wholly_over_the_line(radius_m: float, put_back: bool) -> None:
    script = Script(ball={"radius_m": radius_m}, stoppage_s=5.0).playing()
    script.tick(Event(Kind.OUT_SIDE, "cyan2", "", 2.0, 7.5, 1.0))
    script.wait(0.6)
    spot, placements = script.whistle.spot, script.whistle.placements
    script.robots["magenta2"] = Point(spot.x_m, spot.y_m - 0.3)
    script.ball = Point(spot.x_m, 7.2)
    script.wait(0.1)
    assert (script.whistle.placements > placements) is put_back


@pytest.mark.parametrize(("radius_m", "kind"), [(0.11, Kind.OUT_SIDE), (0.3, Kind.OUT_END)])
def test_ball_that_left_unseen_is_out_over_a_line_by_its_size(radius_m: float, kind: Kind) -> None:
    assert left_unseen(Point(11.35, 7.2), "cyan2", Field(), radius_m).kind is kind
