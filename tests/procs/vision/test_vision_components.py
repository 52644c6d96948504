"""Camera and detectors as components: their messages, also without a frame, and the same bytes every time."""

import hashlib
import math
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest

from fwk.testing import Bench, MemorySystem, settings_in
from lcmtypes.core import frame_t
from lcmtypes.soccer import ground_truth_t, obstacle_t
from procs.model.ball import BallModel
from procs.model.field import Field
from procs.model.robot import RobotModel
from procs.simulation.camera import Camera
from procs.simulation.camera_errors import CameraErrors
from procs.simulation.rendering.renderer import Pose, Renderer, Scene
from procs.simulation.rendering.shapes import Bodies
from procs.vision.calibration import MirrorConfig
from procs.vision.colours import CYAN
from procs.vision.omni_ball import OmniBall
from procs.vision.omni_field import OmniField
from tests.procs.vision.picture_parts import World, frame_of, robot, system

ROOT = Path(__file__).parents[3]


def test_from_truth_to_percepts() -> None:
    run = system(shake_px=0.0, latency_s=0.0)
    for tick in range(1, 6):
        run.tick()
        ball, lines = run.newest("cyan1/ball_percept"), run.newest("cyan1/line_points")
        (obstacle,) = run.newest("cyan1/obstacle_percepts").obstacles
        dx_m, dy_m = 1.0 + 0.05 * tick, 1.0  # of the ball of this tick
        assert ball.visible
        assert ball.x_m == pytest.approx(math.cos(0.5) * dx_m + math.sin(0.5) * dy_m, abs=0.01)
        assert ball.y_m == pytest.approx(math.cos(0.5) * dy_m - math.sin(0.5) * dx_m, abs=0.01)
        assert ball.confidence > 0.9
        assert (obstacle.x_m, obstacle.y_m) == pytest.approx((2 * math.cos(0.5), -2 * math.sin(0.5)), abs=0.06)
        assert obstacle.radius_m == 0.25
        assert obstacle.covariance_m2[0][0] > 0.0
        assert 40 <= lines.n <= 150
        assert ball.header.tick == lines.header.tick == tick


def test_alternating_cameras_give_a_frame_every_other_tick() -> None:
    run = system(turns=(2, 1))
    run.tick(6)
    assert [frame_t.decode(data).header.tick for data in run.sent["cyan1/image"]] == [1, 3, 5]


def test_lost_frame_gives_empty_percepts() -> None:
    ball, field = Bench(OmniBall), Bench(OmniField)
    for bench in (ball, field):
        bench.port("image").put(frame=7, width_px=400, height_px=400, channels=3)  # announced, but not in the ring
        bench.iterate()
    assert [percept.visible for percept in ball.port("ball_percept").sent] == [False]
    assert [points.n for points in field.port("line_points").sent] == [0]
    assert [percepts.n for percepts in field.port("obstacle_percepts").sent] == [0]


def test_percepts_of_an_earlier_frame_are_not_kept() -> None:
    frame = frame_of(system())
    ball, field = Bench(OmniBall), Bench(OmniField)
    for bench in (ball, field):
        bench.show("image", frame)
        bench.iterate()
        bench.show("image", np.zeros((400, 400, 3), np.uint8))
        bench.iterate()
    first, second = ball.port("ball_percept").sent
    assert first.visible
    assert (second.visible, second.x_m, second.y_m, second.confidence) == (False, 0.0, 0.0, 0.0)
    assert [points.n > 0 for points in field.port("line_points").sent] == [True, False]
    assert [percepts.n > 0 for percepts in field.port("obstacle_percepts").sent] == [True, False]


@pytest.mark.parametrize("radius_m", [0.18, 0.25])
def test_robots_of_any_width_are_found_behind_a_ball(radius_m: float) -> None:
    other, ball = RobotModel(radius_m=radius_m, wheel_distance_m=0.1), BallModel()
    renderer = Renderer(MirrorConfig().mirror(), Field(), Bodies.of(other, ball))
    bench = Bench(OmniField, robot=other.model_dump())
    found = 0
    for number in range(12):
        x, y = math.cos(0.5 * number), math.sin(0.5 * number)
        ball_m = 3.0 - other.held_ball_m(ball)
        scene = Scene(Pose(0.0, 0.0, 0.0), [(3.0 * x, 3.0 * y, CYAN)], (ball_m * x, ball_m * y, ball.radius_m))
        bench.show("image", renderer.render(scene))
        bench.iterate()
        seen = bench.port("obstacle_percepts").sent[-1].obstacles
        found += any(math.dist((one.x_m, one.y_m), (3.0 * x, 3.0 * y)) < 0.3 for one in seen)
    assert found >= 11


def test_without_a_new_frame_nothing_is_published() -> None:
    bench = Bench(OmniBall)
    bench.iterate(3)
    assert bench.port("ball_percept").sent == []


def test_whole_robot_of_the_launch_file_takes_a_4_to_3_camera() -> None:
    """A frame of 640 x 480 pixels: the square in the middle shows the mirror."""
    square = cv2.resize(frame_of(system(shake_px=0.0, noise_levels=0.0)), (480, 480), interpolation=cv2.INTER_AREA)
    wide = np.zeros((480, 640, 3), np.uint8)
    wide[:, 80:560] = square
    places = []
    for frame in (square, wide):
        bench = Bench(OmniBall, **settings_in("soccer.yaml", "cyan1/omni_ball"))
        bench.show("image", frame)
        bench.iterate()
        (percept,) = bench.port("ball_percept").sent
        assert percept.visible
        places.append((percept.x_m, percept.y_m))
    assert places[0] == places[1]
    field = Bench(OmniField, **settings_in("soccer.yaml", "cyan1/omni_field"))
    field.show("image", wide)
    field.iterate()
    assert field.port("line_points").sent[-1].n > 40


