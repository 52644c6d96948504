"""The kicker's word about the ball."""

import pytest

from lcmtypes.robot import kicker_state_t
from procs.model.kicker import tells_held


@pytest.mark.parametrize(
    ("held", "silent_s", "expected"), [(True, 0.0, True), (True, 0.5, True), (True, 0.55, False), (False, 0.0, False)]
)
def test_word_of_a_kicker_holds_for_half_a_second(held: bool, silent_s: float, expected: bool) -> None:
    assert tells_held(kicker_state_t(ball_held=held), silent_s) is expected
