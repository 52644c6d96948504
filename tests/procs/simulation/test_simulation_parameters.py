"""Physical parameters and those of errors are settings: each has an effect, and its own value by default."""

import math
from typing import Any

import numpy as np
import pytest

from fwk.testing import Bench
from lcmtypes.soccer import ground_truth_t, true_robot_t
from procs.model.ball import BallModel
from procs.model.field import Field
from procs.model.robot import RobotModel
from procs.simulation.percepts import Percepts
from procs.simulation.physics.rolling import RollingFriction
from procs.simulation.physics.world import World
from procs.simulation.radio_links import RadioLinks, RadioSettings
from procs.simulation.rendering.carpet import Wear, lay_carpet
from procs.vision.colours import WHITE

PLACES = {"cyan1": (-3.0, 1.5), "magenta1": (0.0, 2.2), "magenta2": (1.0, -2.0), "magenta3": (2.9, 4.0)}


def percepts(**settings: Any) -> list[bytes]:
    """Returns all percepts of some frames; the ball is nearly hidden, and much is seen that is not there."""
    always = {"ball_phantoms_1_s": 20.0, "robot_phantoms_1_s": 20.0, "line_phantoms": 0.3, "mouth_phantoms_1_s": 20.0}
    bench = Bench(Percepts, "cyan1/percepts", realism="harsh", latency_s=0.0, gaps_1_min=0.0, **(always | settings))
    robots = [true_robot_t(name=name, team=name[:-1], x_m=x_m, y_m=y_m) for name, (x_m, y_m) in PLACES.items()]
    for frame in range(30):
        bench.port("ground_truth").put(ground_truth_t(ball_x_m=3.0 + 0.05 * frame, ball_y_m=3.0, robots=robots))
        bench.iterate()
    ports = ("ball_percept", "obstacle_percepts", "line_points")
    return [message.encode() for port in ports for message in bench.port(port).sent]


@pytest.mark.parametrize(
    ("setting", "usual", "other"),
    [
        ("least_visible", 0.4, 0.9),
        ("beyond_line_px", 2.5, 20.0),
        ("beyond_robot_px", 4.2, 40.0),
        ("ball_phantom_m", 0.5, 2.0),
        ("robot_phantom_m", 0.6, 2.0),
        ("line_phantom_share", 0.8, 0.5),
    ],
)
def test_parameter_of_percepts_has_an_effect(setting: str, usual: float, other: float) -> None:
    plain = percepts()
    assert percepts(**{setting: usual}) == plain
    assert percepts(**{setting: other}) != plain


def test_ball_rests_below_its_standstill_speed() -> None:
    slow, usual = RollingFriction(BallModel(standstill_m_s=0.5)), RollingFriction(BallModel())
    for friction in (slow, usual):
        friction.roll(0.4, 0.0)
    assert slow.advance(0.4, 0.0, 0.01) == (0.0, 0.0)
    assert usual.advance(0.4, 0.0, 0.01)[0] > 0.39


def test_inertia_of_a_robot_is_a_setting() -> None:
    def moment(**model: float) -> float:
        return World(["cyan1"], np.random.default_rng(1), robot=RobotModel(**model)).robots["cyan1"].body.moment

    robot = RobotModel()
    assert moment() == robot.mass_kg * robot.radius_m**2 / 2
    assert moment(inertia=1.0) == 2 * moment()


def test_radio_makes_up_for_idle_time_as_long_as_set() -> None:
    settings = RadioSettings(bandwidth_bit_s=8000.0)
    for burst_s, arriving in ((0.1, 1), (0.5, 5)):
        links: RadioLinks[int] = RadioLinks(["cyan1", "cyan2"], np.random.default_rng(1))
        links.pass_time(0, settings, burst_s)
        for number in range(20):
            links.send("cyan1", number, 0, settings, size_bytes=100)
        assert len(links.receive(0)["cyan2"]) == arriving


def test_size_of_bare_places_and_specks_is_a_setting() -> None:
    def white(**wear: float) -> float:
        return float((lay_carpet(Field(), wear=Wear(**wear)).pixels == WHITE).all(axis=2).sum())

    clean = white()
    few, many = (white(clutter_1_m2=0.3, speck_m=speck_m) - clean for speck_m in (0.06, 0.12))
    assert 2.5 < many / few < 4.5
    assert white(worn=0.2, bare_m=0.2) == pytest.approx(0.8 * clean, rel=0.05)
    assert not math.isclose(white(worn=0.2, bare_m=0.2), white(worn=0.2))
