"""A scenario is played in a match that runs."""

import math

import pytest

from fwk.control.settings import RunSettings
from fwk.lcm import messages
from fwk.testing import MemorySystem, PlanError, launch_plan, system_of
from lcmtypes.core import acknowledgement_t, answer_t
from lcmtypes.soccer import (
    game_state_t,
    ground_truth_t,
    match_events_t,
    play_scenario_t,
    referee_command_t,
    true_robot_t,
)

ROBOTS = ("cyan1", "cyan2", "magenta2")
PLAY = """
robots: [cyan2]
dummies: [magenta2]
places: {cyan2: [-7.0, 3.0, 0.5], magenta2: [1.0, 2.0, 3.0]}
ball: {x_m: 2.0, y_m: -1.0}
commands:
  - {at_s: 0.5, place_ball: {x_m: 3.0, y_m: 4.0}}
  - {at_s: 1.0, freeze: {frozen: true}}
at_end: [ball_speed < 1]
time_s: 2
"""


def match() -> MemorySystem:
    """Returns a match of three robots that has begun, without thinking robots of cyan but cyan2."""
    system = system_of("soccer-truth.yaml", lambda name: name.startswith(("world/", *(f"{one}/" for one in ROBOTS))))
    system.tick(3)
    return system


def ask(system: MemorySystem, name: str = "", text: str = "") -> None:
    system.come_in("world/scenario@outside", play_scenario_t(name=name, text=text))


def answers(system: MemorySystem) -> list[tuple[int, str]]:
    """Returns the answers so far with their reasons."""
    channel = "world/scenario@answers"
    found = [messages.decode(acknowledgement_t, data, channel).answer for data in system.sent[channel]]
    return [(each.state, each.reason) for each in found]


def truth(system: MemorySystem) -> ground_truth_t:
    newest: ground_truth_t = system.newest("world/ground_truth")
    return newest


def robot(system: MemorySystem, name: str) -> true_robot_t:
    return next(each for each in truth(system).robots if each.name == name)


def game(system: MemorySystem) -> game_state_t:
    newest: game_state_t = system.newest("world/game_state")
    return newest


def logged(system: MemorySystem) -> list[str]:
    return [line.text for line in system.logged if line.component == "world/crew"]


def test_start_of_a_scenario_stands_still_for_a_second() -> None:
    system = match()
    ask(system, text=PLAY)
    system.tick(4)
    assert answers(system) == [(answer_t.ACCEPTED, "")]
    for _ in range(20):
        system.tick()
        cyan, magenta = robot(system, "cyan2"), robot(system, "magenta2")
        assert (cyan.x_m, cyan.y_m, cyan.heading_rad) == pytest.approx((-7.0, 3.0, 0.5))
        assert (magenta.x_m, magenta.y_m, magenta.heading_rad) == pytest.approx((1.0, 2.0, 3.0))
        assert (truth(system).ball_x_m, truth(system).ball_y_m, game(system).stopped) == (0.0, 0.0, True)


def test_scenario_begins_the_match_anew_without_other_robots() -> None:
    system = match()
    system.come_in("world/referee_command@outside", referee_command_t(name="goal", team="magenta"))
    system.tick(10)
    ask(system, text=PLAY)
    system.tick(30)
    assert answers(system)[-1] == (answer_t.DONE, "")
    state = game(system)
    assert (state.score_magenta, state.sent_off, state.stopped) == (0, ["cyan1"], False)
    assert robot(system, "cyan1").y_m < -7.25
    assert math.dist((robot(system, "magenta2").x_m, robot(system, "magenta2").y_m), (1.0, 2.0)) < 0.01
    assert math.dist((truth(system).ball_x_m, truth(system).ball_y_m), (2.0, -1.0)) < 0.01
    assert robot(system, "cyan2").x_m > -7.0


def test_commands_of_a_scenario_come_at_their_times() -> None:
    system = match()
    ask(system, text=PLAY)
    while len(answers(system)) < 2:
        system.tick()
    system.tick(16)
    assert math.dist((truth(system).ball_x_m, truth(system).ball_y_m), (3.0, 4.0)) < 0.01
    system.tick(14)
    report: match_events_t = system.newest("world/match_events")
    assert report.frozen
    assert "over" not in logged(system)[-1]
    system.tick(25)
    assert logged(system)[-1] == "the scenario is over; the match goes on"


def test_scenario_of_the_book_is_played_by_name() -> None:
    system = match()
    ask(system, name="shot-on-an-empty-goal")
    system.tick(180)
    assert answers(system)[-1] == (answer_t.DONE, "")
    assert "the scenario shot-on-an-empty-goal begins; it takes 6 s" in logged(system)
    assert game(system).score_cyan == 1


def test_robots_change_places() -> None:
    system = match()
    before = robot(system, "cyan1")
    places = f"{{cyan2: [{before.x_m}, {before.y_m}, 0.0], cyan1: [-2.0, 3.0, 0.0]}}"
    ask(system, text=f"robots: [cyan1, cyan2]\nplaces: {places}\nat_end: [ball_speed < 1]\n")
    system.tick(3)
    assert (robot(system, "cyan2").x_m, robot(system, "cyan2").y_m) == pytest.approx((before.x_m, before.y_m))


