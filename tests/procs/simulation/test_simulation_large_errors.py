"""Errors as large as settings allow: they turn nothing around and give no impossible value."""

import math

import numpy as np
import pytest

from procs.model.robot import ROBOT
from procs.simulation.gaps import Gaps
from procs.simulation.physics.kick_mechanism import KickerCommand
from procs.simulation.physics.realism import PRESETS, Noise, factor
from procs.simulation.physics.sensors import Encoders
from procs.simulation.physics.start_places import Pose
from procs.simulation.physics.world import World
from procs.simulation.radio_links import RadioLinks, RadioSettings

SEEDS = range(60)


@pytest.mark.parametrize("noise", [Noise(kick_speed_sd=1.0), Noise(kick_direction_sd_deg=90.0)])
def test_no_kick_drives_the_ball_backwards(noise: Noise) -> None:
    speeds_m_s = []
    for seed in SEEDS:
        world = World(["cyan1"], np.random.default_rng(seed), noise=noise, starts={"cyan1": Pose(0.0, 0.0, 0.0)})
        world.ball.put(ROBOT.mouth_m + world.ball.radius_m, 0.0)
        world.kickers["cyan1"].command(KickerCommand(1, 8.0, dribble=False), 0)
        world.advance(5000)
        speeds_m_s.append(world.ball.body.velocity.x)
    assert min(speeds_m_s) >= -1e-9
    assert max(speeds_m_s) <= 16.0


def test_no_encoder_counts_against_its_wheel() -> None:
    for seed in SEEDS:
        encoders = Encoders(Noise(wheel_scale_sd=1.0, wheel_noise_sqrt_s=10.0), np.random.default_rng(seed))
        ahead, back, still = encoders.read((1.0, -1.0, 0.0), 0.04)
        assert ahead >= 0.0 >= back
        assert still == 0.0


def test_errors_keep_the_mean() -> None:
    drawn = np.random.default_rng(1).standard_normal(20_000).tolist()
    for deviation in (0.06, 0.5, 1.0):
        factors = [factor(deviation, each) for each in drawn]
        assert np.mean(factors) == pytest.approx(1.0, abs=0.02)
        assert min(factors) >= 0.0


def test_presets_are_far_from_the_limits() -> None:
    """The limits change no usual match: one draw in a thousand million is beyond six deviations."""
    for noise in PRESETS.values():
        for deviation in (noise.kick_speed_sd, noise.wheel_scale_sd, noise.wheel_noise_sqrt_s / math.sqrt(0.04)):
            assert 6.0 * deviation < 1.0
        assert 6.0 * noise.kick_direction_sd_deg < 90.0


def test_gaps_last_no_negative_time() -> None:
    for seed in SEEDS:
        gaps = Gaps(np.random.default_rng(seed))
        blind = [gaps.blind(tick * 40_000, 1e6, 0.0) for tick in range(20)]
        assert not any(blind)


def test_no_message_arrives_before_it_is_sent() -> None:
    settings = RadioSettings(delay_jitter_s=10.0, outages_1_min=1e6, outage_s=1e-9)
    for seed in SEEDS:
        links: RadioLinks[int] = RadioLinks(["cyan1", "cyan2"], np.random.default_rng(seed))
        links.send("cyan1", 1, 1_000_000, settings)
        assert links.receive(999_999) == {}
        assert links.receive(11_000_000) == {"cyan2": [1]}


@pytest.mark.parametrize("offset_m", np.linspace(0.0, 0.14, 15))
def test_hardest_kick_stays_in_the_goal(offset_m: float) -> None:
    """The ball of a kick with the largest error does not get through the net."""
    world = World(["cyan1"], np.random.default_rng(1), noise=Noise(kick_speed_sd=1.0))
    world.ball.put(10.0 + offset_m, 0.0)
    world.ball.body.velocity = (27.0, 0.0)
    for _ in range(5):
        world.advance(40_000)
    assert world.ball.body.position.x < 11.6
