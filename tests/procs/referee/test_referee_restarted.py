"""The cases of the rules with a referee that is restarted in every tick: each ends as without a restart."""

import pytest

from procs.referee.memory import recall, written
from procs.referee.sight import Sight
from procs.referee.whistle import Whistle
from tests.procs.referee import (
    test_referee_advantage,
    test_referee_by_hand,
    test_referee_bystanders,
    test_referee_fouls,
    test_referee_match,
    test_referee_mirrored,
    test_referee_set_pieces,
)

_CASES = (
    test_referee_advantage,
    test_referee_by_hand,
    test_referee_bystanders,
    test_referee_fouls,
    test_referee_match,
    test_referee_mirrored,
    test_referee_set_pieces,
)
globals().update({name: case for each in _CASES for name, case in vars(each).items() if name.startswith("test_")})


@pytest.fixture(autouse=True)
def restarted(monkeypatch: pytest.MonkeyPatch) -> None:
    step = Whistle.step

    def restart_and_step(whistle: Whistle, duration_s: float, sight: Sight) -> None:
        following = Whistle(whistle.rules)
        recall(following, written(whistle))
        vars(whistle).update(vars(following))
        step(whistle, duration_s, sight)

    monkeypatch.setattr(Whistle, "step", restart_and_step)
