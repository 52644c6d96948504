"""Settings of the detectors: unusual ones work, and those that cannot be are refused with the limit."""

import math
from typing import Any

import numpy as np
import pytest

from fwk.model.errors import PlanError
from fwk.testing import Bench, launch_plan
from procs.model.field import Field
from procs.simulation.rendering.renderer import Pose, Renderer, Scene
from procs.simulation.rendering.shapes import Bodies
from procs.vision.calibration import MirrorConfig
from procs.vision.colours import CYAN, MAGENTA
from procs.vision.omni_field import OmniField

OWN = Pose(-4.0, 1.0, 0.4)
AROUND_M = ((1.2, 0.3), (-1.5, 1.0), (0.4, -2.0))


def found_with(mirror: MirrorConfig, **settings: Any) -> Bench:
    """Returns the detector after a picture with three robots around."""
    cosine, sine = math.cos(OWN.heading_rad), math.sin(OWN.heading_rad)
    others = [
        (OWN.x_m + cosine * x - sine * y, OWN.y_m + sine * x + cosine * y, CYAN if x > 0 else MAGENTA)
        for x, y in AROUND_M
    ]
    frame = Renderer(mirror.mirror(), Field(), Bodies()).render(Scene(OWN, others, None))
    bench = Bench(OmniField, mirror=mirror.model_dump(), **settings)
    bench.show("image", frame)
    bench.iterate()
    return bench


def places_of(bench: Bench) -> list[tuple[float, float]]:
    return sorted((each.x_m, each.y_m) for each in bench.port("obstacle_percepts").sent[-1].obstacles)


@pytest.mark.parametrize(
    ("mirror", "settings"),
    [
        (MirrorConfig(view_angle_deg=80.0), {}),  # shows 4.3 m of ground
        (MirrorConfig(view_angle_deg=75.0), {"ring_distances_m": (0.7, 1.6, 5.0)}),
        (MirrorConfig(), {"farthest_m": 20.0}),
        (MirrorConfig(size_px=120), {}),
        (MirrorConfig(), {"ring_distances_m": ()}),
    ],
)
def test_what_the_mirror_does_not_show_is_no_robot(mirror: MirrorConfig, settings: dict[str, Any]) -> None:
    bench = found_with(mirror, **settings)
    assert np.array(places_of(bench)) == pytest.approx(np.array(sorted(AROUND_M)), abs=0.12)
    reach_m = mirror.mirror().reach_m()
    (points,) = bench.port("line_points").sent
    assert points.n > 10
    assert max(np.hypot(points.x_m, points.y_m)) <= reach_m


@pytest.mark.parametrize(("width_m", "least"), [(0.02, 90), (0.125, 150), (0.37, 150)])
def test_lines_of_any_width_are_found(width_m: float, least: int) -> None:
    mirror, field = MirrorConfig(size_px=360, view_angle_deg=86.0), Field(line_width_m=width_m)
    bench = Bench(OmniField, mirror=mirror.model_dump(), field={"line_width_m": width_m}, most_points=1000)
    counts = []
    for x_m, y_m in ((-8.0, 3.0), (-4.0, 1.0), (0.5, -2.0), (7.0, 2.0)):
        bench.show("image", Renderer(mirror.mirror(), field, Bodies()).render(Scene(Pose(x_m, y_m, 0.4), [], None)))
        bench.iterate()
        counts.append(bench.port("line_points").sent[-1].n)
    assert np.mean(counts) >= least


def test_mirror_that_shows_no_ring_gives_points_of_rays() -> None:
    rays = found_with(MirrorConfig(), ring_distances_m=()).port("line_points").sent[-1].n
    far = found_with(MirrorConfig(view_angle_deg=86.0, size_px=360), ring_distances_m=(11.0,))
    assert rays > 10
    assert far.port("line_points").sent[-1].n > 10


def test_mirror_that_shows_next_to_nothing_gives_nothing() -> None:
    bench = found_with(MirrorConfig(height_m=0.301, view_angle_deg=45.1), nearest_m=0.3)
    assert (places_of(bench), bench.port("line_points").sent[-1].n) == ([], 0)


@pytest.mark.parametrize(
    ("settings", "mistake"),
    [
        ("shared.mirror.height_m=75", "'mirror.height_m' is 75; it should be less than or equal to 2"),
        ("shared.mirror.height_m=0.1", "'mirror.height_m' is 0.1; it should be greater than 0.3"),
        (
            "shared.mirror.height_m=0.31 shared.ball.radius_m=0.2",
            "a ball of 0.4 m reaches up to the mirror, which is 0.31 m high",
        ),
        ("*/omni_field.nearest_m=8", "the rays begin at 8 m; farthest_m should be greater"),
        (
            "*/omni_field.farthest_m=0.6 */omni_field.nearest_m=0.7",
            "'farthest_m' is 0.6; the rays begin at 0.7 m; farthest_m should be greater",
        ),
        (
            "shared.mirror={height_m:0.31,view_angle_deg:46} shared.robot={radius_m:0.35}",
            "the rays begin at 0.38 m, but the mirror shows no ground beyond 0.32 m",
        ),
        ("*/omni_field.rays=16", "'rays' is 16; it should be greater than or equal to 60"),
        ("*/omni_field.ring_distances_m=[-1]", "'ring_distances_m.0' is -1; it should be greater than 0"),
        ("*/omni_ball.ball_high=[300,255,255]", "'ball_high.0' is 300; it should be less than or equal to 179"),
        ("*/omni_ball.ball_low=[30,120,80]", "hue 20 is less than that of ball_low, 30; no colour is between them"),
        ("*/omni_field.black_high=[179,255,-1]", "'black_high.2' is -1; it should be greater than or equal to 0"),
        (
            "*/omni_field.white_high=[179,60,100]",
            "value 100 is less than that of white_low, 150; no colour is between them",
        ),
    ],
)
def test_settings_with_which_nothing_is_seen_are_refused(settings: str, mistake: str) -> None:
    sets = tuple(each.replace(",", ", ").replace(":", ": ") for each in settings.split())
    with pytest.raises(PlanError) as raised:
        launch_plan("soccer-1v1.yaml", sets)
    assert mistake in str(raised.value)
