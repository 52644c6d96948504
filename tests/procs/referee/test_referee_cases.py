"""Cases of the rules, each with the tests that show it, and the tests of cases that no other module shows."""

import importlib
from pathlib import Path

import pytest

from procs.model.events import Event, Kind
from procs.model.field import Point
from procs.model.game_states import State
from procs.referee import restarts
from procs.referee.cards import Card
from procs.referee.orders import carry_out
from procs.referee.reasons import Reason
from procs.referee.rules import Rules
from procs.referee.shootout import Shootout
from procs.referee.sight import Sight
from tests.procs.referee.script import CYAN, MAGENTA, Script

CASES = {
    "ball over the touch line, over the goal line, without a touch": ["rules.test_calls"],
    "goal, also an own goal": [
        "rules.test_goals",
        "fouls.test_own_goal_straight_from_a_set_piece_is_a_corner",
        "set_pieces.test_ball_in_the_goal_without_a_touch_is_dropped",
    ],
    "kick-off: all in their own half": [
        "rules.test_positions_of_robots_at_a_set_piece",
        "set_pieces.test_halves_are_kept_until_the_kick_off_is_taken",
    ],
    "set piece: own team 2 m away, opponents 3 m": ["rules.test_positions_of_robots_at_a_set_piece"],
    "set piece: one defender may be in its penalty area": [
        "fouls.test_one_defender_may_stand_in_its_area_at_a_set_piece"
    ],
    "set piece: the ball moves 0.5 m freely": [
        "fouls.test_set_piece_is_play_after_half_a_metre_without_touch",
        "set_pieces.test_goal_needs_a_free_roll_off_the_taker",
        "set_pieces.test_ball_carried_to_a_mate_has_not_rolled_freely",
        "set_pieces.test_free_roll_is_not_needed_after_seven_seconds",
    ],
    "set piece: open to all after 7 s": ["rules.test_set_piece_that_no_robot_takes_becomes_play_in_time"],
    "set piece: taken by the wrong team, or robots come near": [
        "fouls.test_wrong_taker_has_the_set_piece_repeated",
        "fouls.test_robot_that_comes_near_has_the_set_piece_repeated",
        "fouls.test_set_piece_is_repeated_twice_at_most",
        "limits.test_third_breach_of_a_set_piece_brings_a_yellow_card",
        "set_pieces.test_robot_that_comes_back_breaches_no_set_piece",
    ],
    "set piece: a mate touches the ball before a goal counts": [
        "fouls.test_set_piece_goal_counts_only_after_a_second_robot",
        "fouls.test_set_piece_goal_counts_after_a_mate_played",
        "set_pieces.test_direct_shot_off_a_defender_is_a_corner",
        "set_pieces.test_late_set_piece_needs_a_second_robot_of_its_team",
    ],
    "set piece: the taker plays the ball once": [
        "fouls.test_taker_may_not_touch_twice",
        "fouls.test_taker_may_touch_after_another_robot",
        "set_pieces.test_mates_that_come_back_make_no_touch_a_double_one",
    ],
    "dropped ball: 1 m away, two robots before a goal": [
        "rules.test_positions_of_robots_at_a_set_piece",
        "fouls.test_dropped_ball_goal_needs_two_robots",
        "set_pieces.test_dropped_ball_own_goal_needs_two_robots",
        "set_pieces.test_dropped_ball_needs_two_robots_however_late",
    ],
    "penalty: reached within 10 s": [
        "match.test_penalty_that_is_not_taken_becomes_a_goal_kick",
        "match.test_penalty_that_is_touched_but_not_shot_becomes_play",
    ],
    "penalty: the keeper stays in its area": [
        "match.test_penalty_is_repeated_when_the_keeper_leaves_its_area",
        "set_pieces.test_penalty_waits_for_the_keeper_between_its_posts",
    ],
    "penalty: a goal without a second robot": ["match.test_penalty_goal_counts_without_a_second_robot"],
    "penalty: repeated after a foul of the defenders": [
        "mirrored.test_foul_of_the_defenders_at_a_penalty",
        "match.test_fouled_penalty_is_repeated_once_its_shot_is_over",
        "match.test_fouled_penalty_may_go_in_off_the_keeper",
        "rare.test_penalty_is_repeated_as_often_as_defenders_touch",
        "rare.test_collision_as_a_penalty_goes_out_repeats_it",
    ],
    "deciding penalty: one shot": [
        "cases.test_deciding_penalty_is_one_shot",
        "cases.test_rebound_of_a_deciding_penalty_is_a_miss",
        "cases.test_deciding_penalty_off_the_keeper_is_a_goal",
        "cases.test_keeper_at_the_ball_first_repeats_a_deciding_penalty",
        "cases.test_foul_of_the_taker_makes_a_deciding_penalty_a_miss",
        "cases.test_deciding_penalty_is_repeated_after_a_foul_of_the_keeper",
    ],
    "deciding penalty: within 30 s": [
        "cases.test_deciding_penalty_ends_after_thirty_seconds",
        "cases.test_taker_of_a_deciding_penalty_may_take_its_time",
    ],
    "holding for 1 s, over 0.30 m, again after less than 4 s": [
        "fouls.test_holding_the_ball_still_for_a_second_is_a_foul",
        "fouls.test_pulling_the_ball_back_is_a_foul_after_30_cm",
        "fouls.test_holding_twice_with_a_short_pause_adds_up",
        "fouls.test_holding_is_counted_anew_after_a_long_roll",
        "limits.test_ball_that_is_led_around_a_bend_is_not_pulled_back",
    ],
    "dribbling for 3 m": [
        "fouls.test_dribbling_further_than_three_metres_is_a_foul",
        "fouls.test_taker_of_a_set_piece_may_not_dribble_further_either",
        "limits.test_dribble_ends_where_the_ball_is_set_free",
    ],
    "pushing, collisions": [
        "fouls.test_pushing_a_rival_away_is_a_foul",
        "fouls.test_collision_in_the_own_area_brings_a_penalty",
        "limits.test_robot_that_a_rival_drives_pushes_no_other",
        "rare.test_robot_close_behind_a_rival_does_not_push_it",
        "rare.test_collision_in_the_tick_of_a_ball_out",
    ],
    "areas: one field player for 10 s, only the keeper in the goal area": [
        "fouls.test_areas",
        "rare.test_field_player_behind_its_goal_line_is_in_the_area",
    ],
    "goal from the own half": ["fouls.test_goal_from_the_own_half_does_not_count"],
    "goal without a pass of 1 m after winning the ball in the own half": [
        "fouls.test_ball_won_in_the_own_half_must_be_passed"
    ],
    "both teams at fault at once": [
        "limits.test_both_teams_crowd_an_area_and_the_ball_is_dropped",
        "limits.test_two_collisions_at_once_bring_a_dropped_ball",
        "rare.test_two_that_push_at_once_bring_a_dropped_ball",
        "limits.test_rivals_are_named_of_those_that_breach_a_kick_off",
    ],
    "advantage": [
        "advantage.test_foul_waits_while_its_victims_have_the_ball",
        "advantage.test_advantage_is_over_after_three_seconds",
        "advantage.test_contact_stops_the_game_while_a_foul_is_held_back",
        "rare.test_foul_is_punished_when_its_victims_put_the_ball_out",
    ],
    "start with two robots at least": [
        "cases.test_match_waits_for_two_robots_of_each_team",
        "cases.test_match_waits_for_a_team_that_is_beside_the_field",
    ],
    "two halves, change of ends, end": [
        "match.test_teams_change_ends_for_the_second_half",
        "match.test_match_ends_after_two_halves_with_a_draw",
        "match.test_foul_in_the_last_tick_of_a_half_counts",
    ],
    "overtime and penalties": [
        "match.test_draw_is_decided_by_overtime_and_penalties_if_wanted",
        "match.test_penalties_go_on_in_pairs_after_five",
    ],
    "times of the rule book": ["cases.test_times_are_those_of_the_rule_book"],
    "yellow, double yellow for 90 s, red": [
        "match.test_third_foul_brings_yellow_then_the_robot_leaves",
        "match.test_double_yellow_takes_a_robot_out_for_90_s",
        "match.test_red_card_is_for_the_rest_of_the_match",
    ],
    "robots off the field take no part": [
        "bystanders.test_robot_with_a_red_card_scores_no_goal",
        "bystanders.test_robot_sent_off_that_moves_the_ball_repeats",
        "bystanders.test_goal_counts_whose_shooter_has_left_since",
    ],
    "repair and substitution for 20 s, park": ["cases.test_robot_is_away_for_twenty_seconds"],
    "every command by hand": ["component.test_command_by_hand", "cases.test_commands_by_hand_about_goals_and_cards"],
}
BESIDE = {
    "cyan3": Point(4.0, 4.0),
    "cyan1": Point(-9.0, 3.0),
    "magenta2": Point(2.0, 3.0),
    "magenta3": Point(2.0, -3.0),
}


