"""Skiller and agent on the bench, and senseless input of all."""

import math
from typing import Any

import pytest

from fwk import Component
from fwk.testing import Bench
from lcmtypes.core import answer_t
from lcmtypes.soccer import (
    ball_estimate_t,
    drive_target_t,
    game_state_t,
    mate_estimate_t,
    robot_estimate_t,
    skill_status_t,
)
from procs.behaviour.agent import Agent
from procs.behaviour.navigator import Navigator
from procs.behaviour.order import Order
from procs.behaviour.skiller import Skiller
from procs.behaviour.skills.book import SKILLS
from procs.model.field import Field, Point
from procs.referee.referee import Referee
from tests.procs.behaviour.behaviour_parts import newest, put

PERIOD_S = 0.05
MOUTH_M = 0.33
"""Distance of a ball in the mouth."""


def seen_ball(x_m: float, y_m: float) -> ball_estimate_t:
    made = ball_estimate_t()
    made.known, made.x_m, made.y_m = True, x_m, y_m
    return made


def put_situation(bench: Bench, **fields: Any) -> None:
    bench.port("world_model").put(localized=True, **fields)
    bench.port("game_state").put(state=game_state_t.PLAY)


@pytest.mark.parametrize(("robot", "sign"), [("cyan2", 1.0), ("magenta2", -1.0)])
def test_both_teams_decide_alike(robot: str, sign: float) -> None:
    bench = Bench(Agent, f"{robot}/agent")
    put_situation(bench, x_m=sign * -2.0, y_m=sign, ball=seen_ball(sign * 6.0, sign * 0.5))
    bench.port("kicker_state").put(ball_held=True)
    bench.iterate()
    command = newest(bench, "skill")
    assert command.skill == "shoot"
    assert command.x_m == sign * 11.0
    assert newest(bench, "role").role == "attacker"


def test_ball_of_a_silent_kicker_is_not_held() -> None:
    bench = Bench(Agent, "cyan2/agent")
    bench.port("kicker_state").put(ball_held=True)
    for silent_s, skill in ((0.4, "shoot"), (0.3, "get_ball")):
        put_situation(bench, x_m=2.0, y_m=1.0, ball=seen_ball(6.0, 0.5))
        bench.iterate(round(silent_s / PERIOD_S))
        assert newest(bench, "skill").skill == skill


def test_agent_plays_on_a_field_that_was_changed() -> None:
    bench = Bench(Agent, "cyan2/agent")
    aims_m = []
    for length_m in (22.0, 18.0):
        bench.component.config.field = Field(length_m=length_m)
        bench.component.config_changed()
        put_situation(bench, x_m=2.0, ball=seen_ball(6.0, 0.5))
        bench.port("kicker_state").put(ball_held=True)
        bench.iterate()
        aims_m.append(newest(bench, "skill").x_m)
    assert aims_m == [11.0, 9.0]


def test_robot_that_is_sent_off_takes_its_announcement_back() -> None:
    bench, mate = Bench(Agent, "cyan2/agent"), mate_estimate_t(name="cyan3", role="supporter", x_m=4.0, y_m=2.0)
    announced = []
    for sent_off in ([], ["cyan2"]):
        for _ in range(6):
            put(bench, "kicker_state", ball_held=True)
            bench.port("world_model").put(localized=True, ball=seen_ball(MOUTH_M, 0.0), mates=[mate])
            bench.port("game_state").put(state=game_state_t.PLAY, sent_off=sent_off)
            bench.iterate()
        announced.append(newest(bench, "role").agreement.receiver)
    assert announced == ["cyan3", ""]


def test_card_after_the_start_of_a_set_piece_changes_no_place() -> None:
    bench, places = Bench(Agent, "cyan4/agent"), []
    mates = [mate_estimate_t(name=f"cyan{number}", x_m=-2.0 * number) for number in (1, 2, 3)]
    for stopped, decisions in ((True, 4), (False, 4), (False, 5), (True, 7)):
        state = {"state": game_state_t.KICK_OFF, "state_team": game_state_t.TEAM_MAGENTA}
        bench.port("world_model").put(localized=True, x_m=-9.0, ball=seen_ball(0.0, 0.0), mates=mates)
        bench.port("game_state").put(**state, stopped=stopped, decisions=decisions)
        bench.iterate()
        places.append((newest(bench, "skill").x_m, newest(bench, "skill").y_m))
    assert places[0] == places[1] == places[2] != places[3]


