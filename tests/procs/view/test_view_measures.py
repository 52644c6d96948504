"""Measures of the field, and the age of messages, in views of a match."""

import math

import pytest

from fwk.web import Newest
from lcmtypes.soccer import ground_truth_t, pose_t
from procs.model.field import Field
from procs.simulation.physics.reports import field_message
from procs.view.measures import MEASURES, field_in, recent

SMALL = Field(length_m=18.0, width_m=12.0)
SETTINGS = {("world/simulator", "field.length_m"): 18.0, ("world/simulator", "field.width_m"): 12.0}


def test_without_a_message_the_field_is_that_of_the_settings() -> None:
    assert field_in(Newest({}, SETTINGS)) == SMALL
    assert field_in(Newest({})) == Field()
    assert field_in(lambda _: None) == Field()


def test_field_of_a_message_comes_before_that_of_the_settings() -> None:
    assert field_in(Newest({MEASURES: field_message(Field(length_m=20.0))}, SETTINGS)).length_m == 20.0


@pytest.mark.parametrize("length_m", [math.nan, math.inf, 0.0, -1.0, 1e300])
def test_impossible_measures_of_the_field_are_not_used(length_m: float) -> None:
    told = field_message(Field())
    told.length_m = length_m
    assert field_in(Newest({MEASURES: told})) == Field()


@pytest.mark.parametrize(("age_s", "shown"), [(0.0, True), (0.9, True), (1.1, False)])
def test_messages_of_a_silent_component_are_not_shown(age_s: float, shown: bool) -> None:
    truth, pose = ground_truth_t(), pose_t()
    truth.header.time_us = 20_000_000
    pose.header.time_us = 20_000_000 - round(age_s * 1e6)
    assert (recent(pose, truth) is pose) is shown


def test_message_that_never_came_is_not_shown() -> None:
    assert recent(None, ground_truth_t()) is None