@pytest.mark.parametrize("case", CASES)
def test_case_has_its_tests(case: str) -> None:
    for name in CASES[case]:
        module, _, test = name.partition(".")
        assert callable(getattr(importlib.import_module(f"tests.procs.referee.test_referee_{module}"), test))


def penalties() -> Script:
    """Returns a match at its first deciding penalty, which cyan2 may now take."""
    script = Script(penalties=2)
    script.whistle.begin_half(5)
    script.tick()
    script.robots |= BESIDE | {"cyan2": Point(6.8, 0.0)}
    return script.started()


def test_deciding_penalty_is_one_shot() -> None:
    script = penalties()
    script.touch("cyan2", Kind.KICK)
    script.roll(8.5, 0.0)
    assert script.whistle.team is CYAN, "the shot is still on its way"
    script.touch("cyan2")
    assert (script.whistle.team, script.reasons) == (MAGENTA, ["missed"])


@pytest.mark.parametrize("robot", ["cyan2", "cyan3"])
def test_rebound_of_a_deciding_penalty_is_a_miss(robot: str) -> None:
    script = penalties()
    script.touch("cyan2", Kind.KICK)
    script.roll(9.5, 0.0)
    script.touch("magenta1")
    script.roll(8.5, 0.0)
    assert script.whistle.team is CYAN, "the ball may still roll in"
    script.touch(robot)
    script.goal(11.2, robot)
    assert (script.whistle.team, script.score, script.reasons) == (MAGENTA, (0, 0), ["missed"])


