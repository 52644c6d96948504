"""Percepts drawn from the truth: like those of the rendered path, with its distances, losses and hidden things."""

import math
from functools import cache
from typing import Any

import numpy as np
import pytest

from fwk import Component, Config, Writes
from fwk.testing import Bench, MemorySystem
from lcmtypes.soccer import ball_percept_t, ground_truth_t, line_points_t, obstacle_percepts_t, true_robot_t
from procs.localization.line_map import line_map
from procs.model.algebra import Floats
from procs.model.field import Field
from procs.simulation.camera import Camera
from procs.simulation.percept_errors import PerceptErrors
from procs.simulation.percepts import Percepts
from procs.simulation.sight import glimpse_of
from procs.vision.omni_ball import OmniBall
from procs.vision.omni_field import OmniField

OWN = (-3.0, 1.5, 0.7)
FRAMES = 320
FLYING_FRAMES = 240
AWAY_M = (1.5, 3.0, 4.5)


def robot(name: str, x_m: float, y_m: float, heading_rad: float = 0.0) -> true_robot_t:
    made = true_robot_t()
    made.name, made.team, made.x_m, made.y_m, made.heading_rad = name, name[:-1], x_m, y_m, heading_rad
    return made


def truth(ball_m: tuple[float, float], *others: tuple[float, float], ball_z_m: float = 0.0) -> ground_truth_t:
    made = ground_truth_t()
    made.ball_x_m, made.ball_y_m, made.ball_z_m = *ball_m, ball_z_m
    made.robots = [robot("cyan1", *OWN), *(robot(f"magenta{n}", *place) for n, place in enumerate(others, 1))]
    return made


class Scene(Component):
    """Ball and one other robot go around the robot at one of three distances."""

    stage = "pre_loop"
    ground_truth: Writes[ground_truth_t]

    def init(self) -> None:
        self.shown: list[ground_truth_t] = []

    def loop(self) -> None:
        number = len(self.shown)
        away_m, angle_rad = AWAY_M[number % 3], 2.4 * number
        ball_m = (OWN[0] + away_m * math.cos(angle_rad), OWN[1] + away_m * math.sin(angle_rad))
        other_m = (OWN[0] - away_m * math.cos(angle_rad), OWN[1] - away_m * math.sin(angle_rad))
        self.ground_truth.value = truth(ball_m, other_m)
        self.shown.append(self.ground_truth.value)
        self.ground_truth.write()


class FlyingConfig(Config):
    """Place of a ball in the air."""

    away_m: float = 1.0
    height_m: float = 0.1


class BehindConfig(Config):
    """Place of a robot before the ball."""

    aside_m: float = 0.3


class Behind(Component):
    """A ball lies 3 m ahead; another robot stands 2.4 m ahead and to the left."""

    stage = "pre_loop"
    ground_truth: Writes[ground_truth_t]
    config: BehindConfig

    def loop(self) -> None:
        self.ground_truth.value = truth(world(3.0, 0.0), world(2.4, self.config.aside_m))
        self.ground_truth.write()


class Flying(Component):
    """A ball in the air goes around the robot."""

    stage = "pre_loop"
    ground_truth: Writes[ground_truth_t]
    config: FlyingConfig

    def init(self) -> None:
        self.shown: list[ground_truth_t] = []

    def loop(self) -> None:
        angle_rad, away_m = 2.4 * len(self.shown), self.config.away_m
        ball_m = (OWN[0] + away_m * math.cos(angle_rad), OWN[1] + away_m * math.sin(angle_rad))
        self.ground_truth.value = truth(ball_m, ball_z_m=self.config.height_m)
        self.shown.append(self.ground_truth.value)
        self.ground_truth.write()


