"""`fwk call` builds commands from its arguments."""

import re

import pytest

from fwk.cli.steer.call import command_of
from fwk.lcm.messages import MessageError


@pytest.mark.parametrize(
    ("kind", "fields", "error"),
    [
        ("freeze_world_t", [], "'frozen' of soccer.freeze_world_t is missing; write frozen=true or frozen=false"),
        ("hold_robot_t", ["robot=cyan1"], "'held' of soccer.hold_robot_t is missing; write held=true or held=false"),
    ],
)
def test_a_field_whose_zero_nobody_means_has_to_be_given(kind: str, fields: list[str], error: str) -> None:
    with pytest.raises(MessageError, match=f"^{re.escape(error)}$"):
        command_of(f"soccer.{kind}", fields)


def test_fields_that_are_given_or_may_be_left_out_are_taken() -> None:
    assert command_of("soccer.freeze_world_t", ["frozen=false"]).frozen is False
    assert command_of("soccer.hold_robot_t", ["held=true", "robot=cyan1"]).held is True
    assert command_of("soccer.reset_world_t", []).keep_ball is False
