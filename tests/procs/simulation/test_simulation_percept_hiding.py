"""Percepts drawn from the truth beside rendered pictures: a ball that another robot holds, and a tilted mirror."""

import math
from typing import Any

import numpy as np
import pytest

from fwk import Component, Config, Writes
from lcmtypes.soccer import ball_percept_t, ground_truth_t
from procs.model.ball import BALL
from procs.model.robot import ROBOT
from tests.procs.simulation.test_simulation_percepts import OWN, Flying, place_of, seen_through, truth, world


class HoldingConfig(Config):
    """The robot that holds the ball: its distance, and how far its mouth is turned away from the robot that looks."""

    away_m: float = 3.0
    turned_deg: float = 0.0


class Holding(Component):
    """Another robot ahead holds the ball; its mouth is on the left."""

    stage = "pre_loop"
    ground_truth: Writes[ground_truth_t]
    config: HoldingConfig

    def loop(self) -> None:
        away_m, turned_rad, held_m = self.config.away_m, math.radians(self.config.turned_deg), ROBOT.held_ball_m(BALL)
        ball_m = world(away_m - held_m * math.cos(turned_rad), held_m * math.sin(turned_rad))
        self.ground_truth.value = truth(ball_m, world(away_m, 0.0))
        self.ground_truth.write()


@pytest.mark.parametrize("rendered", [False, True])
@pytest.mark.parametrize(("turned_deg", "found"), [(60, 40), (105, 40), (120, 40), (135, 0)])
def test_ball_that_another_robot_holds(rendered: bool, turned_deg: float, found: int) -> None:
    """The robot hides more and more of it before the middle of the ball is behind the whole robot."""
    system = seen_through(rendered, Holding, turned_deg=turned_deg)
    system.tick(40)
    percepts = map(ball_percept_t.decode, system.sent["cyan1/ball_percept"])
    lefts_m = [percept.y_m for percept in percepts if percept.visible]
    assert len(lefts_m) == pytest.approx(found, abs=6)
    if found:
        true_m = ROBOT.held_ball_m(BALL) * math.sin(math.radians(turned_deg))
        assert np.mean(lefts_m) == pytest.approx(true_m, abs=0.005)


@pytest.mark.parametrize("away_m", [1.0, 2.0, 4.0])
def test_ball_hidden_in_part_states_the_same_error(away_m: float) -> None:
    """A ball of which 30 % are hidden is as uncertain as in pictures, near and far."""
    stated_m = []
    for rendered in (False, True):
        system = seen_through(rendered, Holding, away_m=away_m, turned_deg=110.0)
        system.tick(20)
        percepts = map(ball_percept_t.decode, system.sent["cyan1/ball_percept"])
        stated_m.append(np.mean([math.sqrt(np.trace(each.covariance_m2)) for each in percepts if each.visible]))
    drawn_m, rendered_m = stated_m
    assert drawn_m == pytest.approx(rendered_m, rel=0.15)


@pytest.mark.parametrize("away_m", [1.0, 4.0])
def test_tilt_moves_the_ball_as_in_pictures(away_m: float) -> None:
    """A tilt moves what is far away along the ray, and hardly across it."""
    errors_m = []
    for rendered in (False, True):
        found = []
        for seed in range(1, 9):
            system = seen_through(
                rendered, Flying, {"realism": "none", "tilt_sd_deg": 0.5}, seed, away_m=away_m, height_m=0.0
            )
            system.tick(6)
            scene: Any = system.runners["world/scene"].component
            for shown, sent in zip(scene.shown, system.sent["cyan1/ball_percept"], strict=True):
                percept = ball_percept_t.decode(sent)
                ahead_x, ahead_y = (np.array((shown.ball_x_m, shown.ball_y_m)) - OWN[:2]) / away_m
                x_m, y_m = place_of(percept) - OWN[:2]
                found.append((ahead_x * x_m + ahead_y * y_m - away_m, ahead_x * y_m - ahead_y * x_m))
        errors_m.append(np.sqrt(np.mean(np.square(found), axis=0)))
    (drawn_along_m, drawn_across_m), (rendered_along_m, rendered_across_m) = errors_m
    assert drawn_along_m == pytest.approx(rendered_along_m, rel=0.5)
    assert drawn_across_m == pytest.approx(rendered_across_m, rel=0.5)