def test_deciding_penalty_off_the_keeper_is_a_goal() -> None:
    script = penalties()
    script.touch("cyan2", Kind.KICK)
    script.roll(10.0, 0.0)
    script.touch("magenta1")
    script.goal(11.2, "magenta1")
    assert script.score == (1, 0)


def test_foul_of_the_taker_makes_a_deciding_penalty_a_miss() -> None:
    script = penalties()
    script.carry("cyan2", 11.0, 0.3)
    assert (script.state, script.score) == ((State.PENALTY, MAGENTA, True), (0, 0))
    script = penalties()
    script.carry("cyan2", 9.0)
    script.tick(Event(Kind.COLLISION, "magenta1", "cyan2", 9.5, 0.0, 3.5))
    assert script.whistle.team is CYAN, "the foul of the keeper is not that of the taker"
    script.tick(Event(Kind.COLLISION, "cyan2", "magenta1", 9.5, 0.0, 3.5))
    script.goal(11.2, "cyan2")
    assert (script.state, script.score) == ((State.PENALTY, MAGENTA, True), (0, 0))


@pytest.mark.parametrize("scores", [True, False])
def test_deciding_penalty_is_repeated_after_a_foul_of_the_keeper(scores: bool) -> None:
    script = penalties()
    script.touch("cyan2", Kind.KICK)
    for robot, other in (("magenta1", "cyan2"), ("magenta3", "cyan3")):
        script.tick(Event(Kind.COLLISION, robot, other, 9.5 if robot == "magenta1" else 0.0, 0.0, 3.5))
    assert script.state == (State.PENALTY, CYAN, False), "the ball may still roll in"
    if scores:
        script.goal(11.2, "cyan2")
    else:
        script.tick(Event(Kind.OUT_END, "cyan2", "", 11.2, 2.0, 1.0))
    assert script.state == (State.PENALTY, MAGENTA if scores else CYAN, True)
    assert (script.score, script.reasons) == ((int(scores), 0), [] if scores else ["collision"])
    assert script.whistle.calls[-1].robot == ("" if scores else "magenta1")


def test_keeper_at_the_ball_first_repeats_a_deciding_penalty() -> None:
    script = penalties()
    script.touch("magenta1")
    assert script.state == (State.PENALTY, CYAN, True)
    assert script.reasons == ["touch before the set piece was taken"]
    assert script.whistle.shootout
    assert script.whistle.shootout.shots == {CYAN: 0, MAGENTA: 0}


def test_deciding_penalty_ends_after_thirty_seconds() -> None:
    script = penalties()
    script.touch("cyan2")
    script.wait(29.8)
    assert script.whistle.team is CYAN
    script.wait(0.3)
    assert (script.whistle.team, script.score) == (MAGENTA, (0, 0))


def test_taker_of_a_deciding_penalty_may_take_its_time() -> None:
    script = penalties()
    script.wait(20.0)
    script.touch("cyan2", Kind.KICK)
    script.goal(11.2, "cyan2")
    assert script.score == (1, 0)


def test_match_waits_for_two_robots_of_each_team() -> None:
    script = Script(least_robots=2)
    away = {name: script.robots.pop(name) for name in ("magenta2", "magenta3")}
    script.wait(30.0)
    assert script.whistle.stopped
    script.robots["magenta2"] = away["magenta2"]
    script.tick()
    assert not script.whistle.stopped