@pytest.mark.parametrize(
    ("name", "text", "reason"),
    [
        ("match-end", "", "no scenario 'match-end' in the book; did you mean 'match-ends'?"),
        ("", "", "neither a name nor a text; give name=pass-reaches-the-mate, or a file as text=@FILE"),
        ("qq", "", "no scenario 'qq' in the book; a file of your own is given as text=@FILE"),
        ("../book/match-ends", "", "no scenario '../book/match-ends' in the book; did you mean 'match-ends'?"),
        ("mine", "robot: [cyan2]", "mine:1: no key 'robot'; did you mean 'robots'?"),
        (
            "",
            "[",
            "text:1: this is not valid YAML: while parsing a flow node that begins in line 1, "
            "expected the node content, but found '<stream end>'",
        ),
        (
            "",
            "robots: [cyan2, cyan2]\nball: {x_m: 99}\nalways: [ball_speed < 9]",
            "text:1: robots.1: 'cyan2' is named 2 times; "
            "text:2: ball: (99, 0) is outside the walls; x is at most 12 m, y 8 m",
        ),
        (
            "mine",
            "always: [ball_spead < 9]",
            "mine:1: 'ball_spead < 9': there is no 'ball_spead'; did you mean 'ball_speed'?",
        ),
        (
            "mine",
            "rules: {half: 1}\nat_end: [ball_speed < 9]",
            "mine:1: rules: no setting 'half'; did you mean 'half_s'?",
        ),
        (
            "",
            "dummies: [cyan9]\nat_end: [ball_speed < 9]",
            "no robot 'cyan9' in this match; there are: cyan1, cyan2, magenta2",
        ),
    ],
)  # fmt: skip
def test_scenario_that_cannot_be_played_is_rejected(name: str, text: str, reason: str) -> None:
    system = match()
    ask(system, name, text)
    system.tick(2)
    assert answers(system) == [(answer_t.REJECTED, reason)]
    assert not game(system).sent_off


def test_rejection_names_some_of_many_mistakes() -> None:
    system = match()
    ask(system, text=f"places: {{{', '.join(f'cyan{number}: [0, 0, 0]' for number in range(10, 30))}}}")
    system.tick(2)
    ((state, reason),) = answers(system)
    assert (state, reason.count("; text:"), reason[-13:]) == (answer_t.REJECTED, 7, "; and 13 more")


def test_newer_scenario_takes_the_place_of_an_older_one() -> None:
    system = match()
    ask(system, text=PLAY)
    system.tick(5)
    ask(system, text=PLAY)
    system.tick(40)
    assert answers(system) == [
        (answer_t.ACCEPTED, ""),
        (answer_t.FAILED, "another scenario was asked for before this one began"),
        (answer_t.ACCEPTED, ""),
        (answer_t.DONE, ""),
    ]


def test_settings_that_a_match_keeps_are_named() -> None:
    system = match()
    ask(system, text=f"{PLAY}rules: {{half_s: 9}}\nsettings: {{cyan2/agent: {{strategy: greedy}}}}\nseed: 3\n")
    system.tick(40)
    assert logged(system)[-1] == (
        "the match keeps its own settings; the scenario states others: rules.half_s, settings.cyan2/agent, seed"
    )


def test_command_that_is_refused_later_is_logged() -> None:
    system = match()
    text = PLAY.replace("place_ball: {x_m: 3.0, y_m: 4.0}", "referee: {name: subgoal, team: cyan}")
    ask(system, text=text)
    system.tick(60)
    assert answers(system)[-1] == (answer_t.DONE, "")
    assert "refused: the command at 0.5 s: cyan has no goal to take back; the score is cyan 0:0 magenta" in logged(
        system
    )


@pytest.mark.parametrize(
    ("kind", "fields", "mistake"),
    [
        ("place_robot", "robot: cyan11, x_m: 1", "no robot 'cyan11'; did you mean 'cyan1'?"),
        ("place_robot", "x_m: 1", "no robot ''; there are cyan1, magenta1"),
        ("hold_robot", "robot: magneta1, held: true", "no robot 'magneta1'; did you mean 'magenta1'?"),
        ("referee", "name: red_card, robot: cyan2", "no robot 'cyan2'; did you mean 'cyan1'?"),
    ],
)
def test_action_on_an_unknown_robot_is_a_mistake(kind: str, fields: str, mistake: str) -> None:
    right = "{place_robot: {robot: cyan1}}, {place_ball: {x_m: 2}}, {referee: {name: stop}}"
    with pytest.raises(PlanError) as caught:
        launch_plan("soccer-1v1.yaml", (f"world/crew.actions=[{right}, {{at_s: 0.5, {kind}: {{{fields}}}}}]",))
    assert str(caught.value) == f"--set: world/crew: actions: {kind} at 0.5 s: {mistake}"


def test_settings_beside_actions_change_during_a_run() -> None:
    plan = launch_plan("soccer-1v1.yaml", ("world/crew.actions=[{hold_robot: {robot: magenta1, held: true}}]",))
    (new,) = RunSettings(plan).check(["world/crew.settle_s=2"])
    assert new.said == {"settle_s": 2.0}
