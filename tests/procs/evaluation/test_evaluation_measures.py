"""Measures of game pieces with known errors."""

import math
from typing import Any

import numpy as np
import pytest

from fwk.testing import system_of
from lcmtypes.robot import wheel_command_t, wheel_state_t
from lcmtypes.soccer import (
    ball_percept_t,
    field_t,
    ground_truth_t,
    match_event_t,
    pose_t,
    robot_estimate_t,
    team_inbox_t,
    team_message_t,
    true_robot_t,
)
from procs.evaluation.beliefs import believed
from procs.evaluation.match import samples_of
from procs.evaluation.piece import piece_of
from procs.evaluation.table import MEASURES, rows_of
from tests.procs.evaluation.pieces import FIRST, event, model, piece, robot


def test_ball_errors_are_those_of_the_estimate() -> None:
    made = piece([robot("cyan1", 0.0, 1.0), robot("magenta1", 9.0, 0.0)])
    made.by_robot["world_model"] = {"cyan1": {tick: model((truth.ball_x_m, 0.1)) for tick, truth in made.truth.items()}}
    found = believed(made)
    assert np.sqrt(found["ball rolling freely, position"].mean()) == pytest.approx(0.1)
    assert np.sqrt(found["ball moving, velocity"].mean()) == pytest.approx(1.0)  # the estimate says that it rests


def test_ball_in_the_air_has_a_row_of_its_own() -> None:
    made = piece([robot("cyan1", 0.0, 1.0), robot("magenta1", 9.0, 0.0)], ticks=20)
    for tick in range(FIRST, FIRST + 5):
        made.truth[tick].ball_z_m = 0.5
    made.by_robot["world_model"] = {"cyan1": {tick: model((truth.ball_x_m, 0.1)) for tick, truth in made.truth.items()}}
    found = believed(made)
    assert len(found["ball in the air, position"]) == 5
    assert len(found["ball moving, position"]) == len(found["ball rolling freely, position"]) == 15
    assert found["inside 95 %, all"].mean() == 1.0
    assert not len(found["ball resting, position"])


def test_ball_does_not_roll_freely_just_after_a_bounce() -> None:
    made = piece([robot("cyan1", 0.0, 1.0), robot("magenta1", 9.0, 0.0)], ticks=20)
    for tick in range(FIRST + 10, FIRST + 20):
        made.truth[tick].ball_vx_m_s = -1.0
    made.by_robot["world_model"] = {"cyan1": {tick: model((truth.ball_x_m, 0.1)) for tick, truth in made.truth.items()}}
    assert len(believed(made)["ball rolling freely, position"]) == 20 - 7, "0.3 s and the tick of the bounce"
    assert len(believed(made)["ball moving, position"]) == 20


def test_ball_that_the_crew_moves_a_little_is_left_out_too() -> None:
    made = piece([robot("cyan1", 0.0, 1.0), robot("magenta1", 9.0, 0.0)], ticks=20, vx_m_s=0.0)
    made.by_robot["world_model"] = {"cyan1": {tick: model((0.1, 0.0)) for tick in made.truth}}
    for tick in range(FIRST + 5, FIRST + 20):
        made.truth[tick].ball_y_m = 0.15
    made.last_touch = dict.fromkeys(made.truth, "magenta1")
    assert len(believed(made)["ball resting, position"]) == 20, "nothing says that it was placed"
    made.last_touch |= dict.fromkeys(range(FIRST + 5, FIRST + 20), "")
    assert len(believed(made)["ball resting, position"]) == 20 - 10, "0.5 s from where it was put down"


@pytest.mark.parametrize(("toucher", "case"), [("cyan1", "held by itself"), ("magenta1", "held by another")])
def test_claims_are_counted_by_the_holder_of_the_ball(toucher: str, case: str) -> None:
    made = piece([robot("cyan1", 0.0, 1.0), robot("magenta1", 9.0, 0.0)])
    made.events = {tick: [event(match_event_t.TOUCH, toucher)] for tick in made.truth}
    made.by_robot["world_model"] = {
        "cyan1": {tick: model((truth.ball_x_m + 0.3, 0.0)) for tick, truth in made.truth.items()}
    }
    found = believed(made)
    assert found[f"inside 95 %, {case}"].mean() == 0.0  # three standard deviations off
    assert not len(found["ball rolling freely, position"])


