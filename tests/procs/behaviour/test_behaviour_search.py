"""The skill `search`, from the state machine to the wheels."""

import math
from typing import Any

import pytest

from fwk.testing import Bench
from lcmtypes.soccer import game_state_t, obstacle_t
from procs.behaviour.game import Game, Whose
from procs.behaviour.navigator import Navigator
from procs.behaviour.skiller import Skiller
from procs.behaviour.skills.searching import Search, vantage_points, way_is_free
from procs.behaviour.skills.skill import Blind, Obstacle, Scene, Sight, Status
from procs.behaviour.view import Ball, View
from procs.model.field import Point
from procs.model.game_states import State
from tests.procs.behaviour.behaviour_parts import FIELD, ball, robot, view

UNKNOWN = Ball(known=False)
LOST = View(localized=False, own=robot("cyan2", 0.0, 0.0), ball=UNKNOWN)
FREE = Sight(lines=(Point(3.0, 0.2),))
PLAY = Game(State.PLAY, stopped=False)
SCENE = Scene(LOST, Point(0.0, 0.0), 0.0, duration_s=0.1, sight=FREE, game=PLAY)


def states(search: Search, scene: Scene, duration_s: float) -> list[str]:
    """Returns the states that the skill passes, without repetitions."""
    passed: list[str] = []
    for _ in range(round(duration_s / scene.duration_s)):
        search.step(scene)
        name = search.state.rpartition("/")[2]
        if passed[-1:] != [name]:
            passed.append(name)
    return passed


def test_lost_robot_stands_then_turns_then_drives() -> None:
    search = Search()
    assert states(search, SCENE, 12.0) == ["stand", "turn", "drive ahead", "turn", "drive ahead"]
    drives = [step.blind for step in (search.step(SCENE) for _ in range(80)) if step.blind]
    assert {blind.ahead_m_s > 0 for blind in drives} == {True, False}
    assert all((blind.ahead_m_s > 0) != (blind.turn_rad_s > 0) for blind in drives)


def test_short_way_ahead_is_a_metre() -> None:
    search, ahead_m = Search(), 0.0
    for _ in range(95):
        blind = search.step(SCENE).blind or Blind(0.0, 0.0)
        ahead_m += blind.ahead_m_s * SCENE.duration_s
    assert ahead_m == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize(
    ("sight", "game", "free"),
    [
        (FREE, PLAY, True),
        (FREE, Game(State.FROZEN), True),
        (FREE, Game(State.FREE_KICK, stopped=False, whose=Whose.THEIRS), False),
        (None, PLAY, False),
        (Sight(), PLAY, False),
        (Sight(lines=(Point(-3.0, 0.0), Point(0.8, 0.0), Point(3.0, 2.0))), PLAY, False),
        (FREE._replace(obstacles=(Obstacle(Point(1.2, 0.2), 0.25),)), PLAY, False),
        (FREE._replace(obstacles=(Obstacle(Point(0.6, -0.6), 0.25),)), PLAY, False),
        (FREE._replace(obstacles=(Obstacle(Point(0.6, 1.0), 0.25), Obstacle(Point(-0.6, 0.0), 0.25))), PLAY, True),
    ],
    ids=["line", "pause", "set piece", "blind", "nothing", "no line", "robot ahead", "robot aside", "robots apart"],
)
def test_lost_robot_drives_only_over_free_ground(sight: Sight | None, game: Game, free: bool) -> None:
    scene = SCENE._replace(sight=sight, game=game)
    assert way_is_free(scene, 1.0) == free
    assert ("drive ahead" in states(Search(), scene, 12.0)) == free


def test_robot_in_the_way_ends_the_drive() -> None:
    search = Search()
    assert states(search, SCENE, 5.9)[-1] == "drive ahead"
    met = SCENE._replace(sight=FREE._replace(obstacles=(Obstacle(Point(0.7, 0.0), 0.25),)))
    assert states(search, met, 3.0) == ["turn"]


def test_robot_looks_from_the_nearest_place_that_is_permitted() -> None:
    at_the_line = SCENE._replace(
        view=LOST._replace(localized=True, own=robot("cyan2", 10.8, 0.0)),
        place=Point(11.4, 0.0),  # where the ball was seen last
        permitted=lambda place: Point(min(place.x_m, 10.9), place.y_m),
    )
    assert states(Search(), at_the_line, 1.0) == ["look", "go"]


def test_robot_whose_way_is_blocked_looks_from_where_it_is() -> None:
    blocked = SCENE._replace(view=LOST._replace(localized=True, own=robot("cyan2", 3.0, 0.5)), place=Point(3.0, 0.0))
    assert states(Search(), blocked, 9.8) == ["go"]
    assert states(Search(), blocked, 12.0) == ["go", "look", "go"]


def test_localized_robot_goes_to_its_place_then_to_vantages() -> None:
    search, place = Search(), Point(-2.0, 3.0)
    targets: list[Point] = []
    for _ in range(60):
        here = targets[-1] if targets else Point(0.0, 0.0)
        seen = view(robot("cyan2", *here), UNKNOWN, (robot("cyan3", 0.0, 0.0),))
        drive = search.step(SCENE._replace(view=seen, place=place)).drive
        assert drive
        if drive.place not in targets:
            targets.append(drive.place)
    assert targets == [place, *vantage_points(seen, FIELD)]