def seen_through(
    rendered: bool, scene: type[Component], eyes: dict[str, Any] | None = None, seed: int = 1, **settings: Any
) -> MemorySystem:
    """Returns a robot that sees a scene through camera and detectors, or by percepts from the truth.

    `eyes` are settings of camera or percepts, `settings` those of the scene.
    """
    parts: dict[str, Any] = {"world/scene": scene}
    if rendered:
        parts |= {"cyan1/camera": Camera, "cyan1/omni_ball": OmniBall, "cyan1/omni_field": OmniField}
    else:
        parts |= {"cyan1/percepts": Percepts}
    owner = "camera" if rendered else "percepts"
    return MemorySystem(
        parts,
        settings={
            f"cyan1/{owner}": {"latency_s": 0.0, "gaps_1_min": 0.0, "tilt_sd_deg": 0.0, **(eyes or {})},
            "world/scene": settings,
        },
        channels={"world/scene": {"ground_truth": "world/ground_truth"}},
        seed=seed,
    )


@cache
def measured(rendered: bool) -> dict[str, Any]:
    """Errors of the ball and the obstacle by distance, distances of points from lines, and how much was found."""
    system = seen_through(rendered, Scene)
    system.tick(3 * FRAMES)
    scene: Any = system.runners["world/scene"].component
    balls: dict[float, list[float]] = {away_m: [] for away_m in AWAY_M}
    robots: dict[float, list[float]] = {away_m: [] for away_m in AWAY_M}
    lines_m, counts = [], []
    lines = line_map(Field())
    decoded = zip(
        scene.shown,
        map(ball_percept_t.decode, system.sent["cyan1/ball_percept"]),
        map(obstacle_percepts_t.decode, system.sent["cyan1/obstacle_percepts"]),
        map(line_points_t.decode, system.sent["cyan1/line_points"]),
        strict=True,
    )
    for number, (shown, ball, obstacles, points) in enumerate(decoded):
        assert ball.capture_us == obstacles.capture_us == points.capture_us == shown.header.time_us
        away_m = AWAY_M[number % 3]
        if ball.visible:
            balls[away_m].append(math.dist(world(ball.x_m, ball.y_m), (shown.ball_x_m, shown.ball_y_m)))
        other = shown.robots[1]
        errors_m = [math.dist(world(each.x_m, each.y_m), (other.x_m, other.y_m)) for each in obstacles.obstacles]
        robots[away_m] += [min(errors_m)] if errors_m and min(errors_m) < 1.0 else []
        places = np.array([world(x_m, y_m) for x_m, y_m in zip(points.x_m, points.y_m, strict=True)])
        distance_m, _, _ = lines.look_up(places[:, 0], places[:, 1])
        lines_m += np.abs(distance_m).tolist()
        counts.append(points.n)
    return {
        "ball": {away_m: rms(errors) for away_m, errors in balls.items()},
        "ball seen": {away_m: len(errors) / FRAMES for away_m, errors in balls.items()},
        "robot": {away_m: rms(errors) for away_m, errors in robots.items()},
        "robot seen": {away_m: len(errors) / FRAMES for away_m, errors in robots.items()},
        "line": float(np.median(lines_m)),
        "points": float(np.mean(counts)),
    }


def rms(errors: list[float]) -> float:
    return math.sqrt(sum(error**2 for error in errors) / max(1, len(errors)))


def world(x_m: float, y_m: float) -> tuple[float, float]:
    cosine, sine = math.cos(OWN[2]), math.sin(OWN[2])
    return OWN[0] + cosine * x_m - sine * y_m, OWN[1] + sine * x_m + cosine * y_m


def bench(**settings: Any) -> Bench:
    return Bench(Percepts, name="cyan1/percepts", **{"latency_s": 0.0, **settings})


def look(eyes: Bench, seen: ground_truth_t) -> ball_percept_t:
    eyes.port("ground_truth").put(seen)
    eyes.iterate()
    percept: ball_percept_t = eyes.port("ball_percept").sent[-1]
    return percept


