"""Lookups in a tree of frames: through parents and siblings, between two times, and lookups without an answer."""

import math
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as some

from fwk import Component, Transforms, transform_message
from fwk.component.transform_tree import (
    HISTORY_US,
    DisconnectedError,
    ExtrapolationError,
    Transform,
    TransformError,
    TransformTree,
    UnknownFrameError,
)
from fwk.testing import Bench

QUARTER = math.pi / 2
numbers = some.floats(-100, 100)
transforms = some.builds(
    Transform.of_angles, some.tuples(numbers, numbers, numbers), *[some.floats(-math.pi, math.pi)] * 3
)


def robot() -> TransformTree:
    """A robot that stands at (1, 0) and faces left at 1 s, and at (3, 0) facing ahead at 2 s."""
    tree = TransformTree()
    tree.put("world", "base", 1_000_000, Transform.of((1.0, 0.0, 0.0), QUARTER))
    tree.put("world", "base", 2_000_000, Transform.of((3.0, 0.0, 0.0), 0.0))
    tree.put("base", "camera", 0, Transform.of((0.0, 0.0, 0.75)), fixed=True)
    tree.put("base", "kicker", 0, Transform.of((0.25, 0.0, 0.0)), fixed=True)
    return tree


@pytest.mark.parametrize(
    ("target", "source", "time_us", "point", "expected"),
    [
        ("world", "base", 1_000_000, (2.0, 0.0, 0.0), (1.0, 2.0, 0.0)),
        ("base", "world", 1_000_000, (1.0, 2.0, 0.0), (2.0, 0.0, 0.0)),
        ("world", "camera", 2_000_000, (1.0, 1.0, 0.0), (4.0, 1.0, 0.75)),
        ("kicker", "camera", None, (0.25, 0.0, 0.0), (0.0, 0.0, 0.75)),
        ("camera", "world", None, (3.0, 0.0, 0.75), (0.0, 0.0, 0.0)),
        ("world", "base", None, (0.0, 0.0, 0.0), (3.0, 0.0, 0.0)),
        ("world", "world", 5, (1.0, 2.0, 3.0), (1.0, 2.0, 3.0)),
    ],
)
def test_a_point_is_transformed_from_frame_to_frame(
    target: str, source: str, time_us: int | None, point: tuple[float, ...], expected: tuple[float, ...]
) -> None:
    assert robot().lookup(target, source, time_us).apply(np.array(point)) == pytest.approx(expected)


def test_poses_between_two_times_are_interpolated() -> None:
    quarter = robot().lookup("world", "base", 1_250_000)
    assert quarter.translation_m == pytest.approx((1.5, 0.0, 0.0))
    assert quarter.yaw_rad == pytest.approx(0.75 * QUARTER)


def test_poses_older_than_the_history_are_forgotten() -> None:
    tree = TransformTree()
    for time_us in range(0, 2 * HISTORY_US, 500_000):
        tree.put("world", "base", time_us, Transform.of((time_us / 1e6, 0.0, 0.0)))
    newest = 2 * HISTORY_US - 500_000
    assert tree.lookup("world", "base", newest - HISTORY_US).translation_m[0] == pytest.approx(9.5)
    with pytest.raises(ExtrapolationError, match=r"known from 9\.500 s to 19\.500 s, not at 9\.000 s"):
        tree.lookup("world", "base", newest - HISTORY_US - 500_000)


@pytest.mark.parametrize(
    ("kind", "target", "source", "time_us", "text"),
    [
        (UnknownFrameError, "world", "camra", None, "no frame 'camra'; did you mean 'camera'?"),
        (
            DisconnectedError,
            "ball",
            "camera",
            None,
            "no path from frame 'camera' to 'ball': camera in base in world, but ball in table",
        ),
        (
            ExtrapolationError,
            "world",
            "camera",
            500_000,
            "frame 'base' in 'world' is known from 1.000 s to 2.000 s, not at 0.500 s",
        ),
        (
            ExtrapolationError,
            "camera",
            "world",
            2_500_000,
            "frame 'base' in 'world' is known from 1.000 s to 2.000 s, not at 2.500 s",
        ),
    ],
)
def test_lookups_without_an_answer_are_refused(
    kind: type[TransformError], target: str, source: str, time_us: int | None, text: str
) -> None:
    tree = robot()
    tree.put("table", "ball", 0, Transform.of((0.0, 0.0, 0.0)), fixed=True)
    with pytest.raises(kind, match=re.escape(text)):
        tree.lookup(target, source, time_us)


@pytest.mark.parametrize(
    ("parent", "child", "time_us", "text"),
    [
        ("camera", "base", 0, "frame 'base' has the parent 'world' and cannot also have 'camera'"),
        ("camera", "world", 0, "frames would form a cycle: world in camera in base in world"),
        ("x", "x", 0, "frames would form a cycle: x in x"),
        ("world", "base", 1_000_000, "frame 'base' is known at 2.000 s and cannot be set at 1.000 s"),
    ],
)
def test_transforms_that_do_not_fit_the_tree_are_refused(parent: str, child: str, time_us: int, text: str) -> None:
    with pytest.raises(TransformError, match=re.escape(text)):
        robot().put(parent, child, time_us, Transform.of((0.0, 0.0, 0.0)))


@given(transforms, transforms, some.tuples(numbers, numbers, numbers))
def test_there_and_back_is_the_identity(one: Transform, other: Transform, point: tuple[float, ...]) -> None:
    both = one @ other
    there = both.apply(np.array(point))
    assert there == pytest.approx(one.apply(other.apply(np.array(point))), abs=1e-6)
    assert both.inverse.apply(there) == pytest.approx(point, abs=1e-6)
    assert one.towards(other, 0.0).apply(np.array(point)) == pytest.approx(one.apply(np.array(point)), abs=1e-4)
    assert one.towards(other, 1.0).apply(np.array(point)) == pytest.approx(other.apply(np.array(point)), abs=1e-4)


class Looks(Component):
    stage = "think"
    tf: Transforms


def test_the_aspect_leaves_out_poses_that_do_not_fit() -> None:
    bench = Bench(Looks)
    port = bench.port("tf.transforms")
    fits = transform_message("world", "base", 10, Transform.of((1.0, 0.0, 0.0)))
    for wrong in (
        transform_message("elsewhere", "base", 20, Transform.of((0.0, 0.0, 0.0))),
        transform_message("base", "world", 20, Transform.of((0.0, 0.0, 0.0))),
        transform_message("world", "base", 5, Transform.of((0.0, 0.0, 0.0))),
    ):
        port.put(transforms=[fits, wrong], n=2)
    bench.iterate()
    tf = bench.component.tf
    assert tf.refused == 3
    assert tf.lookup("world", "base").translation_m[0] == 1.0
    (line,) = bench.logged
    assert "frame 'base' has the parent 'world' and cannot also have 'elsewhere' (1 transforms refused" in line.text
