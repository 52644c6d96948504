"""Presets of realism: they reach bodies, cameras, percepts and radio, and single values override them."""

import itertools
from typing import Any

import pytest
from pydantic import BaseModel, ValidationError

from fwk.testing import launch_plan
from procs.model.realism import chosen
from procs.simulation import camera_errors, percept_errors, radio_links
from procs.simulation.camera import CameraConfig
from procs.simulation.physics.realism import noise_of
from procs.simulation.simulator import SimulatorConfig

PRESETS: dict[str, dict[Any, Any]] = {
    "camera": camera_errors.PRESETS,
    "percepts": percept_errors.PRESETS,
    "radio": radio_links.PRESETS,
}


@pytest.mark.parametrize("part", PRESETS)
def test_presets_of_every_part_grow_harsher(part: str) -> None:
    levels: list[BaseModel] = [PRESETS[part][name] for name in ("none", "friendly", "realistic", "harsh")]
    assert all(value == 0.0 for value in levels[0].model_dump().values())
    for milder, harsher in itertools.pairwise(levels):
        for name, value in milder.model_dump().items():
            if name != "bandwidth_bit_s":  # a narrower channel is the harsher one
                assert getattr(harsher, name) >= value
        assert milder != harsher


def test_harsh_radio_is_twice_the_realistic_one() -> None:
    harsh, realistic = (radio_links.PRESETS[name].model_dump() for name in ("harsh", "realistic"))
    twice = {name: 2 * value for name, value in realistic.items()}
    assert harsh == pytest.approx(twice | {"bandwidth_bit_s": realistic["bandwidth_bit_s"] / 2})


@pytest.mark.parametrize(
    ("file", "component", "part"),
    [
        ("soccer.yaml", "*/camera", "camera"),
        ("soccer-percepts.yaml", "*/percepts", "percepts"),
        ("soccer-percepts.yaml", "team_*/radio", "radio"),
    ],
)
def test_every_value_of_a_preset_is_a_setting(file: str, component: str, part: str) -> None:
    harsh: dict[str, float] = PRESETS[part]["harsh"].model_dump()
    plan = launch_plan(file, tuple(f"{component}.{name}={value}" for name, value in harsh.items()))
    with_it = [each.config for each in plan.components if each.name.endswith(component.partition("/")[2])]
    assert with_it
    for config in with_it:
        assert {name: config[name] for name in harsh} == harsh


def test_single_values_override_the_preset() -> None:
    errors = chosen(camera_errors.PRESETS["harsh"], CameraConfig(latency_s=0.01))
    assert (errors.latency_s, errors.shake_px) == (0.01, 0.4)
    assert noise_of("none", {"drive_delay_s": 0.3}).drive_delay_s == 0.3


def test_unknown_error_is_refused_with_the_known_ones() -> None:
    with pytest.raises(ValidationError, match="no error 'drive_dealy_s'; there are drive_delay_s, kick_delay_s"):
        SimulatorConfig(errors={"drive_dealy_s": 0.1})


def test_launch_file_states_realism_and_field_once() -> None:
    plan = launch_plan("soccer.yaml")
    parts = {each.name.rpartition("/")[2]: each for each in plan.components}
    for part in ("simulator", "camera", "radio"):
        assert "msl-field.yaml" in parts[part].origins["realism"]
    with_field = [each for each in plan.components if "field" in each.config]
    assert len(with_field) >= 5 * 10
    assert all("msl-field.yaml" in each.origins["field.length_m"] for each in with_field)