def test_match_does_not_wait_for_a_robot_with_a_red_card() -> None:
    script = Script(least_robots=2, repair_s=20.0)
    for name in ("cyan3", "magenta3"):
        del script.robots[name]
    script.started()
    script.whistle.card("cyan1", Card.RED)
    script.whistle.interrupt(restarts.after_foul(Point(1.0, 1.0), CYAN, script.whistle.rules))
    script.wait(5.0)
    assert not script.whistle.stopped
    script.whistle.take_out("magenta1", Reason.REPAIR)
    script.whistle.interrupt(restarts.after_foul(Point(1.0, 1.0), CYAN, script.whistle.rules))
    script.wait(19.0)
    assert script.whistle.stopped, "one under repair comes back"
    script.wait(3.0)
    assert not script.whistle.stopped


@pytest.mark.parametrize("least_robots", [1, 2])
def test_match_waits_for_a_team_that_is_beside_the_field(least_robots: int) -> None:
    script = Script(least_robots=least_robots)
    assert carry_out(script.whistle, Sight(script.ball, robots=script.robots), "park") == ""
    script.wait(19.0)
    assert script.whistle.stopped, "all robots come back"
    script.wait(2.0)
    assert not script.whistle.stopped
    for name in ("magenta1", "magenta2", "magenta3"):
        script.whistle.card(name, Card.RED)
    script.whistle.interrupt(restarts.after_foul(Point(1.0, 1.0), MAGENTA, script.whistle.rules))
    script.wait(5.0)
    assert not script.whistle.stopped, "none of magenta comes back"


def test_times_are_those_of_the_rule_book() -> None:
    rules = Rules()
    assert (rules.half_s, rules.overtime_half_s, rules.penalties) == (15 * 60, 5 * 60, 5)
    assert (rules.set_piece_s, rules.penalty_s, rules.shot_s, rules.moved_m) == (7, 10, 30, 0.5)
    assert (rules.holding_s, rules.holding_m, rules.holding_pause_s, rules.area_s) == (1, 0.3, 4, 10)
    assert (rules.dribbling_m, rules.pass_m, rules.double_yellow_s, rules.repair_s) == (3, 1, 90, 20)


@pytest.mark.parametrize("command", ["repair", "substitution", "park"])
def test_robot_is_away_for_twenty_seconds(command: str) -> None:
    script = Script(deadlock_s=60.0).playing()
    sight = Sight(script.ball, robots=script.robots)
    assert carry_out(script.whistle, sight, command, robot="" if command == "park" else "cyan2") == ""
    away = set(script.robots) if command == "park" else {"cyan2"}
    assert script.whistle.cards.sent_off == away
    script.wait(19.9)
    assert script.whistle.cards.sent_off == away
    script.wait(0.2)
    assert not script.whistle.cards.sent_off


def test_commands_by_hand_about_goals_and_cards() -> None:
    script = Script().playing()
    whistle, sight = script.whistle, Sight(script.ball, robots=script.robots)
    assert carry_out(whistle, sight, "goal", "magenta") == ""
    assert (script.score, script.state) == ((0, 1), (State.KICK_OFF, CYAN, True))
    assert carry_out(whistle, sight, "subgoal", "magenta") == ""
    assert script.score == (0, 0)
    assert carry_out(whistle, sight, "kickoff", "magenta") == ""
    assert script.state == (State.KICK_OFF, MAGENTA, True)
    assert carry_out(whistle, sight, "goalkick", "cyan") == ""
    assert (script.state[:2], whistle.spot.x_m < -6.0) == ((State.GOAL_KICK, CYAN), True)
    for card, out in (("yellow_card", False), ("double_yellow", True), ("red_card", True)):
        assert carry_out(whistle, sight, card, robot="magenta2") == ""
        assert ("magenta2" in whistle.cards.sent_off) == out
    for name, half in (("second_half", 2), ("first_half_overtime", 3), ("second_half_overtime", 4), ("first_half", 1)):
        assert carry_out(whistle, sight, name) == ""
        assert whistle.half == half


def test_shootout_counts_shots_in_turns() -> None:
    shootout = Shootout(2)
    assert shootout.shooter is CYAN
    shootout.shot(scored=True)
    assert (shootout.shooter, shootout.goals[CYAN], shootout.decided) == (MAGENTA, 1, False)


def test_page_counts_the_rules() -> None:
    assert f"all of {len(CASES)} rules" in (Path(__file__).parents[3] / "docs" / "soccer.md").read_text()
