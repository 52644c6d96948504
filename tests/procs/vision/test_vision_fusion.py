"""Fusion of the obstacles of both cameras: weights, times, limits, and what happens without one of them."""

import math

import pytest

from fwk.testing import Bench, system_of
from lcmtypes.soccer import obstacle_percepts_t, obstacle_t
from procs.vision.obstacle_fusion import ObstacleFusion, joined


def obstacle(x_m: float, y_m: float, along_m: float = 0.1, across_m: float = 0.1) -> obstacle_t:
    made = obstacle_t()
    made.x_m, made.y_m, made.radius_m = x_m, y_m, 0.25
    made.covariance_m2 = [[along_m**2, 0.0], [0.0, across_m**2]]
    return made


def test_fusion_weights_by_covariance_and_keeps_the_rest() -> None:
    around = [obstacle(2.0, 0.0, along_m=0.2, across_m=0.05), obstacle(-1.0, 1.0)]
    ahead = [obstacle(2.2, 0.1, along_m=0.05, across_m=0.2), obstacle(3.0, 1.0)]
    first, behind, new = joined(around, ahead, same_m=0.4)
    assert (first.x_m, first.y_m) == pytest.approx((2.0 + 0.2 * 16 / 17, 0.1 / 17))
    assert first.covariance_m2[0][0] < 0.05**2
    assert (behind.x_m, new.x_m) == (-1.0, 3.0)


def test_fusion_takes_percepts_of_one_time_only() -> None:
    bench = Bench(ObstacleFusion)
    for capture_us, count in ((100_000, 1), (10_000, 2)):
        for port, x_m, time_us in (("stereo_obstacles", 2.1, capture_us), ("obstacle_percepts", 1.0, 110_000)):
            percepts = obstacle_percepts_t()
            percepts.capture_us, percepts.obstacles = time_us, [obstacle(x_m if count == 1 else 1.0, 0.0)]
            bench.port(port).put(percepts)
        bench.iterate()
    first, second = bench.port("fused_obstacles").sent
    assert ([each.x_m for each in first.obstacles], first.capture_us) == ([1.0, 2.1], 110_000)
    assert [each.x_m for each in second.obstacles] == [1.0]


def test_fusion_joins_obstacles_of_a_slower_pair_once() -> None:
    bench, counts = Bench(ObstacleFusion), []
    for frame in range(4):
        if frame % 2 == 0:
            bench.port("stereo_obstacles").put(capture_us=bench.time_us + 1, obstacles=[obstacle(2.0, 0.0)])
        bench.port("obstacle_percepts").put(capture_us=bench.time_us + 1, obstacles=[obstacle(-1.0, 0.0)])
        bench.iterate()
        counts.append(bench.port("fused_obstacles").sent[-1].n)
    assert counts == [2, 1, 2, 1]


def put_obstacle(bench: Bench, port: str, x_m: float, time_us: int, capture_us: int) -> None:
    bench.port(port).put(header={"time_us": time_us}, capture_us=capture_us, obstacles=[obstacle(x_m, 0.0)])


@pytest.mark.parametrize("turns", [False, True])
@pytest.mark.parametrize(("late_us", "reports"), [(5_000, 0), (150_000, 1)])
def test_pair_that_is_never_joined_is_reported_once(late_us: int, reports: int, turns: bool) -> None:
    """With `turns`, the messages of the two cameras come in different ticks."""
    bench = Bench(ObstacleFusion)
    for tick in range(250):
        now_us = 1_000_000 + bench.time_us
        if not turns or tick % 2:
            put_obstacle(bench, "stereo_obstacles", 4.0, now_us, now_us - late_us)
        if not turns or tick % 2 == 0:
            put_obstacle(bench, "obstacle_percepts", 2.0, now_us, now_us)
        bench.iterate()
    assert len(bench.logged) == reports
    for line in bench.logged:
        assert "s older than those of the omnidirectional camera; apart_s is 0.06 s" in line.text


@pytest.mark.parametrize(("around_us", "ahead_us"), [(0, 400_000), (400_000, 0), (0, 0)])
def test_fusion_takes_0_for_the_tick_of_the_message(around_us: int, ahead_us: int) -> None:
    bench = Bench(ObstacleFusion)
    put_obstacle(bench, "obstacle_percepts", 1.0, 400_000, around_us)
    put_obstacle(bench, "stereo_obstacles", 2.0, 400_000, ahead_us)
    bench.iterate()
    (fused,) = bench.port("fused_obstacles").sent
    assert ([each.x_m for each in fused.obstacles], fused.capture_us) == ([1.0, 2.0], 400_000)


