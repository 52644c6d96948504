"""The cases of the rules with a referee that is restarted in every tick: each ends as without a restart."""

from importlib import import_module

import pytest

from procs.referee.memory import recall, written
from procs.referee.sight import Sight
from procs.referee.whistle import Whistle

_CASES = ("advantage", "by_hand", "bystanders", "fouls", "match", "mirrored", "set_pieces")
_MODULES = [import_module(f"tests.procs.referee.test_referee_{name}") for name in _CASES]
globals().update({name: case for each in _MODULES for name, case in vars(each).items() if name.startswith("test_")})


@pytest.fixture(autouse=True)
def restarted(monkeypatch: pytest.MonkeyPatch) -> None:
    step = Whistle.step

    def restart_and_step(whistle: Whistle, duration_s: float, sight: Sight) -> None:
        following = Whistle(whistle.rules)
        recall(following, written(whistle))
        vars(whistle).update(vars(following))
        step(whistle, duration_s, sight)

    monkeypatch.setattr(Whistle, "step", restart_and_step)