def test_fused_ball_is_compared_with_the_nearest_robots_sighting() -> None:
    made = piece([robot("cyan1", 0.0, 1.0), robot("cyan2", 0.0, 3.0)])
    made.by_robot["world_model"] = {
        "cyan1": {tick: model((truth.ball_x_m, 0.05)) for tick, truth in made.truth.items()}
    }
    made.by_robot["team_message"] = {"cyan1": {}, "cyan2": {}}
    for tick, truth in made.truth.items():
        for name, error_m, distance_m in (("cyan1", 0.2, 1.0), ("cyan2", 0.4, 3.0)):
            told = made.by_robot["team_message"][name][tick + 1] = team_message_t()
            told.ball_visible, told.ball_capture_us, told.ball_distance_m = True, tick * 50_000, distance_m
            told.ball_x_m, told.ball_y_m = truth.ball_x_m, error_m
    rows = {row.name: row.value for row in rows_of([samples_of(made)])}
    rolled_m = 0.05  # between the exposure and the message
    assert rows["fused to best single"] == pytest.approx(0.05 / math.hypot(0.2, rolled_m))
    assert rows["fused to best single at its exposure"] == pytest.approx(0.05 / 0.2)
    assert rows["fused to plain average"] == pytest.approx(0.05 / math.hypot(0.3, rolled_m))


def test_single_sightings_count_at_their_exposure_within_4_m() -> None:
    made = piece([robot("cyan1", 0.0, 1.0)])
    for tick in range(FIRST + 20, FIRST + 40):
        made.truth[tick].ball_x_m, made.truth[tick].ball_vx_m_s = 1.0, 0.0
    told = made.by_robot["team_message"] = {"cyan1": {}, "cyan2": {}}
    for tick, truth in made.truth.items():
        for name, error_m, distance_m in (("cyan1", 0.2, 1.0), ("cyan2", 0.4, 5.0)):
            each = told[name][tick + 2] = team_message_t()
            each.ball_visible, each.ball_capture_us, each.ball_distance_m = True, tick * 50_000, distance_m
            each.ball_x_m, each.ball_y_m = truth.ball_x_m, error_m * (1 if truth.ball_vx_m_s else 0.5)
    rows = {row.name: row.value for row in rows_of([samples_of(made)])}
    assert rows["one sighting, ball moving"] == pytest.approx(0.2)
    assert rows["one sighting, ball resting"] == pytest.approx(0.1)


def test_sightings_between_ticks_are_compared_with_the_truth() -> None:
    made = piece([robot("cyan1", 0.0, 1.0)], vx_m_s=5.0)
    models = {tick: model((truth.ball_x_m, 0.05)) for tick, truth in made.truth.items()}
    told = made.by_robot["team_message"] = {"cyan1": {}}
    made.by_robot["world_model"] = {"cyan1": models}
    for tick, truth in made.truth.items():
        each = told["cyan1"][tick + 1] = team_message_t()
        each.ball_visible, each.ball_capture_us = True, tick * 50_000 + 20_000
        each.ball_x_m, each.ball_y_m = truth.ball_x_m + 5.0 * 0.02, 0.1
    rows = {row.name: row.value for row in rows_of([samples_of(made)])}
    assert rows["one sighting, ball moving"] == pytest.approx(0.1)
    assert rows["fused to best single at its exposure"] == pytest.approx(0.5)


def test_sighting_while_the_crew_moves_the_ball_is_left_out() -> None:
    """A camera that exposes between two ticks shows a ball that was placed elsewhere at its new place."""
    made = piece([robot("cyan1", 0.0, 1.0)], vx_m_s=0.0)
    for tick in range(FIRST + 10, FIRST + 40):
        made.truth[tick].ball_x_m = 3.0
    made.by_robot["world_model"] = {
        "cyan1": {tick: model((truth.ball_x_m, 0.05)) for tick, truth in made.truth.items()}
    }
    told = made.by_robot["team_message"] = {"cyan1": {}}
    for tick in range(FIRST, FIRST + 39):
        each = told["cyan1"][tick + 2] = team_message_t()
        each.ball_visible, each.ball_capture_us = True, tick * 50_000 + 10_000
        each.ball_x_m, each.ball_y_m = made.truth[tick + 1].ball_x_m, 0.1
    rows = {row.name: row.value for row in rows_of([samples_of(made)])}
    assert rows["one sighting, ball resting"] == pytest.approx(0.1)
    assert rows["fused to best single"] == rows["fused to median robot"] == pytest.approx(0.5)


