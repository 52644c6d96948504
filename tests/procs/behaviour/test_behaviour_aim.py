"""Targets of shots and receivers of passes."""

from procs.behaviour import aim
from procs.behaviour.bodies import USUAL
from procs.model.field import Point
from tests.procs.behaviour.behaviour_parts import FIELD, robot

BALL = Point(6.0, 0.0)


def test_empty_goal_is_aimed_at_in_its_middle() -> None:
    best = aim.best_shot(BALL, [], FIELD, USUAL)
    assert abs(best.place.y_m) < 0.1
    assert best.free_rad > 0.15


def test_corner_away_from_the_keeper_is_chosen() -> None:
    assert aim.best_shot(BALL, [robot("", 10.5, 0.4)], FIELD, USUAL).place.y_m < -0.4
    assert aim.best_shot(BALL, [robot("", 10.5, -0.4)], FIELD, USUAL).place.y_m > 0.4


def test_robot_before_the_ball_leaves_no_room() -> None:
    assert aim.best_shot(BALL, [robot("", 6.5, 0.0)], FIELD, USUAL).free_rad < 0.0


def test_robot_behind_ball_or_beyond_target_does_not_count() -> None:
    free_rad = aim.lane_rad(BALL, Point(9.0, 0.0), [], USUAL)
    assert aim.lane_rad(BALL, Point(9.0, 0.0), [robot("", 3.0, 0.0), robot("", 10.0, 0.0)], USUAL) > 1.0
    assert free_rad > 3.0


def test_lob_is_blocked_by_a_robot_that_will_be_before_the_ball() -> None:
    rival = robot("", 7.2, 0.8)
    assert aim.best_lob(BALL, [rival], FIELD, USUAL).free_rad > 0.05
    assert aim.best_lob(BALL, [rival._replace(velocity_m_s=Point(0.0, -4.0))], FIELD, USUAL).free_rad < 0.0
    assert aim.best_lob(BALL, [robot("", 10.0, 0.0)], FIELD, USUAL).free_rad > 0.05, "the ball passes over it"


def test_robot_far_down_the_line_counts_as_wider() -> None:
    slow = aim.lane_rad(Point(0.0, 0.0), Point(9.0, 0.0), [robot("", 8.0, 1.0)], USUAL, ball_m_s=4.0)
    fast = aim.lane_rad(Point(0.0, 0.0), Point(9.0, 0.0), [robot("", 8.0, 1.0)], USUAL, ball_m_s=12.0)
    assert slow < 0.0 < fast


def test_passes_go_forward_past_opponents() -> None:
    player = robot("cyan2", 0.0, 0.0)
    ahead, behind = robot("cyan3", 4.0, 2.0), robot("cyan4", -4.0, 2.0)
    best = aim.best_pass(player, [behind, ahead], [], USUAL)
    assert best is not None
    assert best.place == ahead.place
    covered = aim.best_pass(player, [behind, ahead], [robot("", 2.0, 1.0)], USUAL)
    assert covered is not None
    assert covered.free_rad < 0.0
    back = aim.best_pass(player, [behind, ahead], [robot("", 2.0, 1.0)], USUAL, back_m=9.0)
    assert back is not None
    assert back.place == behind.place


def test_pass_leads_a_running_mate() -> None:
    runner = robot("cyan3", 4.0, 0.0)._replace(velocity_m_s=Point(0.0, 2.0))
    best = aim.best_pass(robot("cyan2", 0.0, 0.0), [runner], [], USUAL)
    assert best is not None
    assert best.place == (4.0, 1.0)


def test_no_robot_at_a_useful_distance_gets_no_pass() -> None:
    player = robot("cyan2", 0.0, 0.0)
    assert aim.best_pass(player, [robot("cyan3", 1.0, 0.0), robot("cyan4", 10.0, 0.0)], [], USUAL) is None


def test_receiver_is_kept_for_a_small_difference() -> None:
    player = robot("cyan2", 0.0, 0.0)
    left, right = robot("cyan3", 4.0, 2.0), robot("cyan4", 4.2, -2.0)
    best = aim.best_pass(player, [left, right], [], USUAL)
    kept = aim.best_pass(player, [left, right], [], USUAL, kept="cyan3")
    assert best is not None
    assert kept is not None
    assert (best.receiver, kept.receiver) == ("cyan4", "cyan3")