def role_of_the_farther_robot(use_roles: bool, state: int) -> str:
    """Returns the role of a field player whose mate is nearer to the ball."""
    bench, mates = Bench(Agent, "cyan3/agent", use_roles=use_roles), [mate_estimate_t() for _ in range(2)]
    mates[0].name, mates[0].x_m, mates[1].name, mates[1].x_m = "cyan1", -10.0, "cyan2", 2.0
    bench.port("world_model").put(localized=True, x_m=-3.0, ball=seen_ball(3.0, 0.0), mates=mates)
    bench.port("game_state").put(state=state, state_team=game_state_t.TEAM_CYAN, ball_x_m=3.0)
    bench.iterate()
    return str(newest(bench, "role").role)


def test_without_roles_every_field_player_goes_for_the_ball() -> None:
    assert role_of_the_farther_robot(True, game_state_t.PLAY) != "attacker"
    assert role_of_the_farther_robot(False, game_state_t.PLAY) == "attacker"
    assert role_of_the_farther_robot(False, game_state_t.FREE_KICK) != "attacker", "one robot takes a set piece"


@pytest.fixture
def agent() -> Bench:
    return Bench(Agent, "cyan2/agent")


def think(agent: Bench, x_m: float = 3.0) -> list[str]:
    """One tick; returns the skills that were asked for so far."""
    put_situation(agent, ball=seen_ball(x_m, 0.0))
    agent.iterate()
    return [command.skill for command in agent.skill.sent]


def test_agent_asks_once_until_the_target_moves(agent: Bench) -> None:
    assert [len(think(agent, x_m)) for x_m in (3.0, 3.0, 3.5)] == [1, 1, 2]


@pytest.mark.parametrize(
    ("state", "reason"),
    [
        (answer_t.DONE, ""),
        (answer_t.FAILED, "lost the ball"),
        (answer_t.REJECTED, "no skill"),
        (answer_t.EXPIRED, "it was not begun in time"),
        (answer_t.FORGOTTEN, "cyan2/skiller was started after it had been sent"),
    ],
)
def test_agent_asks_again_once_a_skill_has_ended(agent: Bench, state: int, reason: str) -> None:
    think(agent)
    agent.owner_of("skill").answer(answer_t.ACCEPTED)
    assert think(agent) == ["get_ball"]
    agent.owner_of("skill").answer(state, reason)
    assert think(agent) == ["get_ball"] * 2
    assert think(agent) == ["get_ball"] * 2


def test_agent_asks_again_when_no_answer_comes(agent: Bench) -> None:
    counts = [len(think(agent)) for _ in range(202)]
    assert (counts[199], counts[201]) == (1, 2)  # 10 s later


@pytest.mark.parametrize(("state", "asked"), [(answer_t.DONE, 1), (answer_t.FAILED, 2)])
def test_lasting_skill_that_is_done_is_not_asked_for_again(agent: Bench, state: int, asked: int) -> None:
    for _ in range(3):
        put_situation(agent)
        agent.port("game_state").put(state=game_state_t.FROZEN, stopped=True)
        agent.iterate()
        if agent.tick == 1:
            agent.owner_of("skill").answer(state)
    assert [command.skill for command in agent.skill.sent] == ["stop"] * asked


@pytest.fixture
def skiller() -> Bench:
    return Bench(Skiller, "cyan2/skiller")


def carry_out(skiller: Bench, times: int = 1, ball_m: float | None = None, **command: Any) -> list[tuple[int, str]]:
    """Sends a command if one is given, and runs ticks; returns the states and reasons that were answered so far."""
    if command:
        skiller.skill.put(**command)
    for _ in range(times):
        put_situation(skiller, ball=ball_estimate_t() if ball_m is None else seen_ball(ball_m, 0.0))
        skiller.port("kicker_state").put(ball_held=ball_m == MOUTH_M, charged=True)
        skiller.iterate()
    return [(sent.answer.state, sent.answer.reason) for sent in skiller.skill.sent]


@pytest.mark.parametrize(("robot", "sign"), [("cyan2", 1.0), ("magenta2", -1.0)])
def test_skiller_writes_targets_in_the_world_frame(robot: str, sign: float) -> None:
    bench = Bench(Skiller, f"{robot}/skiller")
    carry_out(bench, skill="mark", x_m=sign * -5.0)
    target: drive_target_t = newest(bench, "drive_target")
    assert not target.stop
    assert target.x_m == pytest.approx(sign * -5.9)
    status = newest(bench, "skill_status")
    assert (status.command_id, status.skill, status.status) == (1, "mark", skill_status_t.RUNNING)


def test_skill_is_accepted_and_done_when_it_has_reached_its_end(skiller: Bench) -> None:
    assert carry_out(skiller, 2, 1.0, skill="get_ball") == [(answer_t.ACCEPTED, "")]
    assert carry_out(skiller, 4, MOUTH_M) == [(answer_t.ACCEPTED, ""), (answer_t.DONE, "")]