def place_of(percept: ball_percept_t) -> Floats:
    return np.array(world(percept.x_m, percept.y_m))


@pytest.mark.slow
@pytest.mark.parametrize("what", ["ball", "robot"])
@pytest.mark.parametrize("away_m", AWAY_M)
def test_errors_grow_with_distance_as_those_of_pictures(what: str, away_m: float) -> None:
    drawn, seen = measured(rendered=False)[what][away_m], measured(rendered=True)[what][away_m]
    assert drawn == pytest.approx(seen, rel=0.3)


@pytest.mark.slow
def test_line_points_are_as_many_and_as_good_as_in_pictures() -> None:
    drawn, seen = measured(rendered=False), measured(rendered=True)
    assert drawn["points"] == pytest.approx(seen["points"], rel=0.2)
    assert drawn["line"] == pytest.approx(seen["line"], rel=0.3)


def test_ideal_percepts_are_the_truth() -> None:
    percept = look(bench(realism="none"), truth((1.0, -1.0)))
    assert place_of(percept) == pytest.approx((1.0, -1.0))


def test_ball_behind_a_robot_is_not_seen() -> None:
    ahead = (OWN[0] + 3.0, OWN[1])
    eyes = bench(realism="none")
    assert not look(eyes, truth(ahead, (OWN[0] + 1.5, OWN[1]))).visible
    assert look(eyes, truth(ahead, (OWN[0] + 1.5, OWN[1] + 0.4))).visible
    assert look(eyes, truth(ahead, (OWN[0] + 4.0, OWN[1]))).visible


@pytest.mark.parametrize("rendered", [False, True])
@pytest.mark.parametrize(("aside_m", "found"), [(0.2, 0), (0.27, 40), (-0.27, 40)])
def test_ball_that_a_robot_hides_in_part_is_in_place(rendered: bool, aside_m: float, found: int) -> None:
    """Less than 0.4 of it are not found; the middle of what is left is 0.03 m further from the robot."""
    system = seen_through(rendered, Behind, aside_m=aside_m)
    system.tick(40)
    percepts = map(ball_percept_t.decode, system.sent["cyan1/ball_percept"])
    lefts_m = [percept.y_m for percept in percepts if percept.visible]
    assert len(lefts_m) == pytest.approx(found, abs=6)
    if found:
        assert np.mean(lefts_m) == pytest.approx(0.0, abs=0.005)


def test_glimpse_of_a_ball_is_that_of_sampled_points() -> None:
    """Two robots hide a ball from both sides; a third one stands beside it."""
    bodies_m = np.array(((1.5, 0.3), (1.6, -0.3), (2.1, 0.1)))
    at = np.random.default_rng(1).uniform(-1.0, 1.0, (100_000, 2))
    aside = at[np.hypot(*at.T) < 1.0][:, 0]
    rays_rad = aside * math.asin(0.11 / 2.0)
    free = np.ones(len(aside), bool)
    for x_m, y_m in bodies_m[:2]:
        free &= np.abs(rays_rad - math.atan2(y_m, x_m)) > math.asin(0.25 / math.hypot(x_m, y_m))
    glimpse = glimpse_of(np.array((2.0, 0.0)), 0.11, bodies_m, 0.25)
    assert glimpse.visible == pytest.approx(free.mean(), abs=0.005)
    assert glimpse.aside_m == pytest.approx(0.11 * aside[free].mean(), abs=0.001)


def test_ball_that_hardly_flies_appears_further_away() -> None:
    percept = look(bench(realism="none"), truth((OWN[0] + 2.0, OWN[1]), ball_z_m=0.032))
    assert place_of(percept) == pytest.approx((OWN[0] + 2.0 * 0.64 / 0.608, OWN[1]))
    assert percept.confidence == pytest.approx(0.902, abs=0.01)
    assert percept.z_m == 0.0


