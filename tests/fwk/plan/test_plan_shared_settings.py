"""Settings of the section `shared`: stated once, they reach every component that has a setting of the name."""

from collections.abc import Callable
from pathlib import Path

import pytest

from fwk.model.errors import PlanError
from fwk.model.plan import ComponentPlan, Plan

Load = Callable[..., Plan]

DRIVING = """
shared: {gain: 0.25, limits: {speed_m_s: 1.5}}
components:
  it/wheels: {use: plan_parts:Wheels}
  other/wheels: {use: plan_parts:Wheels, config: {gain: 0.75}}
  it/pilot: {use: plan_parts:Pilot}
  other/pilot: {use: plan_parts:Pilot}
"""


def component(plan: Plan, name: str) -> ComponentPlan:
    return next(each for each in plan.components if each.name == name)


def test_shared_settings_reach_components_that_have_them(load: Load) -> None:
    plan = load(DRIVING)
    wheels = component(plan, "it/wheels")
    assert (wheels.config["gain"], wheels.config["limits"]["speed_m_s"]) == (0.25, 1.5)
    assert wheels.config["limits"]["turns"] == [-1.0, 1.0]
    assert wheels.origins["gain"] == "it.yaml:2"
    assert "gain" not in component(plan, "it/pilot").config


def test_settings_of_a_component_win_over_shared_ones(load: Load) -> None:
    assert component(load(DRIVING), "other/wheels").config["gain"] == 0.75


def test_shared_settings_of_a_later_file_win(load: Load, folder: Path) -> None:
    (folder / "low.yaml").write_text(DRIVING)
    plan = load("include: low.yaml\nshared: {gain: 1.0}")
    assert component(plan, "it/wheels").config["gain"] == 1.0
    assert component(plan, "other/wheels").config["gain"] == 1.0
    assert component(plan, "it/wheels").config["limits"]["speed_m_s"] == 1.5


def test_option_changes_a_shared_setting(load: Load) -> None:
    plan = load(DRIVING, sets=["shared.limits.speed_m_s=0.5"])
    assert component(plan, "it/wheels").config["limits"]["speed_m_s"] == 0.5
    assert component(plan, "it/wheels").origins["limits.speed_m_s"] == "--set"


def test_shared_setting_that_no_component_has_is_refused(load: Load) -> None:
    with pytest.raises(PlanError, match=r"it\.yaml:2: no component has a setting 'gian'; did you mean 'gain'"):
        load("\nshared: {gian: 0.5}\ncomponents: {it/wheels: {use: plan_parts:Wheels}}")


def test_shared_value_that_does_not_fit_names_its_line(load: Load) -> None:
    with pytest.raises(PlanError, match=r"it\.yaml:1: it/wheels.*'gain' is 7; it should be less than or equal to 1"):
        load("shared: {gain: 7}\ncomponents: {it/wheels: {use: plan_parts:Wheels}}")