def test_skill_that_fails_says_why(skiller: Bench) -> None:
    assert carry_out(skiller, 3, skill="get_ball") == [(answer_t.FAILED, "the ball is unknown")]
    assert newest(skiller, "skill_status").reason == "the ball is unknown"


def test_newer_command_replaces_the_running_one(skiller: Bench) -> None:
    carry_out(skiller, 1, 2.0, skill="get_ball")
    answers = carry_out(skiller, 1, 2.0, skill="mark", x_m=-5.0)
    assert answers[1:] == [(answer_t.FAILED, "replaced by command 2 of test/sender"), (answer_t.ACCEPTED, "")]
    assert newest(skiller, "skill_status").skill == "mark"


def test_of_several_commands_at_once_the_newest_is_carried_out(skiller: Bench) -> None:
    skiller.skill.put(skill="get_ball")
    answers = carry_out(skiller, 1, 2.0, skill="mark", x_m=-5.0)
    assert answers == [(answer_t.FAILED, "replaced by command 2 of test/sender"), (answer_t.ACCEPTED, "")]


def test_skill_that_does_not_exist_is_rejected(skiller: Bench) -> None:
    ((state, reason),) = carry_out(skiller, skill="juggle")
    assert state == answer_t.REJECTED
    assert "juggle" in reason
    assert all(name in reason for name in SKILLS)


def test_unknown_skill_is_logged_once_with_the_nearest_first(skiller: Bench) -> None:
    for skill in ("shot", "shot", "get_bal", "shot"):
        carry_out(skiller, skill=skill)
    shot, get_ball = (line.text for line in skiller.logged)
    assert shot.startswith("command 1 of test/sender: no skill 'shot'; there are shoot, ")
    assert get_ball.startswith("command 3 of test/sender: no skill 'get_bal'; there are get_ball, ")
    assert all(name in shot for name in SKILLS)


def test_impossible_command_is_logged_once_for_its_skill(skiller: Bench) -> None:
    for skill, x_m in (("goto", 11.5), ("goto", 11.6), ("dribble", 50.0), ("goto", 11.5)):
        carry_out(skiller, skill=skill, x_m=x_m)
    goto, dribble = (line.text for line in skiller.logged)
    assert goto.startswith("command 1 of test/sender: goto: (11.5, 0) is in a goal; at that y_m x_m can be from ")
    assert dribble.startswith("command 3 of test/sender: dribble: x_m is 50; between the walls a robot's middle can be")


def test_made_up_skills_do_not_fill_the_log(skiller: Bench) -> None:
    for number in range(150):
        carry_out(skiller, skill=f"skill {number}")
    assert len(skiller.logged) == 100


@pytest.mark.parametrize("target", [{"x_m": math.nan}, {"y_m": 1e300}, {"speed_m_s": math.inf}])
def test_senseless_target_is_rejected_and_the_skill_goes_on(skiller: Bench, target: dict[str, float]) -> None:
    carry_out(skiller, 1, 2.0, skill="get_ball")
    assert carry_out(skiller, 1, 2.0, skill="goto", **target)[-1][0] == answer_t.REJECTED
    assert newest(skiller, "skill_status").skill == "get_ball"
    assert not newest(skiller, "drive_target").stop


def test_impossible_command_is_rejected_with_the_reason(skiller: Bench) -> None:
    reason = "x_m is 99; between the walls a robot's middle can be from -11.75 to 11.75"
    assert carry_out(skiller, 1, 2.0, skill="goto", x_m=99.0) == [(answer_t.REJECTED, reason)]
    assert newest(skiller, "drive_target").stop


def test_agent_orders_only_places_that_are_accepted() -> None:
    bench = Bench(Agent, "cyan2/agent")
    bench.port("world_model").put(localized=True, x_m=9.0, y_m=7.0, ball=seen_ball(14.0, 9.0))
    bench.port("game_state").put(state=game_state_t.FREE_KICK, stopped=True, ball_x_m=14.0, ball_y_m=9.0)
    bench.iterate()
    command = newest(bench, "skill")
    assert (command.skill, command.x_m, command.y_m) == ("block", 12.0, 8.0)


@pytest.mark.parametrize("skill", ["goto", "shoot"])
@pytest.mark.parametrize("senseless", [{"place": Point(math.nan, 1.0)}, {"heading_rad": math.nan}])
def test_senseless_order_reaches_the_skiller(
    agent: Bench, monkeypatch: pytest.MonkeyPatch, skill: str, senseless: dict[str, Any]
) -> None:
    for order in (Order(skill, Point(3.0, 1.0)), Order(skill, Point(3.0, 1.0))._replace(**senseless)):
        monkeypatch.setattr(Agent, "_decide", lambda *_, order=order: ("attacker", order))
        think(agent)
    place_m, turn_rad = senseless.get("place", Point(3.0, 1.0)), senseless.get("heading_rad", 0.0)
    command = newest(agent, "skill")
    assert [command.x_m, command.y_m, command.heading_rad] == pytest.approx([*place_m, turn_rad], nan_ok=True)