def test_fusion_does_not_take_an_old_message_with_0_for_new() -> None:
    bench = Bench(ObstacleFusion)
    put_obstacle(bench, "stereo_obstacles", 2.0, 150_000, 0)
    put_obstacle(bench, "obstacle_percepts", 1.0, 400_000, 0)
    bench.iterate()
    assert [each.x_m for each in bench.port("fused_obstacles").sent[-1].obstacles] == [1.0]


def test_pair_alone_states_when_it_saw_its_obstacles() -> None:
    bench = Bench(ObstacleFusion)
    put_obstacle(bench, "stereo_obstacles", 2.0, 150_000, 0)
    bench.iterate()
    assert [each.capture_us for each in bench.port("fused_obstacles").sent] == [150_000]


@pytest.mark.parametrize("swapped", [False, True])
def test_fusion_joins_the_nearest_first(swapped: bool) -> None:
    """The second detector sees one of two robots that touch, a little beside it."""
    around = [obstacle(2.0, 0.35), obstacle(2.0, -0.15)]
    made = joined(around[::-1] if swapped else around, [obstacle(2.0, -0.05, across_m=0.02)], same_m=0.45)
    places_m = sorted(each.y_m for each in made)
    assert places_m == [pytest.approx(-0.05, abs=0.01), 0.35]


def test_fusion_leaves_out_what_has_no_place() -> None:
    (one,) = joined([obstacle(2.0, 0.0)], [obstacle(math.nan, 0.0), obstacle(2.1, 0.0)], same_m=0.4)
    assert one.x_m == pytest.approx(2.05)
    assert joined([obstacle(math.inf, 0.0)], [obstacle(1e300, 0.0)], same_m=0.4) == []


def test_fusion_keeps_the_nearest_of_very_many_obstacles() -> None:
    far = [obstacle(5.0 + 0.01 * number, 0.0) for number in range(2000)]
    near = [obstacle(-1.0 - 0.01 * number, 0.0) for number in reversed(range(60))]
    made = joined([*far, *near], [obstacle(0.0, each.x_m) for each in far], same_m=0.4)
    assert [(each.x_m, each.y_m) for each in made] == [
        *((each.x_m, 0.0) for each in [*far[:40], *near]),
        *((0.0, each.x_m) for each in far[:100]),
    ]


@pytest.mark.parametrize(("radius_m", "count"), [(0.12, 2), (0.25, 1)])
def test_fusion_knows_how_wide_robots_are(radius_m: float, count: int) -> None:
    bench = Bench(ObstacleFusion, robot={"radius_m": radius_m})
    for port, y_m in (("obstacle_percepts", 0.0), ("stereo_obstacles", 0.3)):
        bench.port(port).put(capture_us=40_000, obstacles=[obstacle(2.0, y_m)])
    bench.iterate()
    assert bench.port("fused_obstacles").sent[-1].n == count


def test_pair_sees_alone_while_the_other_camera_is_silent() -> None:
    bench = Bench(ObstacleFusion)
    bench.port("obstacle_percepts").put(capture_us=1, obstacles=[obstacle(-1.0, 0.0)])
    bench.iterate()
    for _ in range(10):
        bench.port("stereo_obstacles").put(capture_us=bench.time_us, obstacles=[obstacle(2.0, 0.0)])
        bench.iterate()
    sent = bench.port("fused_obstacles").sent
    assert [[each.x_m for each in percepts.obstacles] for percepts in (sent[0], sent[-1])] == [[-1.0], [2.0]]
    assert 0.25 <= (sent[1].header.time_us - sent[0].header.time_us) / 1e6 <= 0.4
    assert [percepts.capture_us for percepts in sent] == sorted(percepts.capture_us for percepts in sent)


def test_impossible_covariance_does_not_spoil_the_other() -> None:
    broken = obstacle(2.0, 0.0)
    broken.covariance_m2 = [[math.nan, 0.0], [0.0, 1.0]]
    (kept,) = joined([broken], [obstacle(2.1, 0.0)], same_m=0.4)
    assert kept.x_m == 2.1


def test_lone_robot_of_the_launch_file_sees_with_both() -> None:
    system = system_of("one-robot.yaml", lambda name: name.startswith(("world", "cyan1", "team_cyan")))
    system.tick(10)
    fused = [obstacle_percepts_t.decode(sent) for sent in system.sent["cyan1/fused_obstacles"]]
    stereo = [obstacle_percepts_t.decode(sent) for sent in system.sent["cyan1/stereo_obstacles"]]
    assert len(fused) == len(stereo) == 5
    assert all(one.capture_us == other.capture_us for one, other in zip(fused, stereo, strict=True))
