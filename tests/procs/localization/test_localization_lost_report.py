"""Log lines with the reason for which a robot does not find its place."""

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from fwk.testing import Bench
from lcmtypes.core import log_t
from lcmtypes.robot import imu_t
from lcmtypes.soccer import line_points_t
from procs.localization.localization import Localization
from procs.model.geometry import wrap_rad
from tests.procs.localization.localization_parts import PERIOD_S, FakeRobot

Change = Callable[[Any, int], None]


def warnings_of(seconds: float, port: str = "", change: Change | None = None, **settings: Any) -> list[str]:
    """Returns the warnings of a standing robot.

    `change` gets each message on one of the ports, with the logical time of the tick; None: no message comes.
    """
    bench, robot = Bench(Localization, **settings), FakeRobot(seed=4)
    robot.pose = np.array((3.0, 2.0, 0.5))
    for _ in range(round(seconds / PERIOD_S)):
        robot.drive(np.zeros(3))
        robot.show(bench)
        if port:
            _replace(bench, port, change)
        bench.iterate()
    return [line.text for line in bench.logged if line.level == log_t.WARNING]


def _replace(bench: Bench, name: str, change: Change | None) -> None:
    port = bench.port(name)
    message: Any = port.message_type.decode(port.waiting.pop())
    if change:
        change(message, bench.time_us)
        port.put(message)


def in_the_future(points: line_points_t, now_us: int) -> None:
    points.capture_us = now_us + 400_000


def few(points: line_points_t, _now_us: int) -> None:
    points.n, points.x_m, points.y_m = 5, points.x_m[:5], points.y_m[:5]


def turned(imu: imu_t, _now_us: int) -> None:
    imu.heading_rad = wrap_rad(imu.heading_rad + 1.5)


@pytest.mark.parametrize(
    ("port", "change", "reason"),
    [
        ("line_points", None, "no message with line points came"),
        ("line_points", in_the_future, "exposures lie up to 0.35 s in the future; check the clock of the camera"),
        ("line_points", few, "no frame had 8 white points within 7 m"),
        ("imu", None, "no heading of a compass came, and both halves of the field look alike"),
    ],
)
def test_lost_robot_names_its_missing_input_every_ten_seconds(port: str, change: Change | None, reason: str) -> None:
    found = warnings_of(20.5, port, change)
    assert found == [f"has not found its place for {time_s} s: {reason}" for time_s in (10, 20)]


def test_places_that_fit_alike_or_badly_are_named() -> None:
    (alike,) = warnings_of(10.5, "imu", turned)
    assert alike.startswith("has not found its place for 10 s: two places fit alike: (")
    assert alike.endswith("; check the compass, or move the robot")
    (badly,) = warnings_of(10.5, good_score=0.99)
    assert re.fullmatch(
        r"has not found its place for 10 s: the best place, \(2\.99 m, 2\.01 m, heading 0\.50 rad\),"
        r" fits with a score of 0\.\d\d, less than good_score, 0\.99;"
        r" check compass, calibration and lighting of the camera",
        badly,
    )


def test_robot_that_finds_its_place_does_not_warn() -> None:
    assert not warnings_of(11.0)