def test_ball_that_one_robot_knows_is_known_to_its_team() -> None:
    made = piece([robot("cyan1", 0.0, 1.0), robot("cyan2", 0.0, 3.0)])
    models = {name: {tick: model((0.0, 0.0)) for tick in made.truth} for name in ("cyan1", "cyan2")}
    made.by_robot["world_model"] = models
    for name, first, last in (("cyan1", 0, 4), ("cyan1", 10, 20), ("cyan2", 15, 40)):
        for tick in range(FIRST + first, FIRST + last):
            models[name][tick].ball.known = False
    found = samples_of(made)
    assert found["ball known to a robot of the team"].mean() == pytest.approx(1 - 5 / 40)
    assert found["ball lost, until known again"].tolist() == pytest.approx([0.5, math.inf])


@pytest.mark.parametrize(
    ("lost", "found", "counts"), [(39, 40, []), (25, 30, []), (19, 40, [math.inf]), (19, 39, [1.0])]
)
def test_ball_lost_just_before_the_end_does_not_count(lost: int, found: int, counts: list[float]) -> None:
    """Whether it is found in time is unknown, and short losses alone would show otherwise."""
    made = piece([robot("cyan1", 0.0, 1.0)])
    models = {tick: model((0.0, 0.0)) for tick in made.truth}
    made.by_robot["world_model"] = {"cyan1": models}
    for tick in range(FIRST + lost, FIRST + found):
        models[tick].ball.known = False
    assert samples_of(made)["ball lost, until known again"].tolist() == pytest.approx(counts)


def test_kick_delay_ends_when_the_velocity_is_known() -> None:
    made = piece([robot("cyan1", 0.0, 1.0)], vx_m_s=5.0)
    made.events[FIRST] = [event(match_event_t.KICK, "cyan1", 5.0)]
    models: dict[int, Any] = {tick: model((truth.ball_x_m, 0.0)) for tick, truth in made.truth.items()}
    for tick in range(FIRST + 3, FIRST + 40):
        models[tick].ball.vx_m_s = 4.6
    made.by_robot["world_model"] = {"cyan1": models, "magenta2": {FIRST: model((0.0, 0.0))}}
    made.truth[FIRST].robots.append(robot("magenta2", 5.0, 5.0))
    found = believed(made)
    assert found["velocity known after a kick"].tolist() == pytest.approx([0.15, math.inf])
    assert found["velocity known after an own kick"].tolist() == pytest.approx([0.15])


@pytest.mark.parametrize(("bounces_after", "counts"), [(0, 0), (3, 0), (20, 1)])
def test_kick_against_a_wall_is_not_measured(bounces_after: int, counts: int) -> None:
    made = piece([robot("cyan1", 0.0, 1.0)], vx_m_s=5.0)
    made.events[FIRST] = [event(match_event_t.KICK, "cyan1", 5.0)]
    made.by_robot["world_model"] = {"cyan1": {tick: model((0.0, 0.0)) for tick in made.truth}}
    for tick in range(FIRST + bounces_after, FIRST + 40):
        made.truth[tick].ball_vx_m_s = -2.5
    assert len(believed(made)["velocity known after a kick"]) == counts


def test_lag_of_an_opponent_is_its_distance_behind_by_its_speed() -> None:
    made = piece([robot("cyan1", 0.0, 1.0), robot("magenta1", 2.0, 0.0, vx_m_s=2.0)])
    behind = robot_estimate_t()
    behind.x_m = 1.8
    made.by_robot["world_model"] = {"cyan1": {tick: model((0.0, 0.0), opponents=[behind]) for tick in made.truth}}
    rows = {row.name: row.value for row in rows_of([samples_of(made)])}
    assert rows["opponents, lag"] == pytest.approx(0.1)
    assert rows["opponents, position"] == pytest.approx(0.2)
    assert (rows["opponents known"], rows["opponents that do not exist"]) == (1.0, 0.0)


@pytest.mark.slow
def test_launch_file_gives_every_measure_its_samples() -> None:
    system = system_of("soccer-1v1.yaml", seed=2)
    system.tick(110)
    made = piece_of(system.sent, 0.04)
    found = samples_of(made)
    assert set(found) == {measure.name for measure in MEASURES}
    assert found["ball known"].any()
    assert np.sqrt(found["pose, position"].mean()) < 0.2


def test_baselines_are_measured_beside_the_beliefs() -> None:
    made = piece([robot("cyan1", 0.0, 1.0), robot("magenta1", 9.0, 0.0)])
    made.by_robot["average_ball"] = {
        "cyan1": {tick: model((truth.ball_x_m, 0.3)) for tick, truth in made.truth.items()}
    }
    pose = pose_t(x_m=0.2, localized=True)
    made.by_robot["particle_pose"] = {"cyan1": dict.fromkeys(made.truth, pose)}
    found = believed(made)
    assert np.sqrt(found["plain average: ball moving, position"].mean()) == pytest.approx(0.3)
    assert np.sqrt(found["200 particles: pose, position"].mean()) == pytest.approx(math.hypot(0.2, 1.0))
    assert not len(found["pose, position"])