@pytest.mark.parametrize("height_m", [0.1, 0.32, 0.52])
def test_ball_in_the_air_is_found_at_its_height(height_m: float) -> None:
    percept = look(bench(realism="none"), truth((OWN[0] + 2.0, OWN[1]), ball_z_m=height_m))
    assert place_of(percept) == pytest.approx((OWN[0] + 2.0, OWN[1]))
    assert percept.z_m == pytest.approx(height_m)


def test_ball_above_the_mirrors_edge_is_not_seen() -> None:
    assert not look(bench(realism="none"), truth((OWN[0] + 2.0, OWN[1]), ball_z_m=0.75)).visible


def test_ball_straight_above_the_mirror_is_not_seen() -> None:
    for away_m in (0.01, 0.05, 0.1):
        assert not look(bench(realism="none"), truth((OWN[0] + away_m, OWN[1]), ball_z_m=1.0)).visible


def test_nothing_is_seen_beyond_what_the_mirror_shows() -> None:
    """The mirror shows 4.3 m of ground; without errors nothing is found further away."""
    eyes = bench(realism="none", mirror={"view_angle_deg": 80.0})
    near, far = (OWN[0], OWN[1] - 3.0), (OWN[0], OWN[1] - 5.0)
    assert look(eyes, truth(near, (OWN[0] + 3.0, OWN[1]))).visible
    assert eyes.port("obstacle_percepts").sent[-1].n == 1
    assert not look(eyes, truth(far, (OWN[0] + 5.0, OWN[1]))).visible
    assert eyes.port("obstacle_percepts").sent[-1].n == 0
    lines = eyes.port("line_points").sent[-1]
    assert 3.5 < max(np.hypot(lines.x_m, lines.y_m)) < 4.3


def test_ball_in_the_air_that_a_robot_hides_in_part_is_not_seen() -> None:
    ahead = (OWN[0] + 3.0, OWN[1])
    for aside_m, visible in ((0.6, True), (0.2, False)):
        percept = look(bench(realism="none"), truth(ahead, (OWN[0] + 1.5, OWN[1] + aside_m), ball_z_m=0.3))
        assert percept.visible is visible


def test_ball_above_robots_is_not_hidden() -> None:
    ahead, between = (OWN[0] + 3.0, OWN[1]), (OWN[0] + 1.5, OWN[1])
    assert look(bench(realism="none"), truth(ahead, between, ball_z_m=0.61)).visible


@pytest.mark.slow
@pytest.mark.parametrize(
    ("away_m", "height_m"), [(1.5, 0.15), (1.5, 0.35), (3.0, 0.15), (3.0, 0.35), (3.0, 0.65), (5.0, 0.6), (5.0, 0.9)]
)
def test_errors_in_the_air_are_those_of_pictures(away_m: float, height_m: float) -> None:
    def errors(rendered: bool) -> tuple[float, float]:
        across, up = [], []
        system = seen_through(rendered, Flying, away_m=away_m, height_m=height_m)
        system.tick(FLYING_FRAMES)
        percepts = [ball_percept_t.decode(each) for each in system.sent["cyan1/ball_percept"]]
        flying: Any = system.runners["world/scene"].component
        for percept, shown in zip(percepts, flying.shown, strict=True):
            if percept.visible:
                across.append(math.dist(world(percept.x_m, percept.y_m), (shown.ball_x_m, shown.ball_y_m)))
                up.append(percept.z_m - height_m)
        return rms(across), rms(up)

    ratios = np.array(errors(rendered=False)) / errors(rendered=True)
    assert np.all((ratios > 0.5) & (ratios < 2.0))


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_share_of_missed_balls_is_that_of_the_settings(share: float) -> None:
    eyes = bench(realism="none", ball_missed=share)
    seen = sum(look(eyes, truth((0.0, 0.0))).visible for _ in range(400))
    assert seen / 400 == pytest.approx(1.0 - share, abs=0.08)