def test_skiller_that_is_stopped_fails_its_command(skiller: Bench) -> None:
    carry_out(skiller, 1, 2.0, skill="get_ball")
    skiller.finalize()
    assert skiller.skill.sent[-1].answer.reason == "cyan2/skiller was stopped"


def test_without_a_command_the_robot_stands_and_does_not_kick(skiller: Bench) -> None:
    skiller.iterate()
    assert newest(skiller, "drive_target").stop
    assert newest(skiller, "skill_status").status == skill_status_t.INACTIVE
    assert not newest(skiller, "dribble_command").on
    assert not skiller.kick.sent


def test_shot_is_one_kick_for_this_tick_and_done_with_it(skiller: Bench) -> None:
    carry_out(skiller, 3, MOUTH_M, skill="shoot", x_m=11.0)
    (kick,) = skiller.kick.sent
    assert kick.speed_m_s > 8.0
    assert kick.command.expires_us == kick.header.time_us
    skiller.owner_of("kick").answer()
    assert carry_out(skiller, 1, 1.0)[-1] == (answer_t.DONE, "")


@pytest.mark.parametrize("answered", [True, False])
def test_kick_that_fails_is_asked_for_again(skiller: Bench, answered: bool) -> None:
    carry_out(skiller, 1, MOUTH_M, skill="shoot", x_m=11.0)
    if answered:
        skiller.owner_of("kick").answer(answer_t.EXPIRED)
    carry_out(skiller, 2 if answered else 6, MOUTH_M)
    assert len(skiller.kick.sent) == 2


def senseless(value: float, message: Any) -> Any:
    """Fills every number with a fraction, also in nested messages."""
    for name, kind, dimensions in zip(message.__slots__, message.__typenames__, message.__dimensions__, strict=True):
        if kind == "double" and dimensions is None:
            setattr(message, name, value)
        elif kind == "boolean":
            setattr(message, name, name != "stop")
        elif name in ("ball", "agreement"):
            senseless(value, getattr(message, name))
        elif kind.endswith("robot_estimate_t"):
            setattr(message, name, [senseless(value, robot_estimate_t()) for _ in range(3)])
        elif kind.endswith("mate_estimate_t"):
            setattr(message, name, [senseless(value, mate_estimate_t(role="attacker")) for _ in range(3)])
    if hasattr(message, "mates"):
        message.localized = True
    return message


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 1e300, -1e300, 1e5])
@pytest.mark.parametrize("component", [Navigator, Skiller, Agent, Referee])
def test_senseless_numbers_do_no_harm(component: type[Component], value: float) -> None:
    bench = Bench(component, "cyan2/component")
    for skill in ("get_ball", "intercept", "shoot", "pass", "dribble", "keep_goal", "mark", "goto"):
        for declared in bench.declaration.ports:
            if not declared.writes and not declared.sends:
                message = senseless(value, bench.port(declared.attribute).message_type())
                message.header.time_us = bench.time_us
                if declared.attribute == "skill":
                    message.skill = skill
                    bench.skill.put(skill=skill, x_m=5.0)  # carried out even if the other one is rejected
                if declared.attribute == "game_state":
                    message.state, message.stopped = game_state_t.PLAY, False
                bench.port(declared.attribute).put(message)
        bench.iterate()
        if component is Navigator:
            command = newest(bench, "motor_command")
            assert math.hypot(command.vx_m_s, command.vy_m_s) <= 3.1
            assert abs(command.omega_rad_s) <= 5.1


def test_skill_loses_the_ball_of_a_silent_kicker(skiller: Bench) -> None:
    skiller.port("kicker_state").put(ball_held=True, charged=True)
    skiller.port("world_model").put(localized=True, ball=seen_ball(MOUTH_M, 0.0))
    skiller.skill.put(skill="dribble", x_m=5.0)
    skiller.iterate(round(1.0 / PERIOD_S))
    assert skiller.skill.sent[-1].answer.reason == "lost the ball"


def test_stopped_skiller_leaves_no_target_kick_or_handling() -> None:
    bench = Bench(Skiller, "cyan2/skiller")
    bench.component.dribble_command.value.on = True
    bench.finalize()
    assert not newest(bench, "dribble_command").on
    assert not bench.kick.sent
    assert newest(bench, "drive_target").stop