def test_radio_is_measured_by_its_times() -> None:
    made = piece([robot("cyan1", 0.0, 1.0)], ticks=20)
    told, inbox = team_message_t(), team_inbox_t()
    told.header.time_us, inbox.header.time_us, inbox.messages = 5_000_000, 5_050_000, [told]
    made.by_robot = {
        "team_message": {"cyan1": {FIRST: told}},
        "team_inbox": {"cyan2": {FIRST + 1: inbox}},
    }
    made.told_bytes = {"cyan1": 1000, "cyan2": 250}
    rows = {row.name: row.value for row in rows_of([samples_of(made)])}
    assert rows["radio, age of a mate's newest message, 95 %"] == pytest.approx(0.1)  # read in the tick after the inbox
    assert rows["radio, volume of a team"] == pytest.approx(0.01)
    assert rows["radio, messages of a robot"] == pytest.approx(1.0)


def driven(delay_s: float, period_s: float = 0.05) -> dict[str, Any]:
    """Returns messages of wheels that turn as commanded after a delay; of 60 exposures two in three have a command."""

    def speeds_m_s(time_s: float) -> list[float]:
        return [math.sin(3.0 * time_s), math.cos(2.0 * time_s), 0.5]

    ticks = range(FIRST, FIRST + 60)
    percept = ball_percept_t(capture_us=5_065_000)
    percept.header.time_us = 5_100_000
    turning = {tick: speeds_m_s((tick - 0.5) * period_s - delay_s) for tick in ticks}
    return {
        "ball_percept": {"cyan1": dict.fromkeys(ticks, percept)},
        "wheel_command": {
            "cyan1": {tick: wheel_command_t(wheel_m_s=speeds_m_s(tick * period_s)) for tick in ticks if tick % 3}
        },
        "wheel_state": {"cyan1": {tick: wheel_state_t(measured_m_s=speeds) for tick, speeds in turning.items()}},
    }


@pytest.mark.parametrize("delay_s", [0.0, 0.06, 0.13])
def test_loop_reaches_from_exposures_to_turning_wheels(delay_s: float) -> None:
    made = piece([robot("cyan1", 0.0, 1.0)], ticks=60)
    made.by_robot = driven(delay_s)
    found = samples_of(made)["picture to motion of the wheels, 95 %"]
    assert found.tolist() == pytest.approx([0.035 + delay_s] * 40, abs=0.003)


def test_robot_that_stands_has_no_loop_to_measure() -> None:
    made = piece([robot("cyan1", 0.0, 1.0)], ticks=60)
    made.by_robot = driven(0.06)
    made.by_robot["wheel_command"]["cyan1"] = dict.fromkeys(made.truth, wheel_command_t(wheel_m_s=[0.0] * 3))
    assert not len(samples_of(made)["picture to motion of the wheels, 95 %"])


@pytest.mark.parametrize("speeds_m_s", [[], [math.nan, 0.0, 0.0]])
def test_wheels_without_speeds_are_left_out(speeds_m_s: list[float]) -> None:
    made = piece([robot("cyan1", 0.0, 1.0)], ticks=60)
    made.by_robot = driven(0.06)
    made.by_robot["wheel_state"]["cyan1"][FIRST + 30] = wheel_state_t(measured_m_s=speeds_m_s)
    found = samples_of(made)["picture to motion of the wheels, 95 %"]
    assert found.max() == pytest.approx(0.095, abs=0.003)


def test_teams_and_field_are_those_of_the_match() -> None:
    truth, field = ground_truth_t(), field_t()
    truth.header.tick, field.length_m, field.width_m = 1, 12.0, 8.0
    for name, team, number in (("anna", "cyan", 2), ("bert", "magenta", 1), ("cyan1", "", 0)):
        made = true_robot_t()
        made.name, made.team, made.number = name, team, number
        truth.robots.append(made)
    truth.n = 3
    piece = piece_of({"world/ground_truth": [truth.encode()], "world/field": [field.encode()]}, 0.05)
    assert (piece.measures.length_m, piece.measures.width_m) == (12.0, 8.0)
    assert [piece.team(name) for name in ("anna", "bert", "cyan1", "magenta4")] == [
        "cyan",
        "magenta",
        "cyan",
        "magenta",
    ]
    assert [each.name for each in piece.rivals(1, "anna")] == ["bert"]