@pytest.mark.slow
def test_phantoms_come_at_their_rate() -> None:
    eyes = bench(realism="none", ball_phantoms_1_s=1.0, robot_phantoms_1_s=2.0)
    balls = sum(look(eyes, truth((30.0, 0.0))).visible for _ in range(1200))
    robots = sum(len(percepts.obstacles) for percepts in eyes.port("obstacle_percepts").sent)
    assert balls / 60 == pytest.approx(1.0, abs=0.4)
    assert robots / 60 == pytest.approx(2.0, abs=0.6)


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.0, 0.3])
def test_teams_are_recognized_but_for_a_share(share: float) -> None:
    eyes = bench(realism="none", team_missed=share)
    for _ in range(300):
        look(eyes, truth((0.0, 0.0), (OWN[0] + 1.5, OWN[1]), (OWN[0], OWN[1] + 2.0)))
    teams = [one.team for percepts in eyes.port("obstacle_percepts").sent for one in percepts.obstacles]
    assert set(teams) == {2} if share == 0.0 else {0, 2}
    assert teams.count(2) / len(teams) == pytest.approx(1.0 - share, abs=0.06)


def percepts_of(errors: dict[str, Any]) -> list[str]:
    """Returns what a robot that drives sees of a ball that rises and is hidden at last."""
    eyes = Bench(Percepts, name="cyan1/percepts", realism="none", **errors)
    for step in range(20):
        ball_m = (0.1 * step, -1.0) if step < 15 else (30.0, 0.0)
        seen = truth(ball_m, (1.0, 2.5), (-2.0, 0.1 * step), ball_z_m=0.02 * step)
        seen.robots[0].vx_m_s = 1.0
        seen.header.time_us = eyes.time_us
        look(eyes, seen)
    return [
        repr(sent) for port in ("ball_percept", "obstacle_percepts", "line_points") for sent in eyes.port(port).sent
    ]


@pytest.mark.parametrize("name", sorted(PerceptErrors.model_fields))
def test_every_error_that_is_set_changes_the_percepts(name: str) -> None:
    needed = {"gap_s": {"gaps_1_min": 600.0}, "gaps_1_min": {"gap_s": 1.0}}.get(name, {})
    value = 600.0 if name == "gaps_1_min" else 20.0 if name.endswith("_1_s") else 0.9
    assert percepts_of(needed | {name: value}) != percepts_of(needed)


def test_robot_off_the_field_sees_nothing_and_reports_it_once() -> None:
    eyes = Bench(Percepts, name="cyan7/percepts")
    for _ in range(3):
        eyes.port("ground_truth").put(truth((0.0, 0.0)))
        eyes.iterate()
    assert eyes.port("ball_percept").sent == []
    assert [line.text for line in eyes.logged] == ["no percepts: robot 'cyan7' is not on the field, which has cyan1"]


@pytest.mark.parametrize("latency_s", [0.035, 0.1])
def test_eyes_that_start_in_a_run_see_no_wrong_past(latency_s: float) -> None:
    """The ball rolls at 6 m/s; the first percept shows its place at the stated exposure."""
    eyes = Bench(Percepts, name="cyan1/percepts", period_s=0.04, realism="none", latency_s=latency_s)
    eyes.tick, eyes.time_us = 99, 99 * 40_000
    for tick in range(100, 106):
        seen = truth((OWN[0] + 0.24 * (tick - 96), OWN[1]))
        seen.ball_vx_m_s = 6.0
        eyes.port("ground_truth").put(seen, header={"tick": tick, "time_us": 40_000 * tick})
        eyes.iterate()
    percepts = eyes.port("ball_percept").sent
    assert len(percepts) == 6 - math.ceil(latency_s / 0.04)
    for percept in percepts:
        rolled_m = 0.24 * (percept.capture_us / 40_000 - 96)
        assert place_of(percept) == pytest.approx((OWN[0] + rolled_m, OWN[1]))