def test_grey_frame_is_refused_with_its_shape() -> None:
    for component in (OmniBall, OmniField):
        bench = Bench(component)
        bench.show("image", np.zeros((400, 400), np.uint8))
        with pytest.raises(ValueError, match=r"the frame is 400 x 400.* need three colours, height x width x 3"):
            bench.iterate()


def test_percepts_state_the_exposure() -> None:
    run = system(latency_s=0.035)
    run.tick(3)
    exposed_us = run.newest("cyan1/image").header.time_us - 35_000
    assert exposed_us > 0
    for channel in ("ball_percept", "line_points", "obstacle_percepts"):
        assert run.newest(f"cyan1/{channel}").capture_us == exposed_us


def test_camera_without_its_robot_warns_once_and_continues() -> None:
    bench = Bench(Camera, name="cyan4/camera", latency_s=0.0)
    truth = ground_truth_t()
    truth.robots = [robot("cyan1", 0.0, 0.0, 0.0)]
    for _ in range(3):
        bench.port("ground_truth").put(truth)
        bench.iterate()
    assert bench.port("image").sent == []
    assert [line.text for line in bench.logged] == ["no pictures: robot 'cyan4' is not on the field, which has cyan1"]
    truth.robots.append(robot("cyan4", 1.0, 0.0, 0.0))
    bench.port("ground_truth").put(truth)
    bench.iterate()
    assert [frame.frame for frame in bench.port("image").sent] == [1]


@pytest.mark.parametrize("value", [math.nan, math.inf, -1e300, 1e4])
def test_impossible_truth_is_not_drawn(value: float) -> None:
    bench = Bench(Camera, name="cyan1/camera", latency_s=0.0)
    truth = ground_truth_t()
    truth.robots = [robot("cyan1", 0.0, 0.0, 0.0), robot("cyan2", value, 0.0, 0.0)]
    truth.ball_x_m = value
    bench.port("ground_truth").put(truth)
    bench.iterate()
    assert len(bench.port("image").sent) == 1
    truth.robots[0].heading_rad = value
    bench.port("ground_truth").put(truth)
    bench.iterate()
    assert len(bench.port("image").sent) == 1  # as if the robot were not there


def test_settings_changed_between_iterations_are_used() -> None:
    bench = Bench(OmniBall)
    frame = frame_of(system())
    bench.show("image", frame)
    bench.iterate()
    bench.runner.configure({"ball_low": (90, 120, 80), "ball_high": (100, 255, 255)})
    bench.show("image", frame)
    bench.iterate()
    assert [percept.visible for percept in bench.port("ball_percept").sent] == [True, False]


def test_driving_shakes_the_picture_more_than_standing() -> None:
    def spread_px(vx_m_s: float) -> float:
        errors, rng = CameraErrors(shake_px=0.2, shake_px_per_m_s=0.3), np.random.default_rng(1)
        own = robot("cyan1", -3.0, 2.0, 0.0)
        own.vx_m_s = vx_m_s
        return float(np.std([errors.drawn_shake_px(own, rng) for _ in range(500)]))

    assert spread_px(0.0) == pytest.approx(0.2, rel=0.1)
    assert spread_px(2.0) == pytest.approx(0.8, rel=0.1)


def digest(seed: int) -> str:
    """Returns a digest of every frame and every message of a few ticks."""
    run, seen = system(seed), hashlib.sha256()
    for _ in range(5):
        run.tick()
        seen.update(frame_of(run).tobytes())
    for channel in sorted(run.sent):
        for data in run.sent[channel]:
            seen.update(data)
    return seen.hexdigest()


@pytest.mark.slow
def test_fresh_processes_give_the_same_bytes() -> None:
    """The bytes depend neither on the order of sets nor on the default kernel of the linear algebra library."""
    code = "import runpy, sys; print(runpy.run_path(sys.argv[1])['digest'](1))"
    digests = [
        subprocess.run(
            [sys.executable, "-c", code, __file__],
            cwd=ROOT,
            env={**variables, "PYTHONPATH": str(ROOT)},
            capture_output=True,
            text=True,
            check=True,
            timeout=60,
        ).stdout.strip()
        for variables in ({"PYTHONHASHSEED": "1"}, {"PYTHONHASHSEED": "2", "OPENBLAS_CORETYPE": "Nehalem"})
    ]
    assert digests == [digest(1)] * 2
    assert digest(2) != digest(1)


@pytest.mark.parametrize("radius_m", [0.25, 0.4])
def test_rays_begin_beside_the_own_body(radius_m: float) -> None:
    component = Bench(OmniField, name="cyan1/omni_field", robot={"radius_m": radius_m}).component
    assert isinstance(component, OmniField)
    begins_m = np.hypot(component._star.ground_m[:, 0, 0], component._star.ground_m[:, 0, 1])
    assert begins_m == pytest.approx(radius_m + 0.03, abs=0.01)


class Strangers(World):
    """A robot whose name gives no team, and one of magenta."""

    def loop(self) -> None:
        truth = self.ground_truth.value
        truth.robots = [
            robot("cyan1", -3.0, 2.0, 0.5),
            robot("anna", -1.5, 2.0, 0.0),
            robot("magenta2", -3.0, 0.5, 0.0),
        ]
        self.ground_truth.write()


def test_robot_that_is_not_a_player_has_no_marker() -> None:
    run = MemorySystem({"world/world": Strangers, "cyan1/camera": Camera, "cyan1/omni_field": OmniField})
    run.tick()
    found = run.newest("cyan1/obstacle_percepts").obstacles
    assert sorted(each.team for each in found) == [obstacle_t.TEAM_UNKNOWN, obstacle_t.TEAM_MAGENTA]