def test_mates_divide_the_vantage_points_by_their_numbers() -> None:
    names = ["cyan10", "cyan2", "cyan9"]
    keeper = robot("cyan1", -10.0, 0.0, role="goalkeeper")
    shares = []
    for name in ("cyan2", "cyan9", "cyan10"):
        mates = (keeper, *(robot(other, 0.0, 0.0) for other in names if other != name))
        shares.append(vantage_points(view(robot(name, 1.0, 1.0), UNKNOWN, mates), FIELD))
    points = [point for share in shares for point in share]
    assert [len(share) for share in shares] == [2, 2, 2]
    assert len(set(points)) == 6
    assert shares[0][0].x_m < shares[1][0].x_m < shares[2][0].x_m
    assert all(not FIELD.in_penalty_area(*point, side, 0.3) for point in points for side in (-1.0, 1.0))


def test_each_of_many_mates_has_a_vantage_point() -> None:
    mates = tuple(robot(f"cyan{number}", 0.0, 0.0) for number in range(3, 10))
    assert len(vantage_points(view(robot("cyan2", 0.0, 0.0), UNKNOWN, mates), FIELD)) == 1


def test_search_is_done_when_the_ball_is_known() -> None:
    search = Search()
    search.step(SCENE)
    assert search.step(SCENE._replace(view=view(robot("cyan2", 0.0, 0.0), UNKNOWN))).status is Status.RUNNING
    assert search.step(SCENE._replace(view=view(robot("cyan2", 0.0, 0.0), ball(1.0, 1.0)))).status is Status.FINAL


def seek(localized: bool, ticks: int) -> Bench:
    """Returns a skiller that was told to search, with a free way ahead."""
    bench = Bench(Skiller, "cyan2/skiller")
    bench.skill.put(skill="search")
    for _ in range(ticks):
        for port, fields in {
            "line_points": {"n": 2, "x_m": [3.0, math.nan], "y_m": [0.0, 0.0]},
            "obstacle_percepts": {"n": 1, "obstacles": [obstacle_t(x_m=-2.0, radius_m=0.25)]},
        }.items():
            made: Any = bench.port(port).message_type()
            made.header.time_us = bench.time_us
            bench.port(port).put(made, **fields)
        bench.port("world_model").put(localized=localized)
        bench.port("game_state").put(state=game_state_t.PLAY)
        bench.iterate()
    return bench


def test_skiller_sends_blind_drives_while_the_robot_is_lost() -> None:
    bench = seek(localized=False, ticks=130)
    sent = list(bench.port("blind_drive").sent)
    assert {(command.vx_m_s > 0.0, command.omega_rad_s > 0.0) for command in sent} == {(True, False), (False, True)}
    assert all(command.enabled for command in sent)
    assert bench.port("drive_target").sent[-1].stop
    bench.port("world_model").put(localized=True)
    for _ in range(3):
        bench.iterate()
    ended = bench.port("blind_drive").sent[len(sent) :]
    assert [(command.enabled, command.vx_m_s, command.omega_rad_s) for command in ended] == [(False, 0.0, 0.0)]


def test_skiller_sends_no_blind_drive_in_ordinary_play() -> None:
    bench = seek(localized=True, ticks=60)
    assert not bench.port("blind_drive").sent
    assert not bench.port("drive_target").sent[-1].stop


def blind_drive(ticks: int, **command: Any) -> list[Any]:
    """Returns the motor commands of a lost robot with a blind drive in the first ten ticks."""
    bench = Bench(Navigator, "cyan2/navigator")
    for tick in range(ticks):
        for port, fields in {"world_model": {"heading_rad": 2.0}, "blind_drive": {"enabled": True, **command}}.items():
            if port == "world_model" or tick < 10:
                made: Any = bench.port(port).message_type()
                made.header.time_us = bench.time_us
                bench.port(port).put(made, **fields)
        bench.iterate()
    return list(bench.port("motor_command").sent)


def test_navigator_obeys_a_blind_drive_in_the_robot_frame() -> None:
    driven = blind_drive(10, vx_m_s=0.5, omega_rad_s=0.1)[-1]
    assert (driven.vx_m_s, driven.omega_rad_s) == (pytest.approx(0.5, abs=0.01), pytest.approx(0.1))
    assert abs(driven.vy_m_s) < 0.01


@pytest.mark.parametrize("command", [{"enabled": False, "vx_m_s": 1.0}, {"vx_m_s": math.nan}])
def test_senseless_blind_drive_is_not_obeyed(command: dict[str, Any]) -> None:
    assert {(each.vx_m_s, each.omega_rad_s) for each in blind_drive(5, **command)} == {(0.0, 0.0)}


def test_old_blind_drive_is_braked() -> None:
    driven = blind_drive(60, vx_m_s=9.0)
    assert 0.5 < max(each.vx_m_s for each in driven) <= 3.0
    assert driven[-1].vx_m_s == 0.0
    assert all(abs(each.vy_m_s) < 0.01 for each in driven), "the velocity stays in the robot frame"
